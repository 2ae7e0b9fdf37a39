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
    constexpr double kSkin_m = 0.15;  // surfaces around a room stand for it
    for (const Room& room : scene_.rooms())
      if (patch.point.x > room.box.min.x - kSkin_m && patch.point.x < room.box.max.x + kSkin_m &&
          patch.point.y > room.box.min.y - kSkin_m && patch.point.y < room.box.max.y + kSkin_m &&
          patch.point.z > room.box.min.z - kSkin_m && patch.point.z < room.box.max.z + kSkin_m)
        return room.name;
    return scene_.meshes()[patch.mesh].name;
  }

 private:
  const Scene& scene_;
};

}  // namespace vantage
