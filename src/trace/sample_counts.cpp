// SPDX-License-Identifier: Apache-2.0
#include "trace/sample_counts.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "trace/field_counts.hpp"

namespace vantage {

NetworkCounts reduce_sample(std::span<const std::uint32_t> counts, std::span<const std::uint64_t> masks,
                            std::uint32_t groups, std::uint32_t stations, double goal_density,
                            const VoxelDemands& demands) {
  NetworkCounts all = reduce_field(counts, masks, stations, goal_density, demands);
  std::vector<std::uint32_t> group_counts;
  std::vector<std::uint64_t> group_masks;
  VoxelDemands group_demands;
  for (std::uint32_t g = 0; g < groups; ++g) {
    group_counts.clear();
    group_masks.clear();
    group_demands = {};
    for (std::size_t i = g; i < counts.size(); i += groups) {
      group_counts.push_back(counts[i]);
      if (!demands.weights.empty()) group_demands.weights.push_back(demands.weights[i]);
      if (!demands.point_weights.empty()) group_demands.point_weights.push_back(demands.point_weights[i]);
    }
    for (std::size_t w = 0; w * counts.size() < masks.size(); ++w)
      for (std::size_t i = g; i < counts.size(); i += groups) group_masks.push_back(masks[w * counts.size() + i]);
    all.groups.push_back(reduce_field(group_counts, group_masks, stations, goal_density, group_demands));
    // A group without voxels still needs zeros for its stations.
    if (!masks.empty() && all.groups.back().seen.empty()) {
      all.groups.back().seen.resize(all.seen.size());
      all.groups.back().shared.resize(all.shared.size());
    }
  }
  if (groups == 0) {
    all.successive_difference_sum = std::numeric_limits<double>::infinity();
    return all;
  }
  const auto filled = [&, goal = goal_density * demands.least_point_weight()](std::size_t i) {
    return std::min(static_cast<double>(std::uint64_t{counts[i]} * demands.point_weight(i)) / goal, 1.0);
  };
  for (std::size_t i = 1; i < counts.size(); ++i) {
    const double step = filled(i) - filled(i - 1);
    all.successive_difference_sum += step * step;
  }
  return all;
}

}  // namespace vantage
