// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <vector>

#include "core/closest_name.hpp"
#include "objective/meshes_named.hpp"
#include "objective/whole_counts.hpp"
#include "scene/glob.hpp"
#include "vantage/error.hpp"
#include "vantage/objective.hpp"

namespace vantage {
namespace {

[[noreturn]] void refuse_meshes(const Scene& scene, std::string_view pattern) {
  std::vector<std::string> names;
  for (const MeshInfo& mesh : scene.meshes())
    if (mesh.role == Role::surveyed && std::ranges::find(names, mesh.name) == names.end()) names.push_back(mesh.name);
  throw Error(Errc::invalid_argument, "captured: no surveyed mesh is named like \"" + std::string(pattern) + "\"" +
                                          names_there_are(pattern, names));
}

}  // namespace

bool names_mesh(std::string_view pattern, std::string_view name) {
  const bool others = pattern.starts_with('!');
  if (others) pattern.remove_prefix(1);
  for (;;) {
    const std::size_t end = pattern.find('|');
    if (glob_matches(pattern.substr(0, end), name)) return !others;
    if (end == std::string_view::npos) return others;
    pattern.remove_prefix(end + 1);
  }
}

std::vector<std::uint8_t> meshes_named(const Scene& scene, std::string_view pattern) {
  std::vector<std::uint8_t> named;
  for (const MeshInfo& mesh : scene.meshes())
    named.push_back(mesh.role == Role::surveyed && names_mesh(pattern, mesh.name) ? 1 : 0);
  if (std::ranges::count(named, 1) == 0) refuse_meshes(scene, pattern);
  return named;
}

double captured(const NetworkCounts& counts, const Scene& scene, std::string_view meshes) {
  MeshVoxels all;
  bool any = false;
  for (std::size_t m = 0; m < counts.meshes.size(); ++m) {
    const MeshVoxels& own = counts.meshes[m];
    const MeshInfo& mesh = scene.meshes()[m];
    // Most meshes of a large scene have no voxel of a sample.
    if ((any && own.voxels == 0) || mesh.role != Role::surveyed || !names_mesh(meshes, mesh.name)) continue;
    any = true;
    all.voxels += own.voxels, all.captured += own.captured;
  }
  if (!any) refuse_meshes(scene, meshes);
  return all.voxels == 0 ? 0 : static_cast<double>(all.captured) / static_cast<double>(all.voxels);
}

double captured(const MeasuredNetwork& network, std::string_view meshes) {
  require_whole(network.counts, "captured");
  if (network.counts.meshes.empty() || !network.scene)
    throw Error(Errc::invalid_argument,
                "captured: voxels were not counted by mesh; the objective has to need counts and meshes");
  return captured(network.counts, *network.scene, meshes);
}

}  // namespace vantage
