// SPDX-License-Identifier: Apache-2.0
#include "scene/all_surveyed.hpp"

#include "scene/scene_data.hpp"

namespace vantage {

Scene all_surveyed(const Scene& scene, bool through_glass) {
  const SceneData& given = scene.data();
  auto data = std::make_shared<SceneData>();
  data->origin = given.origin;
  data->positions = given.positions;
  data->triangles = given.triangles;
  data->places = given.places;
  data->set_instances(given.instances);
  data->ranges = given.ranges;
  data->meshes = given.meshes;
  for (MeshRange& range : data->ranges) range.material = 0;
  for (MeshInfo& mesh : data->meshes) {
    if (mesh.glass || mesh.mirror) {
      mesh.glass = mesh.glass && through_glass;
      continue;
    }
    mesh.role = Role::surveyed, mesh.weight = 1;
    mesh.detail_m = mesh.accuracy_m = 0;
  }
  data->materials.emplace_back();
  data->local_bounds = given.local_bounds;
  return Scene(std::move(data));
}

}  // namespace vantage
