// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/placed_meshes.hpp"

#include <map>

#include "scene/local_from_mesh.hpp"
#include "shared/trace_types.h"

namespace vantage::vulkan {

glm::dmat3 MeshPlacement::linear() const {
  const auto& m = columns;
  return {m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]};
}

double MeshPlacement::condition() const {
  const auto& m = columns;
  return vantage::condition({m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]});
}

PlacedMeshes placed_meshes(const SceneData& scene, bool with_glass) {
  const std::uint32_t end = with_glass ? scene.triangle_count() : scene.opaque_count();
  PlacedMeshes placed;
  std::map<std::uint32_t, std::uint32_t> known;  // by first stored triangle
  for (const MeshInstance& instance : scene.instances) {
    if (instance.place == MeshInstance::kNoPlace || instance.first_triangle >= end) continue;
    const auto [mesh, first] = known.emplace(instance.first_stored, static_cast<std::uint32_t>(placed.meshes.size()));
    if (first) placed.meshes.push_back(scene.stored(instance));
    const bool surveyed = scene.meshes[scene.mesh_of(instance.first_triangle)].role == Role::surveyed;
    placed.placements.push_back({mesh->second, instance.first_triangle | (surveyed ? surveyed_bit : 0),
                                 local_from_mesh(scene, scene.places[instance.place])});
  }
  return placed;
}

}  // namespace vantage::vulkan
