// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "import/floor_plan/drawing.hpp"
#include "import/floor_plan/shapes.hpp"
#include "import/floor_plan/swings.hpp"

namespace vantage::floor_plan {

// A place in a wall that is open from its sill to its lintel.
struct Opening {
  enum Kind { passage, door, window } kind = passage;
  Shape area;
};

// Finds the openings of walls: gaps between ends of walls, or between an end and the opposite wall, of the width of a
// door or passage; doors by their swings; windows, and doors without a swing, by symbols and layers.
std::vector<Opening> find_openings(const Shape& solid, const Drawing& drawing, const std::vector<Swing>& swings);

}  // namespace vantage::floor_plan
