// SPDX-License-Identifier: Apache-2.0
// Reduces counts and station masks per voxel to the integers that the objectives need.
#pragma once

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

}  // namespace vantage
