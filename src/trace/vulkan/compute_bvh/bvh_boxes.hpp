// SPDX-License-Identifier: Apache-2.0
// Boxes of a BVH's nodes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "scene/scene_data.hpp"
#include "shared/bvh_types.h"

namespace vantage {

struct Bounds3 {
  std::array<float, 3> min, max;
  Bounds3() {
    min.fill(std::numeric_limits<float>::infinity());
    max.fill(-std::numeric_limits<float>::infinity());
  }
  void extend(const Bounds3& b) {
    for (std::size_t k = 0; k < 3; ++k) {
      min[k] = std::min(min[k], b.min[k]);
      max[k] = std::max(max[k], b.max[k]);
    }
  }
  void extend(const Float3& p) {
    const std::array<float, 3> v{p.x, p.y, p.z};
    for (std::size_t k = 0; k < 3; ++k) {
      min[k] = std::min(min[k], v[k]);
      max[k] = std::max(max[k], v[k]);
    }
  }
  // [centre − half_size, centre + half_size] contains the box and `widening` on all sides, whatever the rounding.
  vec3 centre() const { return {middle(0), middle(1), middle(2)}; }
  vec3 half_size(float widening) const { return {half(0, widening), half(1, widening), half(2, widening)}; }
  float half_area() const {
    const float x = max[0] - min[0], y = max[1] - min[1], z = max[2] - min[2];
    return x < 0 ? 0.0f : x * y + y * z + z * x;
  }

 private:
  float middle(std::size_t axis) const { return empty() ? 0.0f : 0.5f * (min[axis] + max[axis]); }
  float half(std::size_t axis, float widening) const {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const float half = std::nextafter(std::max(max[axis] - middle(axis), middle(axis) - min[axis]), kInfinity);
    return empty() ? -kInfinity : std::nextafter(half + widening, kInfinity);
  }
  bool empty() const { return min[0] > max[0]; }
};

// Returns twice the widening of shaders/lib/widening.glsl for rays from up to twice the largest coordinate. Rays from
// further away use larger boxes.
inline float widening_of(const Bounds3& all) {
  float largest = 1e-3f;
  for (std::size_t k = 0; k < 3; ++k) largest = std::max({largest, std::abs(all.min[k]), std::abs(all.max[k])});
  return 2 * largest / 262144;
}

struct Children {
  Bounds3 box0, box1;
  std::uint32_t child0, child1;
};

inline BvhNode node_of(const Children& c, float widening) {
  return {c.box0.centre(), c.child0, c.box0.half_size(widening), c.child1,
          c.box1.centre(), widening, c.box1.half_size(widening), 0};
}

}  // namespace vantage
