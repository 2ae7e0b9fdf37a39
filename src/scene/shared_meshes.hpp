// SPDX-License-Identifier: Apache-2.0
// Meshes that several nodes share, on their way from a file to a scene.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "core/glm.hpp"
#include "scene/raw_scene.hpp"

namespace vantage {

// Of `survey_from_mesh`, which is affine.
MeshPlace place_of(const glm::dmat4& survey_from_mesh);
// The same, followed by the change of axes and unit of reinterpret_axes().
MeshPlace reinterpreted(const MeshPlace& place, Unit unit, UpAxis up);

// Stores shared meshes where they stand, as if nothing shared them: those for which `which(range, number)` is true.
void store_placed(RawScene& raw, const std::function<bool(std::size_t range, std::size_t number)>& which);

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
  void drop_not_finite();          // also stores meshes where they stand beyond what is sound
  void extend(Box& bounds) const;  // survey frame, in double
  void drop_without_area(const Vec3& origin);
  void drop_duplicates();
  const SharedCleaning& done() const { return done_; }

 private:
  // Keeps the marked triangles of a shared mesh and their vertices. Returns how many triangles it loses.
  std::size_t keep(std::size_t mesh, const std::vector<std::uint8_t>& kept);
  std::vector<std::vector<const MeshPlace*>> places() const;  // per shared mesh

  RawScene& raw_;
  SharedCleaning done_;
};

// Moves shared meshes behind the arrays of `data`, which hold everything else of `raw`, and numbers all triangles.
// Renumbers raw.ranges.
void append_shared(SceneData& data, RawScene& raw);

}  // namespace vantage
