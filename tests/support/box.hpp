// SPDX-License-Identifier: Apache-2.0
// A box as triangles that face outwards.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vantage/types.hpp"

namespace vantage::test {

inline std::vector<Vec3> box_corners(const Vec3& low, const Vec3& high) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  return corners;
}

// Triangles of the corners above.
inline const std::vector<std::array<std::uint32_t, 3>> box_triangles{{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                                                     {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                                                     {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};

}  // namespace vantage::test
