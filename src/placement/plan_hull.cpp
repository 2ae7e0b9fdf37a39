// SPDX-License-Identifier: Apache-2.0
#include "placement/plan_hull.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

namespace vantage {
namespace {

double turn(Uv a, Uv b, Uv c) { return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u); }

// Drops points inside the octagon of the outermost points in eight directions, which are nearly all of a large mesh
// (Akl and Toussaint, A Fast Convex Hull Algorithm, 1978).
void drop_inside(std::vector<Uv>& points) {
  if (points.size() < 100) return;
  constexpr std::array<Uv, 8> kWays{{{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
  std::array<Uv, 8> corner;
  for (std::size_t w = 0; w < kWays.size(); ++w)
    corner[w] = *std::max_element(points.begin(), points.end(), [way = kWays[w]](Uv a, Uv b) {
      return way.u * a.u + way.v * a.v < way.u * b.u + way.v * b.v;
    });
  std::erase_if(points, [&](Uv p) {
    for (std::size_t w = 0; w < corner.size(); ++w) {
      const Uv a = corner[w], b = corner[(w + 1) % corner.size()];
      if (a != b && turn(a, b, p) <= 0) return false;
    }
    return true;
  });
}

Rectangle rectangle_along(const std::vector<Uv>& hull, double cosine, double sine) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Rectangle r{cosine, sine, {kInfinity, kInfinity}, {-kInfinity, -kInfinity}};
  for (const Uv p : hull) {
    const Uv q = r.along(p);
    r.min = {std::min(r.min.u, q.u), std::min(r.min.v, q.v)};
    r.max = {std::max(r.max.u, q.u), std::max(r.max.v, q.v)};
  }
  return r;
}

}  // namespace

std::vector<Uv> convex_hull(std::vector<Uv> points) {
  drop_inside(points);
  const auto less = [](Uv a, Uv b) { return std::tie(a.u, a.v) < std::tie(b.u, b.v); };
  std::sort(points.begin(), points.end(), less);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Uv> hull;
  const auto walk = [&](auto first, auto last) {
    const std::size_t start = hull.size();
    for (auto p = first; p != last; ++p) {
      while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), *p) <= 0) hull.pop_back();
      hull.push_back(*p);
    }
    hull.pop_back();  // the other walk begins with it
  };
  walk(points.begin(), points.end());
  walk(points.rbegin(), points.rend());
  return hull;
}

double hull_area(const std::vector<Uv>& hull) {
  double twice = 0;
  for (std::size_t i = 2; i < hull.size(); ++i) twice += turn(hull[0], hull[i - 1], hull[i]);
  return 0.5 * twice;
}

Rectangle smallest_rectangle(const std::vector<Uv>& hull) {
  Rectangle best = rectangle_along(hull, 1, 0);
  double least = 0.9 * best.area();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Uv a = hull[i], b = hull[(i + 1) % hull.size()];
    const double length = std::hypot(b.u - a.u, b.v - a.v);
    if (!(length > 0)) continue;
    const Rectangle r = rectangle_along(hull, (b.u - a.u) / length, (b.v - a.v) / length);
    if (r.area() < least) {
      best = r;
      least = r.area();
    }
  }
  return best;
}

}  // namespace vantage
