// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vantage/scene.hpp"

namespace vantage {

// Returns the same triangles with every mesh surveyed and all voxels of equal weight. Glass stops rays, since a pane
// bends and weakens rays; with `through_glass` it does not. Data that affect only colours or directions of points are
// left out: normals, textures, the search area. Positions and triangles are copied.
Scene all_surveyed(const Scene& scene, bool through_glass = false);

}  // namespace vantage
