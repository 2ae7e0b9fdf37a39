// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "import/floor_plan/drawing.hpp"

namespace vantage::floor_plan {

// A door, given by the arc that its leaf's edge draws. The leaf is hinged at `hinge` and closes at one of the two ends.
// Metres.
struct Swing {
  Point hinge, ends[2];
  double width = 0;
  int layer = 0;  // in Drawing::layers
};

// Returns true if an arc turns as far as a door does. Its radius may be in any unit.
bool may_swing(const Arc& arc);

// Takes the swings out of a drawing in metres, with their arcs and the lines that are leaves.
std::vector<Swing> take_swings(Drawing& drawing);

}  // namespace vantage::floor_plan
