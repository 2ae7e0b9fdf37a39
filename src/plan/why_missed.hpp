// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vantage/missed.hpp"

namespace vantage {

// Returns why each voxel of `ranks` is not captured by a network that left `points` in them, by lines from
// `candidates`. A cancelled call returns nothing. Throws Error invalid_argument if the spans differ in length, a voxel
// index is too large or there are no candidates.
std::vector<WhyMissed> why_missed(Site& site, std::span<const PlacedStation> candidates,
                                  std::span<const std::uint32_t> ranks, std::span<const std::uint32_t> points,
                                  const MissedOptions& options = {}, const Progress& progress = {});

// As `MissedVoxels::shares`.
std::vector<MissedShare> missed_by_node(const Simulator& simulator, std::span<const std::uint32_t> ranks,
                                        std::span<const WhyMissed> why);

}  // namespace vantage
