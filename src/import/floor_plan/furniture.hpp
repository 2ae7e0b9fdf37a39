// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "import/floor_plan/drawing.hpp"
#include "import/floor_plan/rooms.hpp"
#include "import/floor_plan/shapes.hpp"

namespace vantage::floor_plan {

struct Furniture {
  std::string name;  // of its block
  Shape area;
};

// Returns the smallest rectangle around each block of furniture, clipped to the rooms.
std::vector<Furniture> find_furniture(const Drawing& drawing, const Rooms& rooms);

}  // namespace vantage::floor_plan
