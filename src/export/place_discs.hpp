// SPDX-License-Identifier: Apache-2.0
// Where the stations' discs stand on a map: on their true spots where there is room, else beside them.
#pragma once

#include <span>
#include <vector>

#include "export/canvas.hpp"

namespace vantage {

// Centres of discs of this radius within `inside`, none on another and none on another's anchor. A disc that cannot
// stand at its own anchor stands clear of it, so that the true spot and a leader to it are seen. Deterministic; in the
// order of the anchors, of which the first has its way.
std::vector<Point> place_discs(std::span<const Point> anchors, double radius, const Rect& inside);

}  // namespace vantage
