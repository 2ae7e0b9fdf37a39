// SPDX-License-Identifier: Apache-2.0
#include "core/atomic_file.hpp"
#include "core/text.hpp"
#include "vantage/export.hpp"
#include "vantage/summary.hpp"
#include "words/station_cells.hpp"

namespace vantage {
void write_stations_csv(const std::filesystem::path& file, std::span<const PlacedStation> stations,
                        std::span<const Scanner> scanners, std::span<const std::string> given) {
  const bool setups = tells_setups(stations);
  const auto names = station_names(stations, given);
  std::string text = "station";
  for (const char* column : kStationColumns) text += "," + std::string(column);
  if (setups)
    for (const char* column : kSetupColumns) text += "," + std::string(column);
  text += "\n";
  for (std::size_t i = 0; i < stations.size(); ++i)
    text += number(i + 1) + "," + station_cells(stations[i], names[i]) +
            (setups ? "," + setup_cells(stations[i].setup, scanners) : "") + "\n";
  write_atomically(file, text);
}

}  // namespace vantage
