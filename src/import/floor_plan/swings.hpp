// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "import/floor_plan/drawing.hpp"

namespace vantage::floor_plan {

// A door by the arc that its leaf's edge draws: the leaf is hinged at `hinge`, and one of the two ends is where it
// closes. Metres.
struct Swing {
  Point hinge, ends[2];
  double width = 0;
  int layer = 0;  // in Drawing::layers
};

// Whether an arc turns as far as a door does. Its radius may be of any unit.
bool may_swing(const Arc& arc);

// Swings of a drawing in metres. Takes their arcs, and the lines that are leaves, out of it.
std::vector<Swing> take_swings(Drawing& drawing);

}  // namespace vantage::floor_plan
