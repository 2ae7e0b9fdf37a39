// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vantage/scene.hpp"

namespace vantage {

// The same triangles with every mesh surveyed, each voxel as much as any other, and without what only colours or bends
// points: normals, textures, the search area. Positions and triangles are copied.
Scene all_surveyed(const Scene& scene);

}  // namespace vantage
