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

// A box as seen from a head, at the origin.
struct SeenBox {
  explicit SeenBox(const Box& box) : middle((box.min + box.max) * 0.5), half((box.max - box.min) * 0.5) {
    const Vec3 most{std::abs(middle.x) + half.x, std::abs(middle.y) + half.y, std::abs(middle.z) + half.z};
    far = std::sqrt(dot(most, most));
  }
  // The least product of a vector with a point of the box.
  double least(const Vec3& n) const {
    return dot(n, middle) - (std::abs(n.x) * half.x + std::abs(n.y) * half.y + std::abs(n.z) * half.z);
  }
  Vec3 middle, half;
  double far;  // no point is farther
};

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
  // such a point.
  bool hides(const SeenBox& box, double start) const {
    return is_before(box, start) && inside(0, box) && inside(1, box) && inside(2, box);
  }
  // Whether each hit by such a ray lies beyond `start` and before the box.
  bool is_before(const SeenBox& box, double start) const {
    const double beyond = box.least(normal_);
    return height_ > start * (1 + distance_doubt) * std::sqrt(dot(normal_, normal_)) &&
           beyond > height_ * (1 + distance_doubt) && beyond > steep_ * box.far;
  }
  // Whether all of the box is on the triangle's side of edge k, or all of it on the other; neither if it may be cut.
  // The edges are those from corner k to the next.
  bool inside(std::size_t k, const SeenBox& box) const { return box.least(edge_[k]) > tolerance_ * box.far; }
  bool outside(std::size_t k, const SeenBox& box) const { return box.least(edge_[k] * -1) > tolerance_ * box.far; }
  bool is_outside(std::size_t k, const Vec3& point) const {
    return dot(edge_[k], point) < -tolerance_ * std::sqrt(dot(point, point));
  }
  // Bound on the angle to the corner of two edges, as a sine, of a ray whose side of both is in doubt.
  double doubt_at(std::size_t k, std::size_t other) const {
    const double a = std::sqrt(dot(edge_[k], edge_[k])), b = std::sqrt(dot(edge_[other], edge_[other]));
    const Vec3 across = cross(edge_[k], edge_[other]);
    return 2 * tolerance_ * (a + b) / std::sqrt(dot(across, across));
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
