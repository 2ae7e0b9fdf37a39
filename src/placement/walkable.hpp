// SPDX-License-Identifier: Apache-2.0
// A search area for scenes that mark none, or mark one without (u, v).
#pragma once

#include <string>
#include <vector>

#include "scene/scene_data.hpp"
#include "vantage/placement.hpp"

namespace vantage {

struct WalkableSurface {
  SearchMesh mesh;  // survey frame
  bool derived = true;
  std::string description;
  std::vector<LeftOut> left_out = {};
};

// In this order, the first that gives anything: meshes that are to be stood on; the marked search area unfolded into
// charts; upward, gentle and clear surfaces that are reached on foot, where they form a ground around the model; a
// plane laid under the model. Throws Error invalid_argument where the scene has no mesh at all, or nothing lies within
// the limits.
WalkableSurface find_walkable_surface(const SceneData& scene, const WalkableOptions& options);

// How finely surfaces are cut.
double piece_spacing(const WalkableOptions& options, const Box& bounds);
bool has_station_area(const SceneData& scene);

}  // namespace vantage
