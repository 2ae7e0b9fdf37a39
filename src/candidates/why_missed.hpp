// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vantage/missed.hpp"

namespace vantage {

// Returns the status of each of `voxels` under a network that left `points` in them, by lines from `candidates`.
// `attainable` and `sparse` use the points expected of the pattern: area · cos(incidence) / (range² · Δazimuth ·
// Δzenith · sin zenith), the most over candidates with a free line in range. A cancelled call returns nothing. Throws
// Error invalid_argument if the spans differ in length, a voxel index is too large or there are no candidates.
std::vector<VoxelStatus> why_missed(Site& site, std::span<const PlacedStation> candidates,
                                    std::span<const std::uint32_t> voxels, std::span<const std::uint32_t> points,
                                    const MissedOptions& options = {}, const Progress& progress = {});

// As `MissedVoxels::shares`.
std::vector<MissedShare> missed_by_node(const Simulator& simulator, std::span<const std::uint32_t> voxels,
                                        std::span<const VoxelStatus> status);

}  // namespace vantage
