// SPDX-License-Identifier: Apache-2.0
#include "vantage/scene_builder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/glm.hpp"
#include "scene/raw_scene.hpp"
#include "scene/scene_mesh.hpp"
#include "scene/splice_mesh.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t kMostWeight = 255;  // a byte per voxel
constexpr std::size_t kMostSpliced = 8;     // with more changed meshes, everything is built

Error refused(const std::string& what) { return Error(Errc::invalid_argument, what); }

Box bounds_of(const std::vector<glm::dvec3>& points) {
  Box box;
  for (const glm::dvec3& p : points) box.extend(to_vec3(p));
  return box;
}

}  // namespace

void check(const Pose& pose, const std::string& who) {
  const auto& q = pose.rotation;
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(length > 1e-6) || !std::isfinite(length))
    throw refused(who + ": its rotation is no quaternion of a length above 0");
  const Vec3& t = pose.translation;
  if (!std::isfinite(t.x) || !std::isfinite(t.y) || !std::isfinite(t.z))
    throw refused(who + ": its translation is not finite");
}

void check(const SceneMesh& mesh, std::size_t number) {
  const std::string who = "mesh " + std::to_string(number) + " \"" + mesh.name + "\"";
  if (!(mesh.diffuse >= 0 && mesh.diffuse <= 1))
    throw refused(who + ": the diffuse coefficient must be in [0, 1]; " + std::to_string(mesh.diffuse) + " was given");
  if (mesh.weight < 1 || mesh.weight > kMostWeight)
    throw refused(who + ": the weight must be from 1 to 255; " + std::to_string(mesh.weight) + " was given");
  for (const auto& [what, metres] : {std::pair("detail", mesh.detail_m), std::pair("accuracy", mesh.accuracy_m)})
    if (!(metres >= 0 && std::isfinite(metres)))
      throw refused(who + ": the " + what + " must be 0 or more metres; " + std::to_string(metres) + " was given");
  for (const float channel : mesh.colour)
    if (!(channel >= 0 && channel <= 1))
      throw refused(who + ": a colour's channels must be in [0, 1]; " + std::to_string(channel) + " was given");
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t])
      if (v >= mesh.positions.size())
        throw refused(who + ": triangle " + std::to_string(t) + " refers to position " + std::to_string(v) +
                      "; there are " + std::to_string(mesh.positions.size()));
  check(mesh.pose, who);
}

void compact(SceneMesh& mesh) {
  std::vector<std::uint32_t> place(mesh.positions.size(), 0);
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) place[v] = 1;
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < place.size(); ++v)
    if (place[v]) mesh.positions[kept] = mesh.positions[v], place[v] = kept++;
  mesh.positions.resize(kept);
  for (auto& t : mesh.triangles)
    for (std::uint32_t& v : t) v = place[v];
}

glm::dmat3 turn_of(const Pose& pose) {
  const auto& q = pose.rotation;
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return glm::mat3_cast(glm::dquat(q[3] / length, q[0] / length, q[1] / length, q[2] / length));
}

std::vector<glm::dvec3> placed(const SceneMesh& mesh) {
  const glm::dmat3 turn = turn_of(mesh.pose);
  const glm::dvec3 shift = to_glm(mesh.pose.translation);
  std::vector<glm::dvec3> points;
  points.reserve(mesh.positions.size());
  for (const Vec3& p : mesh.positions) points.push_back(turn * to_glm(p) + shift);
  return points;
}

MeshInfo info_of(const SceneMesh& mesh, Role role) {
  return {.name = mesh.name,
          .role = role,
          .diffuse = mesh.diffuse,
          .triangle_count = static_cast<std::uint32_t>(mesh.triangles.size()),
          .weight = mesh.weight,
          .door = mesh.door,
          .station_area = mesh.station_area,
          .detail_m = mesh.detail_m,
          .accuracy_m = mesh.accuracy_m};
}

Material material_of(const SceneMesh& mesh) {
  Material out;
  out.base_colour = mesh.colour;
  return out;
}

struct SceneBuilder::Impl {
  std::vector<SceneMesh> meshes;
  std::vector<Box> boxes;            // of the placed meshes
  std::vector<std::size_t> changed;  // since the last build
  std::shared_ptr<const SceneData> last;
  std::vector<Role> last_roles;
  bool whole = false;  // nothing of the last scene was dropped or cut
  bool all = true;

