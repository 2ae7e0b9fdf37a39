// SPDX-License-Identifier: Apache-2.0
#include "core/hash.hpp"
#include "scene/scene_data.hpp"
#include "vantage/scene.hpp"

namespace vantage {

std::uint64_t Scene::fingerprint() const noexcept {
  const SceneData& scene = data();
  Hash hash;
  hash.add(scene.origin.x), hash.add(scene.origin.y), hash.add(scene.origin.z);
  hash.add_all(scene.positions);
  hash.add_all(scene.normals);
  hash.add_all(scene.texcoords);
  hash.add_all(scene.colours);
  hash.add_all(scene.triangles);
  for (const MeshInstance& instance : scene.instances)
    hash.add(instance.first_triangle), hash.add(instance.first_stored), hash.add(instance.place);
  for (const MeshPlace& place : scene.places)
    for (const Vec3& column : {place.x, place.y, place.z, place.origin})
      hash.add(column.x), hash.add(column.y), hash.add(column.z);
  for (const MeshRange& range : scene.ranges) hash.add(range.triangle_count), hash.add(range.material);
  for (const MeshInfo& mesh : scene.meshes) {
    hash.add(static_cast<int>(mesh.role)), hash.add(mesh.diffuse), hash.add(mesh.weight), hash.add(mesh.detail_m),
        hash.add(mesh.accuracy_m);
    if (mesh.door || mesh.station_area) hash.add(mesh.door), hash.add(mesh.station_area);
    if (mesh.glass || mesh.mirror) hash.add(mesh.glass);
    if (mesh.mirror) hash.add(mesh.mirror);
  }
  for (const Material& material : scene.materials) {
    for (const float channel : material.base_colour) hash.add(channel);
    hash.add(material.image), hash.add(material.repeat_u), hash.add(material.repeat_v);
  }
  for (const Image& image : scene.images) hash.add(image.width), hash.add_all(image.rgba);
  hash.add_all(scene.search_positions);
  hash.add_all(scene.search_uvs);
  hash.add_all(scene.search_triangles);
  return hash.value();
}

}  // namespace vantage
