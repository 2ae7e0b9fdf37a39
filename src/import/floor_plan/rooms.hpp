// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "import/floor_plan/drawing.hpp"
#include "import/floor_plan/openings.hpp"
#include "import/floor_plan/shapes.hpp"

namespace vantage::floor_plan {

struct Room {
  Shape area;
  std::string name, number;  // from the texts in it; empty: none
};

struct Rooms {
  std::vector<Room> rooms;
  double closed_m = 0;  // widest gap of the outer walls that was closed; 0: the walls close by themselves
  bool open = false;    // the walls enclose little, so that the ground is the area within their common hull
};

// Finds the rooms that walls and openings enclose. Throws Refused if there is no ground.
Rooms find_rooms(const Shape& solid, const std::vector<Opening>& openings, const std::vector<Text>& texts);

}  // namespace vantage::floor_plan
