// SPDX-License-Identifier: Apache-2.0
// A convex polygon, clipped by half-spaces.
#pragma once

#include <array>
#include <cstddef>

#include "core/glm.hpp"

namespace vantage {

// A square clipped by a box fits: each of the six half-spaces adds at most one corner.
class ClippedPolygon {
 public:
  using Point = glm::dvec3;

  void add(const Point& p) { corners_[size_++] = p; }
  bool empty() const { return size_ < 3; }

  // Keeps the part where side · p[axis] <= side · bound.
  void clip(int axis, double bound, double side) {
    ClippedPolygon kept;
    for (std::size_t i = 0; i < size_; ++i) {
      const Point &a = corners_[i], &b = corners_[i + 1 == size_ ? 0 : i + 1];
      const double da = side * (a[axis] - bound), db = side * (b[axis] - bound);
      if (da <= 0) kept.add(a);
      if ((da < 0 && db > 0) || (da > 0 && db < 0)) kept.add(a + (b - a) * (da / (da - db)));
    }
    *this = kept;
  }

  // Area vector, along the normal by the winding.
  Point area() const {
    Point sum(0);
    for (std::size_t i = 1; i + 1 < size_; ++i) sum += cross(corners_[i] - corners_[0], corners_[i + 1] - corners_[0]);
    return 0.5 * sum;
  }

  Point centroid() const {
    Point sum(0);
    double weight = 0;
    for (std::size_t i = 1; i + 1 < size_; ++i) {
      const double part = length(cross(corners_[i] - corners_[0], corners_[i + 1] - corners_[0]));
      sum += part * (corners_[0] + corners_[i] + corners_[i + 1]) / 3.0;
      weight += part;
    }
    return weight > 0 ? sum / weight : corners_[0];
  }

 private:
  std::array<Point, 10> corners_{};
  std::size_t size_ = 0;
};

}  // namespace vantage
