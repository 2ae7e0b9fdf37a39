// SPDX-License-Identifier: Apache-2.0
// Selects tiles of rays that can put a point into a surveyed voxel, and how far they must be traced.
#pragma once

#include <cstdint>
#include <vector>

#include "trace/embree/station_rays.hpp"

namespace vantage {

struct SelectedTile {
  RayTile tile;
  float end = 0;  // rays need not be traced further
};

// All tiles of the pattern, to its full range.
std::vector<SelectedTile> all_tiles(const RayPattern& pattern);

// Tiles in which a surveyed brick lies as seen from `station`. Rays left out, and parts of rays beyond their end, hold
// no point that counts and no hit that hides one.
std::vector<SelectedTile> tiles_with_bricks(const StationRays& rays, const TraceStation& station);

}  // namespace vantage
