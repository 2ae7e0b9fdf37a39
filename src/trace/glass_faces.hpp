// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scene/scene_data.hpp"

namespace vantage {

// Returns the triangles of glass, in order, as indices into SceneData::positions.
std::vector<Triangle> glass_triangles(const SceneData& scene);

// Returns for each triangle of glass true if it belongs to a closed surface. A beam passes two faces of such a solid;
// any other triangle stands for a whole pane.
std::vector<bool> faces_of_solids(const SceneData& scene);

}  // namespace vantage
