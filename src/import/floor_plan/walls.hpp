// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "import/floor_plan/drawing.hpp"
#include "import/floor_plan/shapes.hpp"

namespace vantage::floor_plan {

// Distances between the two lines of a wall, and the thickness that a wall of one line gets. Metres. Nobody stands in
// what is narrower than kThickestWall_m.
inline constexpr double kThinnestWall_m = 0.03, kThickestWall_m = 0.62, kSingleLine_m = 0.1;

// A face between lines.
struct WallFace {
  double area_m2 = 0, perimeter_m = 0;
  double wide_m() const { return perimeter_m > 0 ? 2 * area_m2 / perimeter_m : 0; }  // about that of a long one
};

struct Walls {
  std::vector<WallFace> faces;      // between their lines: walls and rooms
  Shape solid;                      // what walls and columns cover
  std::vector<std::string> layers;  // that they are drawn on
  bool by_name = false;             // whether names tell these
  std::size_t joined_ends = 0;
  double farthest_join_m = 0;
  std::size_t filled_gaps = 0;  // between walls
  double widest_gap_m = 0;
};

// Walls of a drawing in metres, by lines of Kind::wall, or of the layers that enclose most rooms if there are none.
// Throws Refused if no line encloses anything.
Walls find_walls(const Drawing& drawing);

}  // namespace vantage::floor_plan
