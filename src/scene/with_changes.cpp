// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "core/site_reach.hpp"
#include "scene/glob.hpp"
#include "scene/positions.hpp"
#include "scene/scene_data.hpp"
#include "scene/scene_mesh.hpp"
#include "scene/sound_triangle.hpp"
#include "vantage/error.hpp"
#include "vantage/scene_builder.hpp"

namespace vantage {
namespace {

void require_match(const Scene& scene, const std::string& pattern, const char* what) {
  constexpr std::size_t kMostTold = 5;
  std::vector<std::string> names;
  for (const MeshInfo& mesh : scene.meshes()) {
    if (glob_matches(pattern, mesh.name)) return;
    if (std::ranges::find(names, mesh.name) == names.end()) names.push_back(mesh.name);
  }
  std::string some;
  for (std::size_t k = 0; k < std::min(names.size(), kMostTold); ++k) some += (k ? ", \"" : "\"") + names[k] + '"';
  throw Error(Errc::invalid_argument, std::string("no mesh to ") + what + " matches \"" + pattern + "\"; meshes are " +
                                          some + (names.size() > kMostTold ? ", …" : ""));
}

class Changing {
 public:
  explicit Changing(const SceneData& scene) : data_(flat_copy(scene)) {
    before_.triangles.swap(data_->triangles);
    before_.ranges.swap(data_->ranges);
    before_.meshes.swap(data_->meshes);
    data_->triangles.reserve(before_.triangles.size());
    for (const MeshRange& range : before_.ranges)
      corners_.push_back(range.triangle_count == 0 ? std::pair(1u, 0u) : corner_range(triangles_of(range)));
  }

  const std::vector<MeshInfo>& meshes() const { return before_.meshes; }

  void keep(std::size_t m) {
    const std::span<const Triangle> triangles = triangles_of(before_.ranges[m]);
    append(m, {triangles.begin(), triangles.end()});
  }

  void move(std::size_t m, const Pose& pose) {
    std::vector<Triangle> triangles(triangles_of(before_.ranges[m]).begin(), triangles_of(before_.ranges[m]).end());
    if (!triangles.empty()) {
      const auto [low, high] = corners_[m];
      std::uint32_t first = low;
      if (!alone(m)) {  // other meshes have corners between: copy its own
        first = copy(low, high);
        for (Triangle& t : triangles)
          for (std::uint32_t& v : t) v += first - low;
      }
      const glm::dmat3 turn = turn_of(pose);
      const glm::dvec3 origin = to_glm(data_->origin), shift = turn * origin - origin + to_glm(pose.translation);
      for (std::uint32_t v = first; v <= first + (high - low); ++v) {
        data_->positions[v] = placed_at(turn * to_glm(data_->positions[v]) + shift, before_.meshes[m].name);
        if (!data_->normals.empty()) data_->normals[v] = to_float3(turn * to_glm(data_->normals[v]));
      }
      drop_without_area(triangles);
    }
    append(m, triangles);
  }

  void add(SceneMesh mesh, std::size_t number) {
    check(mesh, number);
    const Role role = mesh.role.value_or(Role::surveyed);
    if (role != Role::surveyed && role != Role::blocking)
      throw Error(Errc::invalid_argument, "mesh " + std::to_string(number) + " \"" + mesh.name +
                                              "\" is added to be neither surveyed nor blocking");
    compact(mesh);
    const auto first = static_cast<std::uint32_t>(data_->positions.size());
    require_numbers(data_->positions.size() + mesh.positions.size());
    for (const glm::dvec3& p : placed(mesh))
      data_->positions.push_back(placed_at(p - to_glm(data_->origin), mesh.name));
    if (!data_->normals.empty()) data_->normals.resize(data_->positions.size());
    if (!data_->texcoords.empty()) data_->texcoords.resize(data_->positions.size());
    if (!data_->colours.empty()) data_->colours.resize(data_->positions.size(), 0xFFFFFFFFu);
    std::vector<Triangle> triangles;
    for (const Triangle& t : mesh.triangles) triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    drop_without_area(triangles);
    data_->materials.push_back(material_of(mesh));
    append(info_of(mesh, role), static_cast<std::uint32_t>(data_->materials.size() - 1), triangles);
  }

