// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <sstream>
#include <vector>

#include "core/parse.hpp"
#include "core/read_file.hpp"
#include "vantage/error.hpp"
#include "vantage/scanner.hpp"

namespace vantage {
namespace {

std::string noise_line(std::string line) {
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
  return line;
}

}  // namespace

NoiseTable load_noise(const std::string& name) {
  if (name == "off" || name == "none" || name == "false") return {};
  if (name == "rtc360") return rtc360_noise();
  if (!name.ends_with(".csv")) {
    const Scanner scanner = load_scanner(name, own_presets_file());
    if (scanner.noise.empty())
      throw Error(Errc::invalid_argument,
                  "noise: the maker of '" + name + "' states no noise table; give a CSV file or off");
    return scanner.noise;
  }
  std::istringstream stream(read_file(name));
  NoiseTable table;
  std::string line;
  for (std::size_t number = 1; std::getline(stream, line); ++number) {
    line = noise_line(line);
    if (line.empty() || line.starts_with('#')) continue;
    const std::string what = name + ", line " + std::to_string(number);
    const auto cells = split(line, ',');
    const bool header = table.distances_m.empty();
    if (cells.size() < 2 || (!header && cells.size() != table.distances_m.size() + 1))
      throw Error(Errc::malformed_file, what + ": '" + line + "' must have " +
                                            (header ? std::string("`reflectivity` and the distances in metres")
                                                    : std::to_string(table.distances_m.size() + 1) + " cells"));
    if (!header) table.reflectivities.push_back(parse_number(cells[0], what, {.low = 0, .high = 1}));
    for (std::size_t k = 1; k < cells.size(); ++k)
      (header ? table.distances_m : table.sigma_m).push_back(parse_number(cells[k], what, not_negative));
  }
  if (table.reflectivities.empty()) throw Error(Errc::malformed_file, name + ": holds no line of standard deviations");
  const auto ascending = [](const std::vector<double>& values) {
    return std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) == values.end();
  };
  if (!ascending(table.distances_m) || !ascending(table.reflectivities))
    throw Error(Errc::malformed_file, name + ": distances and reflectivities must rise");
  return table;
}

}  // namespace vantage
