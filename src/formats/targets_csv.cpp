// SPDX-License-Identifier: Apache-2.0
#include "core/atomic_file.hpp"
#include "core/text.hpp"
#include "vantage/targets.hpp"
#include "words/csv_cell.hpp"

namespace vantage {

void write_targets_csv(const std::filesystem::path& file, std::span<const Target> targets,
                       std::span<const std::string> station_names) {
  std::string text = "name,x,y,z,sigma,proposed,stations\n";
  for (const Target& target : targets) {
    std::string stations;
    for (const std::size_t k : target.stations) stations += (stations.empty() ? "" : " ") + station_names[k];
    text += csv_cell(target.name) + "," + fixed(target.centre.x, 4) + "," + fixed(target.centre.y, 4) + "," +
            fixed(target.centre.z, 4) + "," + (target.control_m > 0 ? number(target.control_m) : "") + "," +
            (target.check      ? "check"
             : target.proposed ? "yes"
                               : "no") +
            "," + csv_cell(stations) + "\n";
  }
  write_atomically(file, text);
}

}  // namespace vantage
