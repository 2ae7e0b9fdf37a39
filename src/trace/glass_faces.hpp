// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scene/scene_data.hpp"

namespace vantage {

// The triangles of glass, in their order, by indices into SceneData::positions.
std::vector<Triangle> glass_triangles(const SceneData& scene);

// For each triangle of glass, whether it belongs to a closed surface. A beam passes two faces of such a solid; any
// other triangle stands for a whole pane.
std::vector<bool> faces_of_solids(const SceneData& scene);

}  // namespace vantage
