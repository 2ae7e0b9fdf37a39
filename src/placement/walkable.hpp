// SPDX-License-Identifier: Apache-2.0
// Derives a search area for scenes that mark none, or one without (u, v).
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
  std::vector<ClosedPart> not_entered = {}, entered = {};
  std::vector<Vec3> entries = {};
  bool on_plane = false;
};

// Returns the first non-empty of: meshes marked as station area; the marked search area unfolded into charts; upward,
// gentle and clear surfaces reached on foot, if they form a ground around the model; a plane laid under the model.
// Throws Error invalid_argument if the scene has no mesh at all, or nothing lies within the limits.
// `options` have been checked.
WalkableSurface find_walkable_surface(const SceneData& scene, const WalkableOptions& options);

// Throws Error invalid_argument for a setting out of bounds.
void check(const WalkableOptions& options);

// Returns the size of the pieces into which surfaces are cut.
double piece_spacing(const WalkableOptions& options, const Box& bounds);
bool has_station_area(const SceneData& scene);

}  // namespace vantage
