// SPDX-License-Identifier: Apache-2.0
// Counts a network one voxel, station and pair at a time, as the reference.
#pragma once

#include <cstdint>

#include "trace/pass_field.hpp"
#include "vantage/objective.hpp"
#include "vantage/simulator.hpp"
#include "voxel/voxel_demands.hpp"

namespace vantage::test {

// Equations 8 and 11 from points and masks, of more than 64 stations word after word. Without station masks nothing is
// seen or shared. Without demands every voxel has weight 1 and the same goal.
NetworkCounts reference_counts(const PassField& field, std::uint32_t stations, double goal_density,
                               const VoxelDemands& demands = {});

}  // namespace vantage::test
