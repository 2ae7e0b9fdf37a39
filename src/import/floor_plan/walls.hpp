// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "import/floor_plan/drawing.hpp"
#include "import/floor_plan/shapes.hpp"

namespace vantage::floor_plan {

// Distances between the two lines of a wall, and the thickness that a wall of one line gets. Metres. Nobody can stand
// in a space narrower than kThickestWall_m.
inline constexpr double kThinnestWall_m = 0.03, kThickestWall_m = 0.62, kSingleLine_m = 0.1;

// A face that lines enclose.
struct WallFace {
  double area_m2 = 0, perimeter_m = 0;
  double wide_m() const { return perimeter_m > 0 ? 2 * area_m2 / perimeter_m : 0; }  // about that of a long one
};

struct Walls {
  std::vector<WallFace> faces;      // between their lines: walls and rooms
  Shape solid;                      // area of walls and columns
  std::vector<std::string> layers;  // that they are drawn on
  bool by_name = false;             // true: found by the layers' names
  std::size_t joined_ends = 0;
  double farthest_join_m = 0;
  std::size_t filled_gaps = 0;  // between walls
  double widest_gap_m = 0;
};

// Finds the walls of a drawing in metres, by lines of Kind::wall, or of the layer that looks most like walls if there
// are none. Throws Refused if there is no such layer, or if lines cross too often.
Walls find_walls(const Drawing& drawing);

}  // namespace vantage::floor_plan
