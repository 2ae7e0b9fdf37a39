// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <utility>

#include "core/parallel.hpp"
#include "trace/vulkan/vulkan_tracer.hpp"

namespace vantage::vulkan {

void VulkanTracer::ensure_totals(std::size_t networks, std::uint32_t groups, std::uint32_t stride) {
  ensure(sums_.totals, networks * groups * stride * sizeof(std::uint32_t), "totals");
  ensure(sums_.station_counts, networks * sizeof(std::uint32_t), "station counts");
}

void VulkanTracer::record_totals_start(const Recorder& r, std::span<const std::uint32_t> station_counts) {
  r.update(sums_.station_counts, station_counts.data(), station_counts.size_bytes());
  r.zero(sums_.totals);
}

void VulkanTracer::record_reduction(const Recorder& r, const Reduction& reduction, std::uint32_t first_network,
                                    std::uint32_t networks, std::uint32_t stride) {
  ReducePush push{};
  push.counts = reduction.counts;
  push.masks = reduction.masks;
  push.totals = sums_.totals.address();
  push.station_counts = sums_.station_counts.address();
  push.weights = reduction.demands.weights;
  push.point_weights = reduction.demands.point_weights;
  push.voxel_count = reduction.voxels;
  push.goal = goal_point_weight();
  push.difference_shift = difference_shift(reduction.voxels);
  push.mask_words = reduction.mask_words;
  push.groups = reduction.groups;
  push.totals_stride = stride;
  push.first_network = first_network;
  push.with_differences = reduction.differences ? 1 : 0;
  const std::uint32_t in_group = groups_of(reduction.voxels, reduction.groups);
  r.dispatch(kernels_.get(Kernel::reduce), push, groups_of(in_group, reduce_voxels * reduce_rounds), reduction.groups,
             networks);
}

void VulkanTracer::read_totals(std::span<NetworkCounts> counts, std::span<const std::uint32_t> station_counts,
                               std::span<const std::uint32_t> totals, const Reduction& reduction,
                               std::uint32_t stride) const {
  const std::uint32_t point_weight = scene_.grid->demands().least_point_weight();
  parallel::for_all(std::size_t{0}, counts.size(), [&](std::size_t n) {
    NetworkCounts& sum = counts[n];
    const std::uint32_t stations = station_counts[n], pairs = stations * (stations - 1) / 2;
    sum.voxels = reduction.voxels;
    sum.stations = stations;
    sum.point_weight = point_weight;
    if (reduction.mask_words) {
      sum.seen.assign(stations, 0);
      sum.shared.assign(pairs, 0);
    }
    std::uint64_t squares = 0, edge_points = 0, edges = 0;
    for (std::uint32_t g = 0; g < reduction.groups; ++g) {
      const std::uint32_t* t = totals.data() + (n * reduction.groups + g) * stride;
      NetworkCounts group;
      group.voxels = (reduction.voxels + reduction.groups - 1 - g) / reduction.groups;
      group.stations = stations;
      group.weight = reduction.demands.weights ? reduction.weight[g] : group.voxels;
      group.point_weight = point_weight;
      group.saturated = t[totals_saturated] | std::uint64_t{t[totals_saturated + 1]} << 32;
      group.partial_points = t[totals_partial] | std::uint64_t{t[totals_partial + 1]} << 32;
      squares += t[totals_squares] | std::uint64_t{t[totals_squares + 1]} << 32;
      edge_points += t[totals_edge_points] | std::uint64_t{t[totals_edge_points + 1]} << 32;
      edges += t[totals_edges];
      if (reduction.mask_words) {
        group.seen.assign(t + totals_seen, t + totals_seen + stations);
        group.shared.assign(t + totals_seen + stations, t + totals_seen + stations + pairs);
        for (std::uint32_t k = 0; k < stations; ++k) sum.seen[k] += group.seen[k];
        for (std::uint32_t k = 0; k < pairs; ++k) sum.shared[k] += group.shared[k];
      }
      sum.weight += group.weight;
      sum.saturated += group.saturated;
      sum.partial_points += group.partial_points;
      if (reduction.groups > 1) sum.groups.push_back(std::move(group));
    }
    // If one of two voxels is saturated, (1 − c / goal)² = 1 − 2 c / goal + c² / goal².
    const double unit =
        std::ldexp(1.0, static_cast<int>(difference_shift(reduction.voxels))) / (goal_density_ * point_weight);
    sum.successive_difference_sum = static_cast<double>(squares) * unit * unit -
                                    2 * static_cast<double>(edge_points) * unit + static_cast<double>(edges);
  });
}

}  // namespace vantage::vulkan
