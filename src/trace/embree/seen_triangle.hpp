// SPDX-License-Identifier: Apache-2.0
// A triangle as seen from a head, in double precision. Its tests predict with certainty what RayCaster reports.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "scene/scene_data.hpp"
#include "vantage/types.hpp"

namespace vantage {

inline double largest(const Vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

// A box as seen from a head, at the origin.
struct SeenBox {
  explicit SeenBox(const Box& box) : middle((box.min + box.max) * 0.5), half((box.max - box.min) * 0.5) {
    const Vec3 most{std::abs(middle.x) + half.x, std::abs(middle.y) + half.y, std::abs(middle.z) + half.z};
    far = std::sqrt(dot(most, most));
  }
  // Returns the least product of a vector with a point of the box.
  double least(const Vec3& n) const {
    return dot(n, middle) - (std::abs(n.x) * half.x + std::abs(n.y) * half.y + std::abs(n.z) * half.z);
  }
  Vec3 middle, half;
  double far;  // no point is farther
};

// Directions from the head whose unit vectors lie within `radius` of `middle`.
struct SeenCone {
  // Bound the product of a vector with such a direction.
  double least(const Vec3& n) const { return dot(n, middle) - radius * std::sqrt(dot(n, n)); }
  double most(const Vec3& n) const { return dot(n, middle) + radius * std::sqrt(dot(n, n)); }
  Vec3 middle;
  double radius;
  static constexpr double far = 1;
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
    const double longest = longest_square(a, b, c), far = std::sqrt(std::max({dot(a, a), dot(b, b), dot(c, c)}));
    tolerance_ = kEdgeDoubt * far * std::sqrt(longest);
    slope_doubt_ = kNormalDoubt * longest;
    distance_doubt_ = slope_doubt_ * far / height_ + kRounding;
    least_slope_ = distance_doubt_ < kMostDoubt ? slope_doubt_ / (kMostDoubt - distance_doubt_) : kNever;
  }

  // Returns true if Embree is certain to report a hit whose distance is known.
  bool must_hit(const Vec3& d) const {
    return dot(edge_[0], d) > tolerance_ && dot(edge_[1], d) > tolerance_ && dot(edge_[2], d) > tolerance_;
  }
  // Bounds the distance that Embree reports for a hit; 0 and infinity if it is unknown.
  double nearest_hit(const Vec3& d) const {
    const double slope = dot(normal_, d);
    return slope > least_slope_ ? height_ / slope * (1 - doubt(slope)) : 0;
  }
  double farthest_hit(const Vec3& d) const {
    const double slope = dot(normal_, d);
    return slope > least_slope_ ? height_ / slope * (1 + doubt(slope)) : kNever;
  }
  // The same functions for all rays of a cone.
  bool must_hit(const SeenCone& cone) const { return inside(0, cone) && inside(1, cone) && inside(2, cone); }
  double nearest_hit(const SeenCone& cone) const {
    const double slope = cone.least(normal_);
    return slope > least_slope_ ? height_ / cone.most(normal_) * (1 - doubt(slope)) : 0;
  }
  double farthest_hit(const SeenCone& cone) const {
    const double slope = cone.least(normal_);
    return slope > least_slope_ ? height_ / slope * (1 + doubt(slope)) : kNever;
  }
  // Returns true if, for every ray of a cone that meets a plane, normal · p = height > 0, the hit lies before `part` of
  // the way there, minus `pad`. Exact for parallel planes, at any slant of the rays.
  bool is_before(const SeenCone& cone, const Vec3& normal, double height, double part, double pad) const {
    const double slope = cone.least(normal_), other = cone.most(normal);
    if (other <= 0) return true;
    if (!(slope > least_slope_)) return false;
    return cone.least(normal_ * (part * height) - normal * (height_ * (1 + doubt(slope)))) >
           pad * cone.most(normal_) * other;
  }
  // Returns true if Embree is certain to report a hit beyond `start`, and before a point of the box, for every ray that
  // reaches such a point.
  bool hides(const SeenBox& box, double start) const { return covers(box) && is_before(box, start); }
  // Returns true if each hit by such a ray lies beyond `start` and before the box.
  bool is_before(const SeenBox& box, double start) const {
    const double beyond = box.least(normal_), slope = beyond / box.far;
    if (!(slope > least_slope_)) return false;
    const double most = doubt(slope);
    return height_ * (1 - most) > start * std::sqrt(dot(normal_, normal_)) && beyond > height_ * (1 + most);
  }
  // Returns true if Embree certainly reports a hit for each ray to a point of the box, if its distance is known.
  bool covers(const SeenBox& box) const { return inside(0, box) && inside(1, box) && inside(2, box); }
  // Returns true if the whole box is on the triangle's side of edge k; outside() if it is all on the other side.
  // Neither holds if the edge may cut the box. Edge k goes from corner k to the next.
  template <class Region>
  bool inside(std::size_t k, const Region& region) const {
    return region.least(edge_[k]) > tolerance_ * region.far;
  }
  bool outside(std::size_t k, const SeenBox& box) const { return box.least(edge_[k] * -1) > tolerance_ * box.far; }
  bool is_outside(std::size_t k, const Vec3& point) const {
    return dot(edge_[k], point) < -tolerance_ * std::sqrt(dot(point, point));
  }
  // Bounds the angle, as a sine, between a ray in doubt of two edges and their common corner.
  double doubt_at(std::size_t k, std::size_t other) const {
    const double a = std::sqrt(dot(edge_[k], edge_[k])), b = std::sqrt(dot(edge_[other], edge_[other]));
    const Vec3 across = cross(edge_[k], edge_[other]);
    return 2 * tolerance_ * (a + b) / std::sqrt(dot(across, across));
  }

  // Embree's edge test is a sum of products of an edge and of corners relative to the head, in float: some eight
  // roundings of 2^−24 of their product. The bound is eight times that.
  static constexpr double kEdgeDoubt = 0x1p-18;
  // Returns the longest edge squared over twice the area; 1.15 for an equilateral triangle.
  static double slenderness(const Vec3& a, const Vec3& b, const Vec3& c, double twice_area) {
    return longest_square(a, b, c) / twice_area;
  }

 private:
  static double longest_square(const Vec3& a, const Vec3& b, const Vec3& c) {
    return std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
  }

  // Embree's distance is a quotient of products of a float normal, with a corner and with the ray. The normal is a
  // cross product of edges, with an error of up to 2^−22 of the longest edge squared, which may be as long as a
  // sliver's normal. The bound is four times that, to allow for the rounding of corners and products as well.
  static constexpr double kNormalDoubt = 0x1p-20;
  static constexpr double kRounding = 0x1p-22;  // of the quotient
  static constexpr double kMostDoubt = 0x1p-6;  // beyond it the distance counts as unknown
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  // Bounds the relative error of the distance of rays with at least this product with the normal.
  double doubt(double slope) const { return slope_doubt_ / slope + distance_doubt_; }

  // All times twice the area.
  std::array<Vec3, 3> edge_;  // normals of the planes through head and edges, inwards
  Vec3 normal_;               // away from the head
  double height_;
  double slope_doubt_, distance_doubt_;  // errors of the products with the ray, and with a corner (relative)
  double least_slope_;                   // of the products with rays whose distance is known
  double tolerance_;                     // of the edges
};

}  // namespace vantage
