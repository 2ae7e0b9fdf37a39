// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace vantage {

// Visits each station with a point in a voxel, ascending. `masks`: as in `VoxelField`, words of 64 stations for each of
// `voxels` voxels, one word of all of them after another.
template <class Visit>
void for_each_station(std::span<const std::uint64_t> masks, std::size_t voxels, std::size_t voxel, const Visit& visit) {
  for (std::size_t at = voxel, first = 0; at < masks.size(); at += voxels, first += 64)
    for (std::uint64_t mask = masks[at]; mask != 0; mask &= mask - 1)
      visit(first + static_cast<std::size_t>(std::countr_zero(mask)));
}

}  // namespace vantage
