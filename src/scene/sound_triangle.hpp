// SPDX-License-Identifier: Apache-2.0
// Tests whether a ray can meet a triangle, and whether two triangles are the same.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "scene/positions.hpp"

namespace vantage {

constexpr double kFarthest_m = 1e9;  // float32 steps by 64 m there; only broken vertices are so far

inline bool sound(const glm::dvec3& p) {
  return std::abs(p.x) <= kFarthest_m && std::abs(p.y) <= kFarthest_m && std::abs(p.z) <= kFarthest_m;
}

// A triangle has area if its normal can be formed in float. Differences of floats and their products are exact in
// double, or nearly so; collinear corners therefore give exactly 0.
inline bool has_area(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 n = cross(b - a, c - a);
  return dot(n, n) >= static_cast<double>(std::numeric_limits<float>::min());
}

inline bool comes_before(const Float3& a, const Float3& b) {
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

// Returns corners in ascending order, so that triangles over the same three points compare equal whatever their first
// corner and winding.
inline std::array<Float3, 3> sorted_corners(std::span<const Float3> positions, const Triangle& t) {
  std::array<Float3, 3> c{positions[t[0]], positions[t[1]], positions[t[2]]};
  if (comes_before(c[1], c[0])) std::swap(c[0], c[1]);
  if (comes_before(c[2], c[1])) std::swap(c[1], c[2]);
  if (comes_before(c[1], c[0])) std::swap(c[0], c[1]);
  return c;
}

}  // namespace vantage
