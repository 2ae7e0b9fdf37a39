// SPDX-License-Identifier: Apache-2.0
// Selects tiles of rays that can put a point into a surveyed voxel, and how far they must be traced.
#pragma once

#include <cstdint>
#include <vector>

#include "trace/embree/station_rays.hpp"

namespace vantage {

// Distances to which the rays of each tile must be traced; 0: not at all.
struct TileEnds {
  std::uint32_t tall = 0, wide = 0;  // tiles
  std::vector<float> end;            // [row of tiles][column of tiles]
  float of(std::uint32_t a, std::uint32_t b) const { return end[std::size_t{a} * wide + b]; }
};

// Returns all tiles of the pattern, to its full range.
TileEnds all_tiles(const RayPattern& pattern);

// Returns the tiles in which a surveyed brick lies as seen from `station`. Rays left out, and parts of rays beyond
// their end, have no point that counts and no hit that hides one.
TileEnds tiles_with_bricks(const StationRays& rays, const TraceStation& station);

// Returns the rays of tile (a, b).
RayTile tile_at(const RayPattern& pattern, std::uint32_t a, std::uint32_t b);

struct SelectedTile {
  RayTile tile;
  float end = 0;  // rays need not be traced further
};

// Returns the tiles that must be traced.
std::vector<SelectedTile> selected(const TileEnds& ends, const RayPattern& pattern);

}  // namespace vantage
