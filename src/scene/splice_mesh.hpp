// SPDX-License-Identifier: Apache-2.0
// A scene with one of its meshes changed, without looking at the others again.
#pragma once

#include <memory>
#include <vector>

#include "core/glm.hpp"
#include "scene/scene_data.hpp"

namespace vantage {

// What takes a mesh's place. Every position belongs to a triangle.
struct MeshPiece {
  std::vector<glm::dvec3> positions;  // survey frame
  std::vector<Triangle> triangles;    // into `positions`
  MeshInfo info;
  Material material;
};

// `before` with mesh `m` changed, exactly as finish_scene() would have made it from everything; null where that cannot
// be told without making everything: another local origin, triangles to drop, or some in one plane with those of
// another role. REQUIRES: nothing of `before` was dropped or cut, it has no attributes but positions, and a material
// for each mesh. `bounds`: of all meshes as they are now, survey frame.
std::shared_ptr<const SceneData> splice_mesh(const SceneData& before, std::size_t m, const MeshPiece& piece,
                                             const Box& bounds);

}  // namespace vantage