  const SceneMesh& at(std::size_t mesh) const {
    if (mesh >= meshes.size())
      throw refused("there is no mesh " + std::to_string(mesh) + "; " + std::to_string(meshes.size()) +
                    " were added, numbered from 0");
    return meshes[mesh];
  }
  void touch(std::size_t mesh) {
    if (std::ranges::find(changed, mesh) == changed.end()) changed.push_back(mesh);
  }
  std::vector<Role> roles() const {
    const bool marked = std::ranges::any_of(meshes, [](const SceneMesh& m) { return m.role == Role::surveyed; });
    std::vector<Role> out;
    for (const SceneMesh& m : meshes) out.push_back(m.role.value_or(marked ? Role::blocking : Role::surveyed));
    return out;
  }
  static bool in_scene(Role role) { return role == Role::surveyed || role == Role::blocking; }
  std::shared_ptr<const SceneData> from_everything(const std::vector<Role>& roles) {
    RawScene raw;
    for (std::size_t m = 0; m < meshes.size(); ++m) {
      raw.materials.push_back(material_of(meshes[m]));  // as in a file, used or not
      if (roles[m] == Role::ignore) continue;
      const bool search = roles[m] == Role::search;
      auto& positions = search ? raw.search_positions : raw.positions;
      auto& triangles = search ? raw.search_triangles : raw.triangles;
      const std::vector<glm::dvec3> points = placed(meshes[m]);
      const auto first = static_cast<std::uint32_t>(positions.size());
      if (points.size() > ~first || triangles.size() + meshes[m].triangles.size() > std::size_t{1} << 31)
        throw refused("mesh " + std::to_string(m) + ": more than 2^31 triangles or 2^32 positions in all");
      if (!search) {
        raw.ranges.push_back({static_cast<std::uint32_t>(triangles.size()),
                              static_cast<std::uint32_t>(meshes[m].triangles.size()), static_cast<std::uint32_t>(m)});
        raw.meshes.push_back(info_of(meshes[m], roles[m]));
      }
      positions.insert(positions.end(), points.begin(), points.end());
      for (const auto& t : meshes[m].triangles) triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    const std::size_t given = raw.triangles.size(), points = raw.positions.size(), ranges = raw.ranges.size();
    auto data = finish_scene(std::move(raw), "the builder's scene");
    whole = data->notes.empty() && data->triangles.size() == given && data->positions.size() == points &&
            data->ranges.size() == ranges;
    return data;
  }

  // Returns null if everything must be built.
  std::shared_ptr<const SceneData> from_changes(const std::vector<Role>& roles) const {
    if (!last || !whole || roles != last_roles || changed.size() > kMostSpliced) return nullptr;
    Box bounds;
    for (std::size_t m = 0; m < meshes.size(); ++m) {
      if (!in_scene(roles[m]) || boxes[m].empty()) continue;
      bounds.extend(boxes[m].min);
      bounds.extend(boxes[m].max);
    }
    std::shared_ptr<const SceneData> data = last;
    for (const std::size_t m : changed) {
      if (roles[m] == Role::ignore) continue;
      if (roles[m] == Role::search) return nullptr;
      const auto before = std::count_if(roles.begin(), roles.begin() + static_cast<std::ptrdiff_t>(m), in_scene);
      data = splice_mesh(*data, static_cast<std::size_t>(before),
                         {placed(meshes[m]),
                          {meshes[m].triangles.begin(), meshes[m].triangles.end()},
                          info_of(meshes[m], roles[m]),
                          material_of(meshes[m])},
                         bounds);
      if (!data) return nullptr;
    }
    return data;
  }
};

SceneBuilder::SceneBuilder() : impl_(std::make_unique<Impl>()) {}
SceneBuilder::~SceneBuilder() = default;
SceneBuilder::SceneBuilder(SceneBuilder&&) noexcept = default;
SceneBuilder& SceneBuilder::operator=(SceneBuilder&&) noexcept = default;

std::size_t SceneBuilder::add(SceneMesh mesh) {
  check(mesh, impl_->meshes.size());
  compact(mesh);
  impl_->boxes.push_back(bounds_of(placed(mesh)));
  impl_->meshes.push_back(std::move(mesh));
  impl_->last = nullptr;
  return impl_->meshes.size() - 1;
}

void SceneBuilder::move(std::size_t mesh, const Pose& pose) {
  check(pose, "mesh " + std::to_string(mesh) + " \"" + impl_->at(mesh).name + "\"");
  impl_->meshes[mesh].pose = pose;
  impl_->boxes[mesh] = bounds_of(placed(impl_->meshes[mesh]));
  impl_->touch(mesh);
}

void SceneBuilder::replace(std::size_t mesh, SceneMesh with) {
  impl_->at(mesh);
  check(with, mesh);
  compact(with);
  impl_->meshes[mesh] = std::move(with);
  impl_->boxes[mesh] = bounds_of(placed(impl_->meshes[mesh]));
  impl_->touch(mesh);
}

std::size_t SceneBuilder::size() const noexcept { return impl_->meshes.size(); }
bool SceneBuilder::rebuilt_all() const noexcept { return impl_->all; }

Scene SceneBuilder::build() {
  const std::vector<Role> roles = impl_->roles();
  auto data = impl_->from_changes(roles);
  impl_->all = data == nullptr;
  if (!data) data = impl_->from_everything(roles);
  impl_->last = data;
  impl_->last_roles = roles;
  impl_->changed.clear();
  return Scene(std::move(data));
}

}  // namespace vantage
