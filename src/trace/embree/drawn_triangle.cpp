// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/drawn_triangle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "trace/fast_atan2.hpp"

namespace vantage {
namespace {

double length(const Vec3& v) { return std::sqrt(dot(v, v)); }

// Embree's edge test, (edge × sum of its corners)·d, has some 26 roundings of 2^−24 of its factors, and counts twice.
// Corners relative to the head are rounded, too, which moves the whole triangle. The bound is more than twice all that.
double edge_doubt(double farthest, double side, double longest) {
  return farthest * (0x1p-19 * side + 0x1p-20 * longest);
}

// Finds the zeniths between the corners of a triangle, and whether the axis may pierce it.
void find_extremes(const std::array<Vec3, 3>& p, double& least, double& most, bool& up, bool& down) {
  constexpr double kPi = std::numbers::pi;
  up = down = true;
  const double sign = dot(cross(p[1] - p[0], p[2] - p[0]), p[0]) < 0 ? -1 : 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &from = p[k], &to = p[(k + 1) % 3];
    const Vec3 m = cross(from, to) * sign;
    up = up && m.z >= 0;
    down = down && m.z <= 0;
    // The edge's great circle is highest at `top`, and lowest opposite.
    const Vec3 top{-m.x * m.z, -m.y * m.z, m.x * m.x + m.y * m.y};
    const double a = dot(cross(from, top), m) * sign, b = dot(cross(top, to), m) * sign;
    const double zenith = fast_atan2(std::abs(m.z), std::sqrt(m.x * m.x + m.y * m.y));
    if (a >= 0 && b >= 0) least = std::min(least, zenith);
    if (a <= 0 && b <= 0) most = std::max(most, kPi - zenith);
  }
}

}  // namespace

Vec3 turned_back(const Turn* turn, const Vec3& v) {
  if (!turn) return v;
  const auto row = [](const Float3& r, double s) { return Vec3{s * r.x, s * r.y, s * r.z}; };
  return row(turn->x, v.x) + row(turn->y, v.y) + row(turn->z, v.z);
}

DrawnTriangle::DrawnTriangle(const std::array<Vec3, 3>& corners, bool turned) : corner(corners) {
  const std::array<Vec3, 3>& v = corner;
  normal = cross(v[1] - v[0], v[2] - v[0]);
  const double twice_area = length(normal), volume = std::abs(dot(normal, v[0]));
  const double sign = dot(normal, v[0]) < 0 ? -1 : 1;
  normal = normal * (twice_area > 0 ? sign / twice_area : 0);
  height = twice_area > 0 ? volume / twice_area : 0;
  farthest = std::sqrt(std::max({dot(v[0], v[0]), dot(v[1], v[1]), dot(v[2], v[2])}));
  std::array<double, 3> sides, sizes;
  for (std::size_t k = 0; k < 3; ++k) sides[k] = length(v[(k + 1) % 3] - v[k]);
  const double longest = std::max({sides[0], sides[1], sides[2]});
  most_doubt_ = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    edge[k] = cross(v[k], v[(k + 1) % 3]) * sign;
    sizes[k] = length(edge[k]);
    const double own = edge_doubt(farthest, sides[k], longest) + sizes[k] * (turned ? 0x1.8p-19 : 0x1p-20);
    most_doubt_ = std::max(most_doubt_, own);
    const double scale = sizes[k] > 0 ? 1 / sizes[k] : 0;
    edge[k] = edge[k] * scale;
    doubt[k] = own * scale;
  }
  largest_edge_ = static_cast<std::size_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  largest_ = sizes[largest_edge_];
  middle = (v[0] + v[1] + v[2]) * (1.0 / 3);
  radius = 0;
  for (const Vec3& each : v) radius = std::max(radius, length(each - middle));
  flat = !(volume > 0 && volume >= 8 * most_doubt_ * farthest);
  stretch = flat ? 0 : 4 * most_doubt_ / (volume / farthest - 6 * most_doubt_);
  // The relative error is some 2^−22 (longest · slenderness + farthest) / height; RayCaster searches 2^−8 too far.
  certain = !flat && height >= 0x1p-12 * (longest * longest * longest / twice_area + farthest);
}

