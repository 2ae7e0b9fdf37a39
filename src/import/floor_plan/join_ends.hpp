// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "import/floor_plan/drawing.hpp"

namespace vantage::floor_plan {

// Largest distance by which ends of hand-drawn lines may miss what they should meet. Metres.
inline constexpr double kTolerance_m = 0.05;

struct Joined {
  std::vector<Line> lines;
  std::size_t ends = 0;   // moved by half a millimetre or more
  double farthest_m = 0;  // largest movement
};

// Moves loose ends of lines to the end, else to the line, that they miss by at most kTolerance_m. Then closes the ends
// of walls that are drawn as two lines only: two loose ends side by side get a line between them.
Joined join_ends(std::vector<Line> lines);

}  // namespace vantage::floor_plan
