// SPDX-License-Identifier: Apache-2.0
// Finds the triangles of a plane mesh that contain a point (section 4.2).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"
#include "vantage/types.hpp"

namespace vantage {

// A point within a triangle, by the barycentric coordinates of equation 3: (1 − s − t)·i + s·j + t·k.
struct TrianglePoint {
  std::uint32_t triangle = 0;
  double s = 0, t = 0;
};

// A quadtree over the triangles of a plane mesh. Immutable, safe to read from any thread; borrows its arrays.
//
// No point on an edge or a vertex is lost. The test if a point lies left of an edge uses the edge's end points in one
// fixed order, so the two triangles of an edge never both reject it. A point that all triangles reject goes to the
// nearest one within `slack()`, at the nearest point of its outline. This also closes T-junctions, and covers rounding
// of the query at the mesh's outline.
class PlaneQuadtree {
 public:
  // Triangles without area (to rounding), or with a coordinate that is not finite, are no candidates. REQUIRES: indices
  // below points.size(); both arrays outlive the tree.
  PlaneQuadtree(std::span<const Uv> points, std::span<const Triangle> triangles);

  // Returns true if the tree would have a candidate.
  static bool any_candidate(std::span<const Uv> points, std::span<const Triangle> triangles);

  bool empty() const { return candidates_ == 0; }
  std::uint32_t candidates() const { return candidates_; }
  Uv min() const { return min_; }  // bounds of the candidates
  Uv max() const { return max_; }
  double slack() const { return slack_; }

  // Returns the first triangle, in the order of the mesh, that contains p.
  std::optional<TrianglePoint> find(Uv p) const;
  // Visits every triangle that contains p (to slack), ascending.
  void find_all(Uv p, const std::function<void(const TrianglePoint&)>& found) const;
  // Returns the triangles of each leaf, ascending; two triangles that overlap share a leaf.
  std::vector<std::span<const std::uint32_t>> leaves() const;

 private:
  struct Node {
    std::uint32_t child = 0;             // first of four; 0: a leaf
    std::uint32_t first = 0, count = 0;  // of a leaf, into items_
  };
  struct Cell {
    Uv min, max;
  };
  class Builder;
  std::span<const std::uint32_t> leaf_at(Uv p) const;  // empty outside
  bool overlaps(std::uint32_t triangle, const Cell& cell) const;
  bool covers(std::uint32_t triangle, const Cell& cell) const;
  bool holds(std::uint32_t triangle, Uv p) const;
  TrianglePoint coordinates(std::uint32_t triangle, Uv p) const;
  // Returns the distance from p to the triangle's outline, and the nearest point of the outline.
  double nearest(std::uint32_t triangle, Uv p, TrianglePoint& at) const;

  std::span<const Uv> points_;
  std::span<const Triangle> triangles_;
  std::uint32_t candidates_ = 0;
  double slack_ = 0;
  Uv min_, max_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
};

}  // namespace vantage
