// SPDX-License-Identifier: Apache-2.0
// A triangle as seen from a head, to be drawn. It knows which rays RayCaster certainly reports it for, and which it
// cannot report it for.
//
// Embree lets a ray of direction d through where the three Uₖ = edgeₖ·d have one sign, each off by up to doubtₖ. As d =
// Σ Uₖ cornerₖ / K with K = normal·corner, Σ|Uₖ| >= K / farthest. If that is eight times the doubt, a ray may pass only
// before the head, and the point where it meets the plane lies in the triangle, stretched from its middle by less than
// 1 + 4 doubt / (K / farthest − 6 doubt). If not, the triangle is flat: seen edge-on, a sliver, or far too small. Then
// all |Uₖ| <= 11 doubt / γ, where the triangle is γ · farthest from the head: a band of directions. Planes confines it
// to the triangle's ball.
#pragma once

#include <array>
#include <cstdint>

#include "trace/rays_of_box.hpp"
#include "trace/tracer.hpp"
#include "vantage/types.hpp"

namespace vantage {

struct DrawnTriangle {
  // `corners`: relative to the head. `turned`: the station is turned, so that directions are rounded once more.
  DrawnTriangle(const std::array<Vec3, 3>& corners, bool turned);

  std::array<Vec3, 3> corner;
  std::array<Vec3, 3> edge;     // unit normals of the planes through head and edges, inwards; 0 if there is none
  std::array<double, 3> doubt;  // of edgeₖ·d for a unit direction: Embree's, and that of directions and drawing
  Vec3 normal;                  // unit, away from the head
  double height;                // of the plane over the head
  double farthest;              // corner
  Vec3 middle;
  double radius;   // of the ball around the middle that holds the corners
  double stretch;  // of the triangle, so that it contains all points of rays that may pass
  bool flat;
  bool certain;  // Embree's own distance is accurate enough to find every hit

  // Flat triangles: |normal·d| <= doubt for all rays that may pass.
  struct Band {
    Vec3 normal;   // unit
    double doubt;  // infinite: no bound
  };
  Band band() const;

  double distance() const;  // Returns the distance of the head from the triangle.
  // Bounds on the rays that may pass. REQUIRES: not flat.
  RayRanges rays(const RayPattern& pattern, const Turn* turn) const;

 private:
  double most_doubt_;         // of twice areas
  std::size_t largest_edge_;  // the edge with the largest triangle between it and the head
  double largest_;
};

// Turns a direction from the local frame to the scanner's. Dot products with the pattern's directions, before their
// turn, are exact.
Vec3 turned_back(const Turn* turn, const Vec3& v);

}  // namespace vantage
