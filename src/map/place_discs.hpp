// SPDX-License-Identifier: Apache-2.0
// Positions of the stations' discs on a map: on their true positions if there is room, else beside them.
#pragma once

#include <span>
#include <vector>

#include "map/canvas.hpp"

namespace vantage {

// Centres of discs of this radius within `inside`; none covers another or another's anchor. A disc that does not fit at
// its own anchor stands clear of it, so that the true position and a leader to it show. Deterministic; in the order of
// the anchors, of which the first has priority.
std::vector<Point> place_discs(std::span<const Point> anchors, double radius, const Rect& inside);

}  // namespace vantage
