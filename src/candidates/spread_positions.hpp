// SPDX-License-Identifier: Apache-2.0
// Allowed positions spread evenly over the ground.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "site/placement_oracle.hpp"

namespace vantage {

struct SpreadPositions {
  std::vector<PlacedStation> stations;  // all ok; the first n are spread evenly for every n
  // For each n, the largest distance from a tried allowed position to the nearest of the first n; spacing_m[0] is for
  // the first alone.
  std::vector<double> spacing_m;
  std::vector<PlacedStation> others = {};  // the allowed positions that were tried beside these
};

// Area of the ground, all triangles together.
double ground_area_m2(const SearchMesh& mesh);

// At most `most` positions, out of a pool of several times as many that fills the ground evenly by area. Uses no random
// numbers; the pool depends on `most`. Fewer if the pool has no more allowed positions. One at a drop gives way to the
// nearest that is not, if one is a step or two away.
SpreadPositions spread_positions(const PlacementOracle& site, const SearchMesh& mesh, double height_m,
                                 std::size_t most);

// Returns those of `others` that see none of `stations` within `reach_m`, nor one returned before: ground behind walls
// that are nearer than the next station.
std::vector<PlacedStation> unseen_positions(const PlacementOracle& site, std::span<const PlacedStation> stations,
                                            std::span<const PlacedStation> others, double reach_m);

}  // namespace vantage
