// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_data.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vantage {

std::pair<std::uint32_t, std::uint32_t> corner_range(std::span<const Triangle> triangles) {
  std::uint32_t low = 0xFFFFFFFFu, high = 0;
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) low = std::min(low, v), high = std::max(high, v);
  return {low, high};
}

Float3 placed_position(const MeshPlace& place, const Float3& stored, const Vec3& origin) {
  const Float3 p = narrow(place(stored) - origin);
  return {p.x + 0.0F, p.y + 0.0F, p.z + 0.0F};
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
  return {placed(place, positions[v[0]]), placed(place, positions[v[1]]), placed(place, positions[v[2]])};
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

std::shared_ptr<const SceneData> flattened(std::shared_ptr<const SceneData> scene) {
  if (!scene->shares()) return scene;
  auto flat = std::make_shared<SceneData>(*scene);
  flat->triangles.resize(scene->triangle_count());
  flat->set_instances({});
  flat->places.clear();
  std::size_t stored = scene->positions.size();  // in the local frame
  for (const MeshInstance& instance : scene->instances) {
    if (instance.place == MeshInstance::kNoPlace) continue;
    stored = std::min<std::size_t>(stored, corner_range(scene->stored(instance)).first);
  }
  const auto cut = [&](auto& values) {
    if (!values.empty()) values.resize(stored);
  };
  cut(flat->positions), cut(flat->normals), cut(flat->texcoords), cut(flat->colours);
  for (const MeshInstance& instance : scene->instances) {
    const std::span<const Triangle> stored_triangles = scene->stored(instance);
    Triangle* const out = flat->triangles.data() + instance.first_triangle;
    if (instance.place == MeshInstance::kNoPlace) {
      std::ranges::copy(stored_triangles, out);
      continue;
    }
    // A shared mesh's vertices are consecutive, and each belongs to a triangle.
    const MeshPlace& place = scene->places[instance.place];
    const std::pair range = corner_range(stored_triangles);
    const std::uint32_t low = range.first, high = range.second;  // lambdas below take them
    const std::size_t first = flat->positions.size(), count = high - low + 1;
    flat->positions.resize(first + count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t v) {
      flat->positions[first + v] = scene->placed(place, scene->positions[low + v]);
    });
    if (!scene->normals.empty())
      for (std::size_t v = 0; v < count; ++v) flat->normals.push_back(placed_normal(place, scene->normals[low + v]));
    const auto again = [&](auto& values, const auto& from) {
      if (!from.empty())
        values.insert(values.end(), from.begin() + low, from.begin() + static_cast<std::ptrdiff_t>(low + count));
    };
    again(flat->texcoords, scene->texcoords), again(flat->colours, scene->colours);
    const auto shift = static_cast<std::uint32_t>(first) - low;
    for (std::size_t t = 0; t < stored_triangles.size(); ++t) {
      const Triangle v = turned(stored_triangles[t], place.mirrored);
      out[t] = {v[0] + shift, v[1] + shift, v[2] + shift};
    }
  }
  return flat;
}

}  // namespace vantage
