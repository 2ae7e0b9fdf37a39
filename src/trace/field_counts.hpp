// SPDX-License-Identifier: Apache-2.0
// Reduces counts and station masks per voxel to the integers that the objectives need.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "vantage/trace.hpp"
#include "voxel/voxel_demands.hpp"

namespace vantage {

// Fills voxels, weight, saturated, partial_points, stations and, unless `masks` is empty, seen and shared. A voxel is
// saturated if its count is at least its goal; `goal_density` is the densest goal. `masks`: word w of voxel k is at
// w · counts.size() + k, or empty. `demands`: of each counted voxel. Parallel; O(N · (S + s²/64)) for N voxels and S
// stations, s of which see the same 64 voxels.
NetworkCounts reduce_field(std::span<const std::uint32_t> counts, std::span<const std::uint64_t> masks,
                           std::uint32_t stations, double goal_density, const VoxelDemands& demands = {});
NetworkCounts reduce_field(const VoxelField& field, std::uint32_t stations, double goal_density,
                           const VoxelDemands& demands = {});

// Adds to `seen` and `shared` the pairs of stations in n masks of all stations. `words`: for each 64 stations a span of
// n, empty if it is 0 for all of them.
void add_pairs(std::span<const std::span<const std::uint64_t>> words, std::size_t n, std::size_t stations,
               std::span<std::uint64_t> seen, std::span<std::uint64_t> shared);

}  // namespace vantage
