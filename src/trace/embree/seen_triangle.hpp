// SPDX-License-Identifier: Apache-2.0
// A triangle as seen from a head, in double precision: tests that are certain of what Embree's own will say.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "scene/scene_data.hpp"
#include "vantage/types.hpp"

namespace vantage {

class SeenTriangle {
 public:
  SeenTriangle() = default;
  // Corners relative to the head.
  SeenTriangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    normal_ = cross(b - a, c - a);
    const double length = std::sqrt(dot(normal_, normal_));
    double flip = length > 0 ? 1 / length : 0;
    if (dot(normal_, a) < 0) flip = -flip;
    normal_ = normal_ * flip;
    height_ = dot(normal_, a);
    steep_ = steep * slenderness(a, b, c, length);
    const double farthest = std::sqrt(std::max({dot(a, a), dot(b, b), dot(c, c)}));
    const std::array<Vec3, 3> corner{a, b, c};
    for (int k = 0; k < 3; ++k) {
      const Vec3 &p = corner[k], &q = corner[(k + 1) % 3];
      edge_[k] = cross(p, q) * (flip < 0 ? -1.0 : 1.0);
      tolerance_[k] = edge_doubt * farthest * std::sqrt(dot(q - p, q - p));
    }
  }

  // Whether Embree is bound to report one. REQUIRES: is_steep(d).
  bool must_hit(const Vec3& d) const {
    return dot(edge_[0], d) > tolerance_[0] && dot(edge_[1], d) > tolerance_[1] && dot(edge_[2], d) > tolerance_[2];
  }
  // Whether the distance of a hit is certain to within distance_doubt.
  bool is_steep(const Vec3& d) const { return dot(normal_, d) >= steep_; }
  double distance(const Vec3& d) const { return height_ / dot(normal_, d); }
  double height() const { return height_; }

  // Whether every ray from the head into the box [low, high] must hit the triangle, steeply, and before it comes to the
  // box: by at least the factor `ahead` in distance.
  bool covers(const Vec3& low, const Vec3& high, double ahead) const {
    const Vec3 centre = (low + high) * 0.5, half = (high - low) * 0.5;
    const auto least = [&](const Vec3& m) {
      return dot(m, centre) - (std::abs(m.x) * half.x + std::abs(m.y) * half.y + std::abs(m.z) * half.z);
    };
    const double depth = least(normal_);
    if (!(depth > height_ * ahead)) return false;
    const double farthest = std::sqrt(dot(centre, centre)) + std::sqrt(dot(half, half));
    return depth > steep_ * farthest && least(edge_[0]) > tolerance_[0] * farthest &&
           least(edge_[1]) > tolerance_[1] * farthest && least(edge_[2]) > tolerance_[2] * farthest;
  }

  // Embree's edge test is a sum of products of an edge and of corners relative to the head, in float: some eight
  // roundings of 2^−24 of their product. Eight times that.
  static constexpr double edge_doubt = 0x1p-18;
  // Its distance is off by some 2^−19 · slenderness / cosine, relative: the normal that it computes from a sliver's
  // edges is that much worse. Where cosine / slenderness exceeds `steep` that is less than distance_doubt.
  static constexpr double steep = 0x1p-5;
  static constexpr double distance_doubt = 0x1p-13;
  // Longest edge squared over twice the area; 1.15 for an equilateral triangle.
  static double slenderness(const Vec3& a, const Vec3& b, const Vec3& c, double twice_area) {
    return std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)}) / twice_area;
  }

 private:
  std::array<Vec3, 3> edge_;  // normals of the planes through head and edges, inwards
  std::array<double, 3> tolerance_{};
  Vec3 normal_;  // unit, away from the head
  double height_ = 0;
  double steep_ = 2;
};

}  // namespace vantage
