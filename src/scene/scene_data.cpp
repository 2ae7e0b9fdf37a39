// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_data.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "core/parallel.hpp"
#include "core/text.hpp"
#include "scene/load_budget.hpp"
#include "vantage/error.hpp"

namespace vantage {

std::pair<std::uint32_t, std::uint32_t> corner_range(std::span<const Triangle> triangles) {
  std::uint32_t low = 0xFFFFFFFFu, high = 0;
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) low = std::min(low, v), high = std::max(high, v);
  return {low, high};
}

namespace {

// Inlined, since every pass over a scene that shares meshes places each corner.
[[gnu::always_inline]] inline Float3 position_at(const MeshPlace& place, const Float3& stored, const Vec3& origin) {
  const Float3 p = narrow(place(stored) - origin);
  return {p.x + 0.0F, p.y + 0.0F, p.z + 0.0F};
}

}  // namespace

Float3 placed_position(const MeshPlace& place, const Float3& stored, const Vec3& origin) {
  return position_at(place, stored, origin);
}

Float3 placed_normal(const MeshPlace& place, const Float3& n) {
  const Vec3 normal = place.normal_x * n.x + place.normal_y * n.y + place.normal_z * n.z;
  const double size = std::sqrt(dot(normal, normal));
  return size > 0 && std::isfinite(size) ? narrow(normal * (1 / size)) : Float3{};
}

std::uint32_t SceneData::mesh_of(std::uint32_t triangle) const {
  const auto after = std::ranges::upper_bound(ranges, triangle, {}, &MeshRange::first_triangle);
  return static_cast<std::uint32_t>(after - ranges.begin()) - 1;
}

std::uint32_t SceneData::opaque_count() const {
  std::uint32_t count = triangle_count();
  for (std::size_t m = meshes.size(); m > 0 && meshes[m - 1].glass; --m) count = ranges[m - 1].first_triangle;
  return count;
}

std::span<const Triangle> SceneData::opaque_triangles() const { return std::span(triangles).first(opaque_count()); }

void SceneData::set_instances(std::vector<MeshInstance> all) {
  instances = std::move(all);
  instance_at.clear();
  if (!shares()) return;
  std::uint32_t k = 0;
  for (std::uint64_t first = 0; first < triangle_count(); first += std::uint64_t{1} << kBlockBits) {
    while (instances[k].first_triangle + instances[k].triangle_count <= first) ++k;
    instance_at.push_back(k);
  }
}

const MeshInstance& SceneData::instance_of(std::uint32_t triangle) const {
  const MeshInstance* instance = &instances[instance_at[triangle >> kBlockBits]];
  while (triangle - instance->first_triangle >= instance->triangle_count) ++instance;
  return *instance;
}

std::array<Float3, 3> SceneData::placed_corners(std::uint32_t triangle) const {
  const MeshInstance& instance = instance_of(triangle);
  const Triangle& t = triangles[triangle - instance.first_triangle + instance.first_stored];
  if (instance.place == MeshInstance::kNoPlace) return {positions[t[0]], positions[t[1]], positions[t[2]]};
  const MeshPlace& place = places[instance.place];
  const Triangle v = turned(t, place.mirrored);
  return {position_at(place, positions[v[0]], origin), position_at(place, positions[v[1]], origin),
          position_at(place, positions[v[2]], origin)};
}

Triangle SceneData::attributes(std::uint32_t triangle) const {
  if (!shares()) return triangles[triangle];
  const MeshInstance& instance = instance_of(triangle);
  return turned(triangles[triangle - instance.first_triangle + instance.first_stored],
                instance.place != MeshInstance::kNoPlace && places[instance.place].mirrored);
}

std::array<Float3, 3> SceneData::corner_normals(std::uint32_t triangle) const {
  const Triangle v = attributes(triangle);
  std::array<Float3, 3> out{normals[v[0]], normals[v[1]], normals[v[2]]};
  if (!shares()) return out;
  if (const std::uint32_t place = instance_of(triangle).place; place != MeshInstance::kNoPlace)
    for (Float3& n : out) n = placed_normal(places[place], n);
  return out;
}

