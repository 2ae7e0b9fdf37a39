// SPDX-License-Identifier: Apache-2.0
// Changes one mesh of a scene without processing the others.
#pragma once

#include <memory>
#include <vector>

#include "core/glm.hpp"
#include "scene/scene_data.hpp"

namespace vantage {

// Replacement of a mesh. Every position is used by a triangle.
struct MeshPiece {
  std::vector<glm::dvec3> positions;  // survey frame
  std::vector<Triangle> triangles;    // into `positions`
  MeshInfo info;
  Material material;
};

// Returns `before` with mesh `m` changed, exactly as finish_scene() would build it from all meshes. Null if only a full
// build can decide: another local origin, triangles to drop, or some in one plane with those of another role. REQUIRES:
// nothing of `before` was dropped or cut, it has no attributes except positions, and a material for each mesh.
// `bounds`: of all current meshes, survey frame.
std::shared_ptr<const SceneData> splice_mesh(const SceneData& before, std::size_t m, const MeshPiece& piece,
                                             const Box& bounds);

}  // namespace vantage
