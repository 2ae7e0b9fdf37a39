// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "import/floor_plan/drawing.hpp"
#include "import/floor_plan/shapes.hpp"
#include "import/floor_plan/swings.hpp"

namespace vantage::floor_plan {

// A place in a wall that is open between its sill and its lintel.
struct Opening {
  enum Kind { passage, door, window } kind = passage;
  Shape area;
};

// Openings of walls: gaps between ends of walls, or between an end and a wall across, as far as a door or a passage is
// wide; doors by their swings; windows, and doors without a swing, by their symbols and layers.
std::vector<Opening> find_openings(const Shape& solid, const Drawing& drawing, const std::vector<Swing>& swings);

}  // namespace vantage::floor_plan
