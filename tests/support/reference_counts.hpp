// SPDX-License-Identifier: Apache-2.0
// What a network's counts are, counted one voxel, station and pair at a time.
#pragma once

#include <cstdint>

#include "vantage/objective.hpp"
#include "vantage/simulator.hpp"
#include "voxel/voxel_demands.hpp"

namespace vantage::test {

// Equations 8 and 11 from a voxel field. Without station masks in it nothing is seen or shared; without demands every
// voxel counts once and has the same goal.
NetworkCounts reference_counts(const VoxelField& field, std::uint32_t stations, double goal_density,
                               const VoxelDemands& demands = {});

}  // namespace vantage::test
