// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "scene/scene_data.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {

// How far a triangle's bounding box is from a voxel's cube, along the axis where that is most; rounded down.
inline float triangle_gap(const Float3& a, const Float3& b, const Float3& c, const VoxelGrid& grid,
                          const std::array<std::uint32_t, 3>& cell) {
  double most = 0;
  const auto along = [&](int axis, float p, float q, float r) {
    const double low = grid.min()[axis] + cell[axis] * grid.voxel_size(), high = low + grid.voxel_size();
    most = std::max({most, low - std::max({p, q, r}), std::min({p, q, r}) - high});
  };
  along(0, a.x, b.x, c.x);
  along(1, a.y, b.y, c.y);
  along(2, a.z, b.z, c.z);
  return std::nextafter(static_cast<float>(most), -HUGE_VALF);
}

}  // namespace vantage
