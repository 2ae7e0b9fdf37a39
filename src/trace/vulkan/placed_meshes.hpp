// SPDX-License-Identifier: Apache-2.0
// Meshes that nodes share, for two-level structures: one structure for each mesh, in its own frame, and one of places.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/glm.hpp"
#include "scene/scene_data.hpp"

namespace vantage::vulkan {

struct MeshPlacement {
  std::uint32_t mesh;             // index into PlacedMeshes::meshes
  std::uint32_t base_id;          // Hit::id of its first triangle; those of the others follow
  std::array<float, 12> columns;  // local_from_mesh()
  glm::dmat3 linear() const;
  glm::dvec3 origin() const { return {columns[9], columns[10], columns[11]}; }
  double condition() const;  // of its linear part
};

struct PlacedMeshes {
  std::vector<std::span<const Triangle>> meshes;  // of SceneData::triangles
  std::vector<MeshPlacement> placements;
};

// Returns a mesh's value for each entry that kernels look up by StoredTriangle::surface: triangles, or runs of them if
// the scene shares meshes.
template <class T, class OfMesh>
std::vector<T> per_surface(const SceneData& scene, const OfMesh& of_mesh) {
  std::vector<T> values;
  if (scene.shares()) {
    for (const MeshInstance& run : scene.instances) values.push_back(of_mesh(scene.mesh_of(run.first_triangle)));
  } else {
    for (std::size_t m = 0; m < scene.ranges.size(); ++m)
      values.resize(values.size() + scene.ranges[m].triangle_count, of_mesh(m));
  }
  return values;
}

// Returns the shared meshes that stop rays, or also those of glass. Both are empty if the scene shares none. The result
// borrows the scene's triangles.
PlacedMeshes placed_meshes(const SceneData& scene, bool with_glass = false);

}  // namespace vantage::vulkan
