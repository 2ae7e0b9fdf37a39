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

// Of `survey_from_mesh`, which is affine.
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

// Stores runs where they stand, behind the range's own triangles: those that are not 0, one for each run.
void store_placed(RawScene& raw, const std::vector<std::uint8_t>& stored);
// Stores some triangles of the runs that are not 0 where these stand, likewise, and shares the others. `taken` has an
// entry for each shared mesh: empty, or per triangle what is not 0 if it is taken. REQUIRES: it is not empty for these
// runs.
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

// A part of the scene in which nothing is shared: all of its own triangles, and as many shared meshes, in their order,
// as have no more than `most` triangles together.
RawScene excerpt(const RawScene& raw, std::size_t most);

// What cleaning did to shared meshes, in triangles of the scene.
struct SharedCleaning {
  std::size_t not_finite = 0, without_area = 0, duplicates = 0;
};
// Drops what finish_scene() drops. A triangle that has no area at one of its places, once rounded to float there, is
// dropped at all of them; those that coincide with triangles of other meshes are kept.
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
