// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>
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

constexpr Interval kIncidences{.low = 0, .high = 90, .high_included = false};

// Returns the reflectivity in the first cell of a header `incidence_deg@<reflectivity>`; nothing for another header.
std::optional<double> measured_reflectivity(std::string_view cell, const std::string& what) {
  constexpr std::string_view kBegin = "incidence_deg";
  if (!cell.starts_with(kBegin)) return std::nullopt;
  const std::string_view rest = cell.substr(kBegin.size());
  if (!rest.starts_with('@'))
    throw Error(Errc::malformed_file,
                what + ": a table by angle names the reflectivity of its surface, as in incidence_deg@0.5");
  return parse_number(rest.substr(1), what, {.low = 0, .high = 1, .low_included = false});
}

// Converts rows of angles to rows of reflectivities: a matt surface at α echoes like one of R cos α.
void take_incidences(NoiseTable& table, double reflectivity) {
  for (double& row : table.reflectivities) row = reflectivity * std::cos(Angle::degrees(row).in_radians());
  std::ranges::reverse(table.reflectivities);
  const auto columns = static_cast<std::ptrdiff_t>(table.distances_m.size());
  std::vector<double> sigma_m;
  for (auto row = table.sigma_m.end(); row != table.sigma_m.begin(); row -= columns)
    sigma_m.insert(sigma_m.end(), row - columns, row);
  table.sigma_m = std::move(sigma_m);
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
  std::optional<double> of_angles;  // the surface whose noise was measured by angle
  std::string line;
  for (std::size_t number = 1; std::getline(stream, line); ++number) {
    line = noise_line(line);
    if (line.empty() || line.starts_with('#')) continue;
    const std::string what = name + ", line " + std::to_string(number);
    const auto cells = split(line, ',');
    const bool header = table.distances_m.empty();
    if (header) of_angles = measured_reflectivity(cells[0], what);
    if (cells.size() < 2 || (!header && cells.size() != table.distances_m.size() + 1))
      throw Error(Errc::malformed_file, what + ": '" + line + "' must have " +
                                            (header ? std::string("`reflectivity` and the distances in metres")
                                                    : std::to_string(table.distances_m.size() + 1) + " cells"));
    if (!header) table.reflectivities.push_back(parse_number(cells[0], what, of_angles ? kIncidences : kAnyShare));
    for (std::size_t k = 1; k < cells.size(); ++k)
      (header ? table.distances_m : table.sigma_m).push_back(parse_number(cells[k], what, kNotNegative));
  }
  if (table.reflectivities.empty()) throw Error(Errc::malformed_file, name + ": holds no line of standard deviations");
  const auto ascending = [](const std::vector<double>& values) {
    return std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) == values.end();
  };
  if (!ascending(table.distances_m) || !ascending(table.reflectivities))
    throw Error(Errc::malformed_file,
                name + ": distances and " + (of_angles ? "angles of incidence" : "reflectivities") + " must rise");
  if (of_angles) take_incidences(table, *of_angles);
  return table;
}

}  // namespace vantage
