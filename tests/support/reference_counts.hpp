// SPDX-License-Identifier: Apache-2.0
// What a network's counts are, counted one voxel, station and pair at a time.
#pragma once

#include <cstdint>
#include <span>

#include "vantage/objective.hpp"
#include "vantage/simulator.hpp"

namespace vantage::test {

// Equations 8 and 11 from a voxel field. Without station masks in it nothing is seen or shared; without weights every
// voxel counts once.
NetworkCounts reference_counts(const VoxelField& field, std::uint32_t stations, double goal_density,
                               std::span<const std::uint8_t> weights = {});

}  // namespace vantage::test
