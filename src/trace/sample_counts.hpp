// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "vantage/trace.hpp"
#include "voxel/voxel_demands.hpp"

namespace vantage {

// Applies reduce_field to a sample's counts and masks, in order of voxel index. Adds the groups (element i is in group
// i % groups) and the unweighted successive differences that standard errors need; with groups 0, neither.
NetworkCounts reduce_sample(std::span<const std::uint32_t> counts, std::span<const std::uint64_t> masks,
                            std::uint32_t groups, std::uint32_t stations, double goal_density,
                            const VoxelDemands& demands = {});

}  // namespace vantage
