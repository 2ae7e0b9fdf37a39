// SPDX-License-Identifier: Apache-2.0
// Shared meshes of several nodes, from the file to the scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/glm.hpp"
#include "scene/positions.hpp"
#include "scene/raw_scene.hpp"

namespace vantage {

// Returns the place of a mesh with this affine transform.
MeshPlace place_of(const glm::dmat4& survey_from_mesh);
// Applies the change of axes and unit of reinterpret_axes() to a place.
MeshPlace reinterpreted(const MeshPlace& place, Unit unit, UpAxis up);

// Returns the bounds of placed positions in the local frame around `origin`.
Box placed_bounds(const MeshPlace& place, const std::vector<Float3>& positions, const Vec3& origin);

// A shared mesh at one of its places. Its triangles are numbered after the scene's own.
struct PlacedRun {
  std::size_t range = 0;    // of the scene
  std::uint32_t first = 0;  // triangle
  const MeshPlace* place = nullptr;
  const SharedMesh* shared = nullptr;
  std::uint32_t count() const { return static_cast<std::uint32_t>(shared->triangles.size()); }
  glm::dvec3 at(std::uint32_t vertex) const { return to_glm((*place)(shared->positions[vertex])); }
};
// Returns all placed runs, in the order of ranges and numbers. Borrows `raw`.
std::vector<PlacedRun> placed_runs(const RawScene& raw);
// Returns the run of a triangle. REQUIRES: it is not one of the scene's own.
std::size_t run_of(std::span<const PlacedRun> runs, std::uint32_t triangle);

// Stores some runs in place, behind the range's own triangles. `runs` has an entry for each run; those with an entry
// other than 0 are stored.
void store_placed(RawScene& raw, const std::vector<std::uint8_t>& stored);
// Stores some triangles of these runs in place, and keeps sharing the others. `taken` has a list for each shared mesh:
// empty, or one entry for each triangle. Triangles with an entry other than 0 are stored. REQUIRES: no empty list for
// the meshes of these runs.
void take_out(RawScene& raw, const std::vector<std::uint8_t>& runs,
              const std::vector<std::vector<std::uint8_t>>& taken);

// Calls visit(a, b, c) with the corners of each triangle of a range; shared meshes are placed first.
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

// Returns a part of the scene in which nothing is shared: all of the scene's own triangles, and the first shared
// meshes, as long as these have at most `most` triangles together.
RawScene excerpt(const RawScene& raw, std::size_t most);

// Triangles of the scene that cleaning dropped from shared meshes.
struct SharedCleaning {
  std::size_t not_finite = 0, without_area = 0, duplicates = 0;
};
// Drops triangles of shared meshes for the same reasons as finish_scene(). A triangle may lose its area at one of its
// places, when its corners are rounded to float there; it is then dropped at all places. Triangles that coincide with
// those of other meshes are kept.
class SharedCleaner {
 public:
  explicit SharedCleaner(RawScene& raw) : raw_(raw) {}
  void drop_not_finite();          // also stores meshes in place if rays cannot be moved to them
  void extend(Box& bounds) const;  // survey frame, in double
  void drop_without_area(const Vec3& origin);
  void drop_duplicates();
  const SharedCleaning& done() const { return done_; }

 private:
  std::vector<std::vector<const MeshPlace*>> places() const;  // per shared mesh

  RawScene& raw_;
  SharedCleaning done_;
};

// Appends shared meshes to the arrays of `data`, which hold everything else of `raw`, and numbers all triangles.
// Renumbers raw.ranges.
void append_shared(SceneData& data, RawScene& raw);

}  // namespace vantage