std::shared_ptr<SceneData> flat_copy(const SceneData& scene) {
  if (!scene.shares()) return std::make_shared<SceneData>(scene);
  // A shared mesh's vertices are consecutive, and each belongs to a triangle.
  std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> corners;  // by the mesh's first stored triangle
  std::uint64_t vertices = scene.positions.size();  // of the local frame, before those of shared meshes
  for (const MeshInstance& instance : scene.instances) {
    if (instance.place == MeshInstance::kNoPlace) continue;
    const auto [known, first] = corners.try_emplace(instance.first_stored);
    if (first) known->second = corner_range(scene.stored(instance));
    vertices = std::min<std::uint64_t>(vertices, known->second.first);
  }
  const auto own = static_cast<std::size_t>(vertices);
  for (const MeshInstance& instance : scene.instances)
    if (instance.place != MeshInstance::kNoPlace) {
      const auto [low, high] = corners.at(instance.first_stored);
      vertices += high - low + 1;
    }
  const std::string what = "storing shared meshes at each of their places, " + number(scene.triangle_count()) +
                           " triangles on " + number(vertices) + " vertices,";
  if (vertices > 0xFFFFFFFFu)
    throw Error(Errc::out_of_memory, "the scene: " + what + " is more than 2^32 vertices. Make the scene smaller");
  const std::uint64_t vertex = sizeof(Float3) + (scene.normals.empty() ? 0 : sizeof(Float3)) +
                               (scene.texcoords.empty() ? 0 : sizeof(Float2)) +
                               (scene.colours.empty() ? 0 : sizeof(std::uint32_t));
  LoadBudget(scene.options.max_memory_bytes, "the scene")
      .require(vertex * vertices + sizeof(Triangle) * scene.triangle_count(), what);

  auto flat = std::make_shared<SceneData>(scene);
  flat->triangles.resize(scene.triangle_count());
  flat->set_instances({});
  flat->places.clear();
  const auto for_attributes = [&](const auto& use) {
    use(flat->positions, scene.positions), use(flat->normals, scene.normals);
    use(flat->texcoords, scene.texcoords), use(flat->colours, scene.colours);
  };
  for_attributes([&](auto& values, const auto&) {
    if (values.empty()) return;
    values.resize(own);
    values.reserve(vertices);
  });
  for (const MeshInstance& instance : scene.instances) {
    const std::span<const Triangle> stored = scene.stored(instance);
    Triangle* const out = flat->triangles.data() + instance.first_triangle;
    if (instance.place == MeshInstance::kNoPlace) {
      std::ranges::copy(stored, out);
      continue;
    }
    const MeshPlace& place = scene.places[instance.place];
    const std::pair range = corners.at(instance.first_stored);
    const std::uint32_t low = range.first, high = range.second;  // lambdas below take them
    const std::size_t first = flat->positions.size();
    for_attributes([&](auto& values, const auto& from) {
      if (!from.empty()) values.insert(values.end(), from.begin() + low, from.begin() + high + 1);
    });
    parallel::for_all(first, flat->positions.size(), [&](std::size_t v) {
      flat->positions[v] = scene.placed(place, flat->positions[v]);
      if (!flat->normals.empty()) flat->normals[v] = placed_normal(place, flat->normals[v]);
    });
    const auto shift = static_cast<std::uint32_t>(first) - low;
    for (std::size_t t = 0; t < stored.size(); ++t) {
      const Triangle v = turned(stored[t], place.mirrored);
      out[t] = {v[0] + shift, v[1] + shift, v[2] + shift};
    }
  }
  return flat;
}

std::shared_ptr<const SceneData> flattened(std::shared_ptr<const SceneData> scene) {
  return scene->shares() ? flat_copy(*scene) : scene;
}

}  // namespace vantage
