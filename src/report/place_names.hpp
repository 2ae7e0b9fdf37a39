// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "vantage/scene.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

// The room that holds a point, or the mesh that it is of. Borrows the scene.
class PlaceNames {
 public:
  explicit PlaceNames(const Scene& scene) : scene_(scene) {}
  const std::string& of(const VoxelPatch& patch) const {
    const auto room = room_at(scene_.rooms(), patch.point);
    return room ? scene_.rooms()[*room].name : scene_.meshes()[patch.mesh].name;
  }

 private:
  const Scene& scene_;
};

}  // namespace vantage
