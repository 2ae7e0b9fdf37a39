// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "import/floor_plan/furniture.hpp"
#include "import/floor_plan/openings.hpp"
#include "import/floor_plan/rooms.hpp"
#include "import/floor_plan/shapes.hpp"
#include "import/floor_plan/stairs.hpp"

namespace vantage::floor_plan {

// Heights above the floor, metres.
inline constexpr double kDoorHeight_m = 2.1, kSill_m = 0.9, kTable_m = 0.75;

// Triangles of one node: (x, y, z), Z up, three points each.
struct Mesh {
  std::string name;
  bool surveyed = true;
  std::vector<std::array<double, 3>> points;
};

struct Plan {
  Shape solid;  // walls, without their openings
  std::vector<Opening> openings;
  Rooms rooms;
  std::vector<Furniture> furniture;
  std::vector<Step> steps;  // of stairs to the storey above
  // Holes in the ceiling, with sides up to the floor above, and in the floor, for stairs; null: none.
  Shape hole_above, hole_below;
  double wall_height_m = 2.7, slab_m = 0;  // `slab_m`: from the ceiling to the floor above
};

// Returns a name for each room: the one of its texts, else `room N`.
std::string room_name(const Rooms& rooms, std::size_t room);

// Returns walls, floor and ceiling of each room, the outsides of walls, and furniture. Faces are turned to the space in
// front of them.
std::vector<Mesh> meshes_of(const Plan& plan);

}  // namespace vantage::floor_plan
