// SPDX-License-Identifier: Apache-2.0
// Unfolds pieces of walkable surface into (u, v): connected charts without overlap in plan view, each in its own
// rectangle.
#pragma once

#include <cstdint>
#include <vector>

#include "placement/surface_pieces.hpp"
#include "vantage/placement.hpp"

namespace vantage {

// Pieces without overlap in plan view.
struct GroundChart {
  std::vector<std::uint32_t> pieces;
  double area = 0;       // true
  double plan_area = 0;  // seen from above
  double mean_z = 0;     // over the plan area
};

// Returns connected components (by vertices at the same place, to `weld_m`). Components that overlap themselves in plan
// view are split; repeated pieces are left out. Largest first.
std::vector<GroundChart> make_charts(const SurfacePieces& pieces, double weld_m);

// Returns true if a disc of this radius, seen from above, fits somewhere in the chart. Tests the middles of pieces and
// of their edges.
bool holds_disc(const SurfacePieces& pieces, const GroundChart& chart, double radius_m);

// Lays the charts side by side. Each chart is turned to its smallest rectangle and scaled so that its (u, v) area is in
// proportion to its true area; all share one scale. v spans [0, 1], u starts at 0. Positions are moved by `origin`.
SearchMesh unfold(const SurfacePieces& pieces, const std::vector<GroundChart>& charts, const Vec3& origin);

}  // namespace vantage
