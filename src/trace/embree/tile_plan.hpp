// SPDX-License-Identifier: Apache-2.0
// Which tiles of rays can put a point into a surveyed voxel, and how far they must be traced for it.
#pragma once

#include <cstdint>
#include <vector>

#include "trace/embree/station_rays.hpp"

namespace vantage {

struct PlannedTile {
  RayTile tile;
  float end = 0;  // rays need not be traced further
};

// All tiles of the pattern, to its full range.
std::vector<PlannedTile> all_tiles(const RayPattern& pattern);

// The tiles in which a surveyed brick lies as seen from `station`. A ray that is left out, or the part of one beyond
// its end, holds no point that counts, and no hit that hides one.
std::vector<PlannedTile> tiles_with_bricks(const StationRays& rays, const TraceStation& station);

}  // namespace vantage