DrawnTriangle::Band DrawnTriangle::band() const {
  const double before = farthest > 0 ? distance() / farthest : 0;
  if (!(before > 0) || !(largest_ > 0)) return {{}, std::numeric_limits<double>::infinity()};
  const double bound = 11 * most_doubt_ / (before * largest_) + 0x1p-20;
  return {edge[largest_edge_], bound > 0x1p-4 ? std::numeric_limits<double>::infinity() : bound};
}

// Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
double DrawnTriangle::distance() const {
  const std::array<Vec3, 3>& v = corner;
  const Vec3 ab = v[1] - v[0], ac = v[2] - v[0];
  const double d1 = -dot(ab, v[0]), d2 = -dot(ac, v[0]), d3 = -dot(ab, v[1]), d4 = -dot(ac, v[1]), d5 = -dot(ab, v[2]),
               d6 = -dot(ac, v[2]);
  const auto along = [](const Vec3& from, const Vec3& whole, double part, double all) {
    return length(from + whole * (all != 0 ? std::clamp(part / all, 0.0, 1.0) : 0.0));
  };
  if (d1 <= 0 && d2 <= 0) return length(v[0]);
  if (d3 >= 0 && d4 <= d3) return length(v[1]);
  if (d6 >= 0 && d5 <= d6) return length(v[2]);
  if (d1 * d4 - d3 * d2 <= 0 && d1 >= 0 && d3 <= 0) return along(v[0], ab, d1, d1 - d3);
  if (d5 * d2 - d1 * d6 <= 0 && d2 >= 0 && d6 <= 0) return along(v[0], ac, d2, d2 - d6);
  if (d3 * d6 - d5 * d4 <= 0 && d4 >= d3 && d5 >= d6) return along(v[1], v[2] - v[1], d4 - d3, d4 - d3 + d5 - d6);
  return height;
}

RayRanges DrawnTriangle::rays(const RayPattern& pattern, const Turn* turn) const {
  constexpr double kPi = std::numbers::pi;
  std::array<Vec3, 3> p;
  std::array<double, 3> azimuth;
  double least = kPi, most = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = turned_back(turn, corner[k] + (corner[k] - middle) * stretch);
    const double zenith = fast_atan2(std::sqrt(p[k].x * p[k].x + p[k].y * p[k].y), p[k].z);
    azimuth[k] = fast_atan2(std::abs(p[k].y), p[k].x) * (p[k].y < 0 ? -1 : 1);
    least = std::min(least, zenith);
    most = std::max(most, zenith);
  }
  bool up = false, down = false;  // whether the axis may pierce it
  const double wide = radius * (1 + stretch) / length(middle);
  if (wide < 0.02 && least > 0.25 && most < kPi - 0.25) {
    // A small one away from the axis: the middle of an edge is beyond its ends by less than half of wide² / tan zenith.
    least -= 4 * wide * wide;
    most += 4 * wide * wide;
  } else {
    find_extremes(p, least, most, up, down);
  }
  if (up) least = 0;
  if (down) most = kPi;
  double low = 0, high = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    double from_first = azimuth[k] - azimuth[0];
    from_first += from_first > kPi ? -2 * kPi : from_first < -kPi ? 2 * kPi : 0;
    low = std::min(low, from_first);
    high = std::max(high, from_first);
  }
  // A turn is rounded, which moves directions; near the axis it moves azimuths more.
  if (turn) least = std::max(least - 0x1p-20, 0.0), most = std::min(most + 0x1p-20, kPi);
  const double pad = turn ? 0x1p-19 / std::max(std::min(std::sin(least), std::sin(most)), 1e-9) : 0x1p-20;
  if (up || down || high - low > 3 || pad > 0.1) return rays_between(pattern, least, most, 0, 2 * kPi);
  return rays_between(pattern, least, most, azimuth[0] + low - pad, high - low + 2 * pad);
}

}  // namespace vantage
