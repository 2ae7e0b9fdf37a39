// SPDX-License-Identifier: Apache-2.0
// Meshes that several nodes share, on their way from a file to a scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/glm.hpp"
#include "scene/positions.hpp"
#include "scene/raw_scene.hpp"

namespace vantage {

// Returns the place of a mesh with this transform, which is affine.
MeshPlace place_of(const glm::dmat4& survey_from_mesh);
// The same, followed by the change of axes and unit of reinterpret_axes().
MeshPlace reinterpreted(const MeshPlace& place, Unit unit, UpAxis up);

// Bounds of placed positions in the local frame around `origin`.
Box placed_bounds(const MeshPlace& place, const std::vector<Float3>& positions, const Vec3& origin);

// A shared mesh at one of its places. Its triangles have numbers behind those of the scene's own.
struct PlacedRun {
  std::size_t range = 0;    // of the scene
  std::uint32_t first = 0;  // triangle
  const MeshPlace* place = nullptr;
  const SharedMesh* shared = nullptr;
  std::uint32_t count() const { return static_cast<std::uint32_t>(shared->triangles.size()); }
  glm::dvec3 at(std::uint32_t vertex) const { return to_glm((*place)(shared->positions[vertex])); }
};
// All of them, in the order of ranges and numbers. Borrows `raw`.
std::vector<PlacedRun> placed_runs(const RawScene& raw);
// The run of a triangle. REQUIRES: it is none of the scene's own.
std::size_t run_of(std::span<const PlacedRun> runs, std::uint32_t triangle);

// Stores some runs where they stand, behind the range's own triangles. `runs` has an entry for each run; those that are
// not 0 are stored.
void store_placed(RawScene& raw, const std::vector<std::uint8_t>& stored);
// Stores some triangles of these runs where they stand, likewise, and shares the others. `taken` has an entry for each
// shared mesh. It is empty, or has an element for each triangle; those that are not 0 are stored. REQUIRES: it is not
// empty for the meshes of these runs.
void take_out(RawScene& raw, const std::vector<std::uint8_t>& runs,
              const std::vector<std::vector<std::uint8_t>>& taken);

// Calls visit(a, b, c) with the corners of each triangle of a range, those of shared meshes where they stand.
template <class Visit>
void for_each_placed(const RawScene& raw, std::size_t range, const Visit& visit) {
  const MeshRange& own = raw.ranges[range];
  for (std::uint32_t t = own.first_triangle; t < own.first_triangle + own.triangle_count; ++t) {
    const Triangle& v = raw.triangles[t];
    visit(raw.positions[v[0]], raw.positions[v[1]], raw.positions[v[2]]);
  }
  if (raw.placed.empty()) return;
  for (const PlacedShared& placed : raw.placed[range]) {
    const SharedMesh& shared = raw.shared[placed.mesh];
    const auto at = [&](std::uint32_t v) { return to_glm(placed.place(shared.positions[v])); };
    for (const Triangle& v : shared.triangles) visit(at(v[0]), at(v[1]), at(v[2]));
  }
}

// Returns a part of the scene in which nothing is shared. It has all of the scene's own triangles, and the first shared
// meshes as long as these have at most `most` triangles together.
RawScene excerpt(const RawScene& raw, std::size_t most);

// Number of the scene's triangles that cleaning dropped from shared meshes.
struct SharedCleaning {
  std::size_t not_finite = 0, without_area = 0, duplicates = 0;
};
// Drops triangles of shared meshes for the same reasons as finish_scene(). A triangle may have no area at one of its
// places, once its corners are rounded to float there. It is then dropped at all of its places. Triangles that coincide
// with those of other meshes are kept.
class SharedCleaner {
 public:
  explicit SharedCleaner(RawScene& raw) : raw_(raw) {}
  void drop_not_finite();          // also stores meshes where they stand that rays cannot be moved to
  void extend(Box& bounds) const;  // survey frame, in double
  void drop_without_area(const Vec3& origin);
  void drop_duplicates();
  const SharedCleaning& done() const { return done_; }

 private:
  std::vector<std::vector<const MeshPlace*>> places() const;  // per shared mesh

  RawScene& raw_;
  SharedCleaning done_;
};

// Moves shared meshes behind the arrays of `data`, which hold everything else of `raw`, and numbers all triangles.
// Renumbers raw.ranges.
void append_shared(SceneData& data, RawScene& raw);

}  // namespace vantage
