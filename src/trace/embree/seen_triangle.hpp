// SPDX-License-Identifier: Apache-2.0
// A triangle as seen from a head, in double precision. Its tests predict with certainty what RayCaster reports.
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
  // Corners relative to the head.
  SeenTriangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    normal_ = cross(b - a, c - a);
    height_ = dot(normal_, a);
    const double sign = height_ < 0 ? -1 : 1;
    normal_ = normal_ * sign;
    height_ *= sign;
    edge_ = {cross(a, b) * sign, cross(b, c) * sign, cross(c, a) * sign};
    const double longest = longest_square(a, b, c);
    tolerance_ = edge_doubt * std::sqrt(std::max({dot(a, a), dot(b, b), dot(c, c)}) * longest);
    steep_ = steep * longest;
  }

  // Whether Embree is certain to report a hit. REQUIRES: is_steep(d).
  bool must_hit(const Vec3& d) const {
    return dot(edge_[0], d) > tolerance_ && dot(edge_[1], d) > tolerance_ && dot(edge_[2], d) > tolerance_;
  }
  // Whether the distance of a hit is accurate to within distance_doubt.
  bool is_steep(const Vec3& d) const { return dot(normal_, d) > steep_; }
  double distance(const Vec3& d) const { return height_ / dot(normal_, d); }
  // Whether Embree is certain to report a hit beyond `start`, and before a point of the box, for every ray that reaches
  // such a point. Each test holds for all points of a box if it holds at its corners: their directions are sums of the
  // corners' with weights that add up to at least 1.
  bool hides(const Box& box, double start) const {
    if (!(height_ > start * (1 + distance_doubt) * std::sqrt(dot(normal_, normal_)))) return false;
    for (unsigned k = 0; k < 8; ++k) {
      const Vec3 corner{k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y, k & 4 ? box.max.z : box.min.z};
      if (!(dot(normal_, corner) > height_ * (1 + distance_doubt))) return false;
      const Vec3 d = corner * (1 / std::sqrt(dot(corner, corner)));
      if (!is_steep(d) || !must_hit(d)) return false;
    }
    return true;
  }

  // Embree's edge test is a sum of products of an edge and of corners relative to the head, in float: some eight
  // roundings of 2^−24 of their product. This is eight times that.
  static constexpr double edge_doubt = 0x1p-18;
  // Embree's distance has a relative error of some 2^−19 · slenderness / cosine, since slivers give inaccurate normals.
  // Above `steep`, cosine / slenderness makes that less than distance_doubt.
  static constexpr double steep = 0x1p-5;
  static constexpr double distance_doubt = 0x1p-13;
  // Longest edge squared over twice the area; 1.15 for an equilateral triangle.
  static double slenderness(const Vec3& a, const Vec3& b, const Vec3& c, double twice_area) {
    return longest_square(a, b, c) / twice_area;
  }

 private:
  static double longest_square(const Vec3& a, const Vec3& b, const Vec3& c) {
    return std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
  }

  // All times twice the area.
  std::array<Vec3, 3> edge_;  // normals of the planes through head and edges, inwards
  Vec3 normal_;               // away from the head
  double height_, steep_;
  double tolerance_;  // of the edges
};

}  // namespace vantage