  Scene finish() {
    const bool any = std::ranges::any_of(
        data_->meshes, [](const MeshInfo& mesh) { return mesh.role == Role::surveyed && mesh.triangle_count > 0; });
    if (!any) throw Error(Errc::malformed_file, "nothing is left to survey after the change");
    data_->local_bounds = parallel::reduce(
        tbb::blocked_range<std::size_t>(0, data_->triangles.size(), 4096), Box{},
        [&](const tbb::blocked_range<std::size_t>& range, Box box) {
          for (std::size_t t = range.begin(); t != range.end(); ++t)
            for (const std::uint32_t v : data_->triangles[t]) box.extend(widen(data_->positions[v]));
          return box;
        },
        united);
    return Scene(std::move(data_));
  }

 private:
  std::span<const Triangle> triangles_of(const MeshRange& range) const {
    return std::span(before_.triangles).subspan(range.first_triangle, range.triangle_count);
  }
  // Returns true if no other mesh has corners between its first and its last.
  bool alone(std::size_t m) const {
    for (std::size_t other = 0; other < corners_.size(); ++other)
      if (other != m && corners_[other].first <= corners_[m].second && corners_[m].first <= corners_[other].second)
        return false;
    return true;
  }
  static void require_numbers(std::size_t positions) {
    if (positions > 0xFFFFFFFFu)
      throw Error(Errc::out_of_memory, "the changed scene has more than 2^32 positions; make it smaller");
  }
  // Copies corners; returns the number of the first copy.
  std::uint32_t copy(std::uint32_t low, std::uint32_t high) {
    const std::size_t first = data_->positions.size(), count = std::size_t{high} - low + 1;
    require_numbers(first + count);
    const auto extend = [&](auto& values) {
      if (values.empty()) return;
      values.resize(first + count);
      std::copy_n(values.begin() + low, count, values.begin() + static_cast<std::ptrdiff_t>(first));
    };
    extend(data_->positions), extend(data_->normals), extend(data_->texcoords), extend(data_->colours);
    return static_cast<std::uint32_t>(first);
  }
  Float3 placed_at(const glm::dvec3& local, const std::string& name) const {
    require_in_reach(to_vec3(local) + data_->origin, data_->origin, "a position of the mesh \"" + name + "\" would be");
    return without_minus_zero(to_float3(local));
  }
  void drop_without_area(std::vector<Triangle>& triangles) const {
    const std::vector<Float3>& p = data_->positions;
    std::erase_if(triangles,
                  [&](const Triangle& t) { return !has_area(to_glm(p[t[0]]), to_glm(p[t[1]]), to_glm(p[t[2]])); });
  }
  void append(std::size_t m, const std::vector<Triangle>& triangles) {
    append(before_.meshes[m], before_.ranges[m].material, triangles);
  }
  void append(MeshInfo mesh, std::uint32_t material, const std::vector<Triangle>& triangles) {
    if (data_->triangles.size() + triangles.size() > std::size_t{1} << 31)
      throw Error(Errc::invalid_argument, "the changed scene has more than 2^31 triangles");
    const auto count = static_cast<std::uint32_t>(triangles.size());
    data_->ranges.push_back({static_cast<std::uint32_t>(data_->triangles.size()), count, material});
    mesh.triangle_count = count;
    data_->meshes.push_back(std::move(mesh));
    data_->triangles.insert(data_->triangles.end(), triangles.begin(), triangles.end());
  }

  std::shared_ptr<SceneData> data_;
  struct Before {
    std::vector<Triangle> triangles;
    std::vector<MeshRange> ranges;
    std::vector<MeshInfo> meshes;
  } before_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> corners_;  // of each mesh: its first and its last
};

}  // namespace

Scene with_changes(const Scene& scene, const SceneChange& change) {
  for (const auto& [pattern, pose] : change.move) {
    require_match(scene, pattern, "move");
    check(pose, "the pose of \"" + pattern + "\"");
  }
  for (const std::string& pattern : change.remove) require_match(scene, pattern, "remove");
  Changing changing(scene.data());
  std::optional<std::span<const SceneMesh>> to_add = change.add;
  const auto add = [&] {
    for (std::size_t k = 0; to_add && k < to_add->size(); ++k) changing.add((*to_add)[k], k);
    to_add.reset();
  };
  for (std::size_t m = 0; m < changing.meshes().size(); ++m) {
    const std::string& name = changing.meshes()[m].name;
    if (changing.meshes()[m].glass) add();  // meshes of glass come last
    if (std::ranges::any_of(change.remove, [&](const std::string& pattern) { return glob_matches(pattern, name); }))
      continue;
    const auto moved =
        std::ranges::find_if(change.move, [&](const auto& one) { return glob_matches(one.first, name); });
    if (moved == change.move.end())
      changing.keep(m);
    else
      changing.move(m, moved->second);
  }
  add();
  return changing.finish();
}

}  // namespace vantage
