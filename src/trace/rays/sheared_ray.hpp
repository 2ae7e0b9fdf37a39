// SPDX-License-Identifier: Apache-2.0
// A ray in double precision. Corners are sheared so that the ray becomes the z axis (Woop, Benthin, Wald: Watertight
// Ray/Triangle Intersection, 2013), each on its own, so that neighbours agree about a shared edge. Uses only additions,
// multiplications and divisions, so that every processor gets the same bits.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "scene/scene_data.hpp"
#include "vantage/types.hpp"

namespace vantage {

class ShearedRay {
 public:
  // REQUIRES: `unit` has length 1.
  ShearedRay(const Vec3& origin, const Vec3& unit) : origin_(origin) {
    const double x = std::abs(unit.x), y = std::abs(unit.y), z = std::abs(unit.z);
    main_ = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    const Vec3 d = turned(unit);
    along_ = 1 / d.z;
    shear_x_ = d.x * along_;
    shear_y_ = d.y * along_;
  }

  struct Hit {
    double t;
    std::array<double, 2> weights;  // of the second and third corner
  };
  // Returns the point of a triangle or its edges on the line of the ray; nothing if it is seen edge-on.
  std::optional<Hit> meet(const std::array<Float3, 3>& corners) const {
    const Vec3 a = sheared(corners[0]), b = sheared(corners[1]), c = sheared(corners[2]);
    const double u = c.x * b.y - c.y * b.x, v = a.x * c.y - a.y * c.x, w = b.x * a.y - b.y * a.x;
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return std::nullopt;
    const double area = u + v + w;
    if (area == 0) return std::nullopt;
    return Hit{(u * a.z + v * b.z + w * c.z) / area * along_, {v / area, w / area}};
  }

 private:
  Vec3 turned(const Vec3& p) const { return main_ == 0 ? Vec3{p.y, p.z, p.x} : main_ == 1 ? Vec3{p.z, p.x, p.y} : p; }
  Vec3 sheared(const Float3& corner) const {
    const Vec3 p = turned(widen(corner) - origin_);
    return {p.x - shear_x_ * p.z, p.y - shear_y_ * p.z, p.z};
  }

  Vec3 origin_;
  int main_;  // the axis of the largest component
  double shear_x_, shear_y_, along_;
};

}  // namespace vantage
