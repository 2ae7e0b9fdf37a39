// SPDX-License-Identifier: Apache-2.0
// A search area for scenes that mark none, or mark one without (u, v).
#pragma once

#include <string>

#include "scene/scene_data.hpp"
#include "vantage/placement.hpp"

namespace vantage {

struct WalkableSurface {
  SearchMesh mesh;  // survey frame
  bool derived = true;
  std::string description;
};

// In this order, the first that gives anything: the marked search area unfolded into charts; upward, gentle and clear
// surfaces, where they form a ground around the model; a plane laid under the model. Throws Error invalid_argument
// where the scene has no mesh at all.
WalkableSurface find_walkable_surface(const SceneData& scene, const WalkableOptions& options);

}  // namespace vantage
