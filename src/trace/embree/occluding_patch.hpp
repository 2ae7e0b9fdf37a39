// SPDX-License-Identifier: Apache-2.0
// Occlusion of a box by several connected triangles, none of which hides it alone.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

#include "scene/scene_data.hpp"
#include "scene/scene_difference.hpp"
#include "vantage/types.hpp"

namespace vantage {

// Opaque triangles of a scene with their neighbours. Safe to use from any thread.
class OccludingPatches {
 public:
  // Borrows the scene. Finds neighbours on first use.
  explicit OccludingPatches(const SceneData& scene, std::vector<std::uint32_t> neighbours = {})
      : scene_(scene), neighbours_(std::move(neighbours)) {}
  // Returns neighbours in a changed scene: those of triangles that stay, and those within each run of new ones. Empty
  // if they are not known yet. If several triangles meet at an edge, any neighbour across it will do.
  std::vector<std::uint32_t> neighbours_after(const SceneData& scene, const SceneDifference& difference) const;

  // True if a ray passes within `radius` of a point, as seen from the head.
  using AnyRayNear = std::function<bool(const Vec3& point, double radius)>;

  // True if every ray of the scanner that would reach a point of the box is certain to be stopped. Embree must report a
  // hit on the triangle, or on others connected to it, beyond `start` and before that point. `box` is relative to the
  // head.
  //
  // Embree computes the same product, but for its sign, for both triangles of an edge, so a ray near an edge hits one
  // of them. Triangles of a shared mesh are tested in its own frame, so scenes that share meshes have no patches. The
  // patch grows over every edge that may cut the box. It has no hole if each such edge has a triangle on either side,
  // as seen from the head. Near a corner a ray may be in doubt of several edges, so none may pass there.
  bool hide(std::uint32_t triangle, const Vec3& head, const Box& box, double start,
            const AnyRayNear& any_ray_near) const;

 private:
  const SceneData& scene_;
  mutable std::once_flag once_;
  mutable std::vector<std::uint32_t> neighbours_;
};

}  // namespace vantage
