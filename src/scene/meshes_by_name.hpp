// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "vantage/scene.hpp"

namespace vantage {

// Meshes of one name, which a reader takes for one element.
struct MeshesByName {
  std::vector<std::string> names;    // in the order of their first meshes
  std::vector<std::size_t> of_mesh;  // the name of each mesh; 0 for those that are left out
};

inline MeshesByName meshes_by_name(std::span<const MeshInfo> meshes, bool surveyed_alone = false) {
  MeshesByName all;
  std::unordered_map<std::string, std::size_t> places;
  for (const MeshInfo& mesh : meshes) {
    if (surveyed_alone && mesh.role != Role::surveyed) {
      all.of_mesh.push_back(0);
      continue;
    }
    const auto [at, is_new] = places.try_emplace(mesh.name, all.names.size());
    if (is_new) all.names.push_back(mesh.name);
    all.of_mesh.push_back(at->second);
  }
  return all;
}

}  // namespace vantage
