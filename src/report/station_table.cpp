// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "core/text.hpp"
#include "vantage/summary.hpp"

namespace vantage {

std::string station_table(std::span<const PlacedStation> stations, std::span<const std::string> names,
                          std::span<const std::uint64_t> points) {
  constexpr std::size_t kColumns = 7, kWords = 1;  // the name stands to the left, and the status behind the numbers
  std::vector<std::array<std::string, kColumns>> rows{{"station", "ground x", "y", "z", "head z", "status", ""}};
  if (!points.empty()) rows[0][6] = "points on surveyed meshes";
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const PlacedStation& s = stations[k];
    std::array<std::string, kColumns> row{names[k]};
    row[5] = to_string(s.status);
    if (s.status != StationStatus::hole) {
      const auto metres = [](double value) { return fixed(std::round(1000 * value) / 1000 + 0.0, 3); };  // no "-0.000"
      row[1] = metres(s.ground.x), row[2] = metres(s.ground.y), row[3] = metres(s.ground.z);
      row[4] = metres(s.position.z);
    }
    if (s.kept) row[5] += ", kept";
    if (k < points.size()) row[6] = number(points[k]);
    rows.push_back(std::move(row));
  }
  std::array<std::size_t, kColumns> widths{};
  for (const auto& row : rows)
    for (std::size_t c = 0; c < kColumns; ++c) widths[c] = std::max(widths[c], row[c].size());
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < kColumns; ++c) {
      const std::string blanks(widths[c] - row[c].size(), ' ');
      line += (c == 0 ? "" : "  ") + (c < kWords || c == 5 ? row[c] + blanks : blanks + row[c]);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}  // namespace vantage
