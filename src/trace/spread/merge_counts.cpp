// SPDX-License-Identifier: Apache-2.0
#include "trace/spread/merge_counts.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/parallel.hpp"

namespace vantage {
namespace {

template <class T>
void add_each(std::vector<T>& sums, const std::vector<T>& parts) {
  sums.resize(std::max(sums.size(), parts.size()));
  for (std::size_t k = 0; k < parts.size(); ++k) sums[k] = sums[k] + parts[k];
}

}  // namespace

void add_field(PassField& field, PassField&& part) {
  if (field.count.empty()) {
    field = std::move(part);
    return;
  }
  constexpr std::size_t kGrain = std::size_t{1} << 16;
  parallel::for_all(tbb::blocked_range<std::size_t>(0, field.count.size(), kGrain), [&](const auto& range) {
    for (std::size_t k = range.begin(); k < range.end(); ++k) {
      const std::uint32_t sum = field.count[k] + part.count[k];
      field.count[k] = sum < part.count[k] ? std::numeric_limits<std::uint32_t>::max() : sum;
    }
    if (field.stations.empty()) return;
    for (std::size_t k = range.begin(); k < range.end(); ++k) field.stations[k] |= part.stations[k];
  });
}

void add_station_sums(NetworkCounts& counts, const NetworkCounts& part) {
  counts.rays += part.rays;
  add_each(counts.points, part.points);
  add_each(counts.points_on_surveyed, part.points_on_surveyed);
  add_each(counts.dropped, part.dropped);
}

void add_voxels(NetworkCounts& counts, const NetworkCounts& part) {
  counts.stations = part.stations;
  counts.point_weight = part.point_weight;
  counts.voxels += part.voxels;
  counts.weight += part.weight;
  counts.saturated += part.saturated;
  counts.partial_points += part.partial_points;
  counts.successive_difference_sum += part.successive_difference_sum;
  counts.trace_seconds += part.trace_seconds;
  add_each(counts.seen, part.seen);
  add_each(counts.shared, part.shared);
  add_station_sums(counts, part);
}

}  // namespace vantage
