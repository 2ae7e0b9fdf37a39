// SPDX-License-Identifier: Apache-2.0
// Coverage and overlap (section 4.5) from exact integer counts.
#include "vantage/measure.hpp"

#include <algorithm>

#include "objective/whole_counts.hpp"

namespace vantage {

double coverage(const NetworkCounts& counts, double goal_density) {
  require_whole(counts, "coverage");
  if (counts.weight == 0) return 0;
  const double filled = static_cast<double>(counts.saturated) +
                        static_cast<double>(counts.partial_points) / (goal_density * counts.point_weight);
  return std::min(filled / static_cast<double>(counts.weight), 1.0);  // rounding may exceed 1 in the last place
}

OverlapMatrix overlap_matrix(const NetworkCounts& counts) {
  require_whole(counts, "overlap");
  OverlapMatrix overlap(counts.stations);
  if (counts.seen.empty()) return overlap;
  for (std::size_t i = 0; i < counts.stations; ++i) {
    for (std::size_t j = i + 1; j < counts.stations; ++j) {
      const std::uint64_t both = counts.shared_by(i, j);
      const std::uint64_t either = counts.seen[i] + counts.seen[j] - both;
      if (both > 0) overlap.set(i, j, static_cast<double>(both) / static_cast<double>(either));
    }
  }
  return overlap;
}

ScanOverlapMatrix scan_overlap_matrix(const NetworkCounts& counts) {
  require_whole(counts, "scan overlap");
  ScanOverlapMatrix overlap(counts.stations);
  if (counts.seen.empty()) return overlap;
  for (std::size_t i = 0; i < counts.stations; ++i)
    for (std::size_t j = i + 1; j < counts.stations; ++j)
      if (const std::uint64_t both = counts.shared_by(i, j))
        overlap.set(i, j, static_cast<double>(both) / static_cast<double>(std::min(counts.seen[i], counts.seen[j])));
  return overlap;
}

}  // namespace vantage
