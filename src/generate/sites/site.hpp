// SPDX-License-Identifier: Apache-2.0
// Whole places as users model them, unmarked, with the truth about where a person can stand.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "vantage/types.hpp"

namespace vantage::sites {

// The surface under a point, for a person who places a tripod.
enum class Surface {
  floor,      // reached on foot from the entry, with room to stand upright
  covered,    // a reached floor with less than `kUpright_m` above it: under a table or a stair
  furniture,  // on a table, a bed, a chair, a shelf
  equipment,  // on a tank, a pipe, a pump
  car,
  tree,
  roof,
  wall_top,  // on a wall, a parapet, a railing
  sealed,    // an inaccessible floor: an attic, a house without a door
  inside,    // inside a solid
  air,       // nothing within `kTouch_m` above or below
  outside,   // off the site: nothing above or below
};

// A room or a piece of open ground: a rectangle of floor.
struct Place {
  std::string name;
  int storey = 0;
  double x0 = 0, x1 = 0, y0 = 0, y1 = 0, z = 0;  // z: of the floor
  bool outdoors = false;
};

// One node: closed shells, Z up, metres. `top`: kind of its upper sides.
struct Part {
  std::string name;
  std::array<float, 3> colour{0.8F, 0.8F, 0.8F};  // linear
  Surface top = Surface::floor;
  std::vector<Vec3> positions = {};
  std::vector<std::array<std::uint32_t, 3>> triangles = {};
};

struct Site {
  std::string name;
  std::vector<Part> parts;
  std::vector<Place> places;  // places to visit
  Vec3 entry;                 // on the floor at the entrance
};

Site office();
Site house();
Site street();
Site plant();
Site tunnel();
Site corridor();
Site facade();

}  // namespace vantage::sites
