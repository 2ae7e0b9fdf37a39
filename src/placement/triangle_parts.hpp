// SPDX-License-Identifier: Apache-2.0
// Parts of a triangle of the ground, each small enough to be in one room, storey or building.
#pragma once

#include <algorithm>
#include <cmath>

#include "vantage/types.hpp"

namespace vantage {

// Calls `take` with the middle of each part and its share of the triangle's area; all parts are equally large.
template <class Take>
void for_triangle_parts(const Vec3& a, const Vec3& b, const Vec3& c, const Take& take) {
  constexpr double kSide_m = 0.4;
  constexpr double kMostSides = 1000;
  const double longest = std::sqrt(std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)}));
  const auto n = static_cast<int>(std::clamp(std::ceil(longest / kSide_m), 1.0, kMostSides));
  const Vec3 u = (b - a) * (1.0 / n), v = (c - a) * (1.0 / n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j)
      for (int half = 0; half < (i + j + 1 < n ? 2 : 1); ++half) {
        const double third = (half + 1) / 3.0;
        take(a + u * (i + third) + v * (j + third), 1.0 / (double(n) * n));
      }
}

}  // namespace vantage
