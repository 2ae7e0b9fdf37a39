// SPDX-License-Identifier: Apache-2.0
#include "placement/plan_hull.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace vantage {
namespace {

std::vector<Uv> any_points() {
  std::vector<Uv> points;
  const int n = *rc::gen::inRange(3, 300);
  for (int i = 0; i < n; ++i) points.push_back({*rc::gen::inRange(-20, 21) * 0.5, *rc::gen::inRange(-20, 21) * 0.5});
  return points;
}

RC_GTEST_PROP(ConvexHull, TurnsLeftAndHoldsEveryPoint, ()) {
  const auto points = any_points();
  const auto hull = convex_hull(points);
  const auto turn = [](Uv a, Uv b, Uv c) { return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u); };
  for (std::size_t i = 0; hull.size() > 2 && i < hull.size(); ++i) {
    const Uv a = hull[i], b = hull[(i + 1) % hull.size()];
    RC_ASSERT(turn(a, b, hull[(i + 2) % hull.size()]) > 0);
    for (const Uv p : points) RC_ASSERT(turn(a, b, p) >= 0);
  }
}

RC_GTEST_PROP(SmallestRectangle, HoldsEveryPointAndIsNoLargerThanTheBox, ()) {
  const auto points = any_points();
  const auto hull = convex_hull(points);
  const Rectangle r = smallest_rectangle(hull);
  Uv low{1e300, 1e300}, high{-1e300, -1e300};
  for (const Uv p : points) {
    const Uv q = r.along(p);
    RC_ASSERT(q.u >= r.min.u - 1e-9 && q.u <= r.max.u + 1e-9 && q.v >= r.min.v - 1e-9 && q.v <= r.max.v + 1e-9);
    low = {std::min(low.u, p.u), std::min(low.v, p.v)};
    high = {std::max(high.u, p.u), std::max(high.v, p.v)};
  }
  RC_ASSERT(r.area() <= (high.u - low.u) * (high.v - low.v) + 1e-9);
  RC_ASSERT(r.area() >= hull_area(hull) - 1e-9);
}

TEST(SmallestRectangle, FindsATurnedOne) {
  const double c = std::cos(0.4), s = std::sin(0.4);
  std::vector<Uv> points;
  for (const Uv p : {Uv{0, 0}, {8, 0}, {8, 2}, {0, 2}, {3, 1}})
    points.push_back({c * p.u - s * p.v, s * p.u + c * p.v});
  EXPECT_NEAR(smallest_rectangle(convex_hull(points)).area(), 16, 1e-9);
  EXPECT_NEAR(hull_area(convex_hull(points)), 16, 1e-9);
}

}  // namespace
}  // namespace vantage
