// SPDX-License-Identifier: Apache-2.0
// Convex hulls in the plane and the smallest rectangles around them.
#pragma once

#include <vector>

#include "vantage/types.hpp"

namespace vantage {

// Returns the hull counter-clockwise, without collinear points (Andrew, Another Efficient Algorithm for Convex Hulls in
// Two Dimensions, 1979).
std::vector<Uv> convex_hull(std::vector<Uv> points);
double hull_area(const std::vector<Uv>& hull);

// A rectangle given by its direction: points have coordinates along (cosine, sine) in [min.u, max.u] and across it in
// [min.v, max.v].
struct Rectangle {
  double cosine = 1, sine = 0;
  Uv min, max;
  double area() const { return (max.u - min.u) * (max.v - min.v); }
  Uv along(Uv p) const { return {cosine * p.u + sine * p.v, cosine * p.v - sine * p.u}; }
};
// Returns the rectangle of least area. It is axis-aligned unless another direction saves a tenth, so that u and v
// follow x and y if possible.
Rectangle smallest_rectangle(const std::vector<Uv>& hull);

}  // namespace vantage
