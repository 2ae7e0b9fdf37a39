// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "voxel/voxel_grid.hpp"

namespace vantage {

// VoxelGrid::rank_of for a run of points, most of which lie where the last one did.
class VoxelCursor {
 public:
  explicit VoxelCursor(const VoxelGrid& grid) : grid_(grid), min_(grid.min()), inverse_size_(grid.inverse_size()) {}

  std::uint32_t rank_of(const Float3& p) {
    // The products that VoxelGrid::cell_of floors: equal floors, same voxel.
    const std::array<float, 3> scaled{(p.x - min_[0]) * inverse_size_, (p.y - min_[1]) * inverse_size_,
                                      (p.z - min_[2]) * inverse_size_};
    bool same = true;
    for (int axis = 0; axis < 3; ++axis) same &= scaled[axis] >= low_[axis] && scaled[axis] < low_[axis] + 1;
    if (same) return rank_;
    rank_ = grid_.rank_of(p);
    for (int axis = 0; axis < 3; ++axis) {
      // Outside the cube nothing is remembered. Up to 2^18 a float holds both a whole number and the next.
      const bool inside = scaled[axis] >= 0 && scaled[axis] < 0x1p18f;
      low_[axis] = inside ? static_cast<float>(static_cast<std::uint32_t>(scaled[axis])) : 1e30f;
    }
    return rank_;
  }

 private:
  const VoxelGrid& grid_;
  std::array<float, 3> min_;
  float inverse_size_;
  std::array<float, 3> low_{1e30f, 1e30f, 1e30f};  // the last voxel's coordinates
  std::uint32_t rank_ = no_voxel;
};

}  // namespace vantage
