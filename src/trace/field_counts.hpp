// SPDX-License-Identifier: Apache-2.0
// From counts and station masks per voxel to the integers that the objectives need.
#pragma once

#include <cstdint>
#include <span>

#include "vantage/trace.hpp"
#include "voxel/voxel_demands.hpp"

namespace vantage {

// Fills voxels, weight, saturated, partial_points, stations and, where `masks` is not empty, seen and shared. A voxel
// whose count is at least its goal is saturated; `goal_density` is the densest. `masks`: as in `VoxelField`, or empty.
// `demands`: of each voxel that is counted. Parallel; O(N · (S + s²/64)) for N voxels and S stations, s of which see
// the same 64 voxels.
NetworkCounts reduce_field(std::span<const std::uint32_t> counts, std::span<const std::uint64_t> masks,
                           std::uint32_t stations, double goal_density, const VoxelDemands& demands = {});

}  // namespace vantage
