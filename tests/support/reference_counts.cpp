// SPDX-License-Identifier: Apache-2.0
#include "support/reference_counts.hpp"

namespace vantage::test {

NetworkCounts reference_counts(const PassField& field, std::uint32_t stations, double goal_density,
                               const VoxelDemands& demands) {
  NetworkCounts counts;
  counts.voxels = field.count.size();
  counts.stations = stations;
  counts.point_weight = demands.least_point_weight();
  for (std::size_t k = 0; k < field.count.size(); ++k) {
    const std::uint32_t n = field.count[k], weight = demands.weight(k), point_weight = demands.point_weight(k);
    counts.weight += weight;
    if (static_cast<double>(n) * point_weight >= goal_density * counts.point_weight) {
      counts.saturated += weight;
    } else {
      counts.partial_points += std::uint64_t{n} * point_weight * weight;
    }
  }
  if (field.stations.empty()) return counts;
  const std::size_t voxels = field.count.size();
  const auto sees = [&](std::uint32_t station, std::size_t voxel) {
    return field.stations[station / 64 * voxels + voxel] >> (station % 64) & 1;
  };
  for (std::uint32_t i = 0; i < stations; ++i) {
    counts.seen.push_back(0);
    for (std::size_t k = 0; k < voxels; ++k) counts.seen[i] += sees(i, k);
    for (std::uint32_t j = i + 1; j < stations; ++j) {
      counts.shared.push_back(0);
      for (std::size_t k = 0; k < voxels; ++k) counts.shared.back() += sees(i, k) & sees(j, k);
    }
  }
  return counts;
}

}  // namespace vantage::test
