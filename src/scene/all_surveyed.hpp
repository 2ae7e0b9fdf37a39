// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vantage/scene.hpp"

namespace vantage {

// The same triangles with every mesh surveyed and all voxels weighing alike. Glass stops rays: what is seen through a
// pane, bent and weakened, holds no scan. With `through_glass` it does not. Data that only affects colours or
// directions of points is left out: normals, textures, the search area. Positions and triangles are copied.
Scene all_surveyed(const Scene& scene, bool through_glass = false);

}  // namespace vantage
