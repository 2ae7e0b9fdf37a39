// SPDX-License-Identifier: Apache-2.0
#include "vantage/scene.hpp"

#include <string>

#include "scene/raw_scene.hpp"
#include "scene/scene_data.hpp"
#include "vantage/error.hpp"

namespace vantage {

Scene Scene::from_triangles(std::span<const Vec3> positions, std::span<const std::array<std::uint32_t, 3>> triangles,
                            double diffuse) {
  if (!(diffuse >= 0 && diffuse <= 1))
    throw Error(Errc::invalid_argument,
                "the diffuse coefficient must be in [0, 1]; " + std::to_string(diffuse) + " was given");
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const std::uint32_t v : triangles[t])
      if (v >= positions.size())
        throw Error(Errc::invalid_argument, "triangle " + std::to_string(t) + " refers to position " +
                                                std::to_string(v) + "; there are " + std::to_string(positions.size()));
  RawScene raw;
  raw.positions.reserve(positions.size());
  for (const Vec3& p : positions) raw.positions.push_back(to_glm(p));
  raw.triangles.assign(triangles.begin(), triangles.end());
  const auto count = static_cast<std::uint32_t>(triangles.size());
  raw.ranges = {{0, count, 0}};
  raw.meshes = {{.name = "triangles", .diffuse = diffuse, .triangle_count = count}};
  return Scene(finish_scene(std::move(raw), "the triangle list"));
}

Box Scene::bounds() const noexcept {
  Box box = data_->local_bounds;
  if (!box.empty()) {
    box.min = box.min + data_->origin;
    box.max = box.max + data_->origin;
  }
  return box;
}
std::span<const MeshInfo> Scene::meshes() const noexcept { return data_->meshes; }
std::size_t Scene::triangle_count() const noexcept { return data_->triangle_count(); }
std::span<const Room> Scene::rooms() const noexcept { return data_->rooms; }
bool Scene::has_search_area() const noexcept { return !data_->search_triangles.empty(); }
std::span<const std::string> Scene::notes() const noexcept { return data_->notes; }
const std::string& Scene::defaults_json() const noexcept { return data_->defaults_json; }
const SceneOptions& Scene::options() const noexcept { return data_->options; }

}  // namespace vantage
