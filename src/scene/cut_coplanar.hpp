// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "scene/raw_scene.hpp"

namespace vantage {

struct CoplanarCut {
  std::size_t surveyed = 0, blocking = 0;  // triangles that overlapped in one plane
};

// Cuts blocking triangles back where surveyed ones lie in their plane, so that rays meet the surveyed surface. New
// vertices get interpolated attributes. A shared mesh loses the triangles that are cut at places where some are cut;
// they are stored there. `positions` are those of the scene's own triangles, in the local frame, as indexed by
// raw.triangles. Throws Error out_of_memory. REQUIRES: raw.positions is empty.
CoplanarCut cut_coplanar(RawScene& raw, std::vector<Float3>& positions, const Vec3& origin);

}  // namespace vantage
