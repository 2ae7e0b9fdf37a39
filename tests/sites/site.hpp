// SPDX-License-Identifier: Apache-2.0
// Sites as users have them: unmarked models of whole places, with the truth about where a person can stand.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "vantage/types.hpp"

namespace vantage::test {

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
const char* to_string(Surface surface);

constexpr double kUpright_m = 1.9;
constexpr double kTouch_m = 0.05;

// A point's surface, and its place: a place's name, else the part's (a stair, a threshold).
struct Standing {
  Surface surface = Surface::outside;
  std::string place;
  int storey = 0;
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

// How a site is written, as exporters do with the same model.
struct Variant {
  bool millimetres = false;  // every length times 1000
  bool z_up = false;         // coordinates as modelled, not turned to glTF's Y up
  bool utm = false;          // 500 km east, 5400 km north, 400 m up, in the translation of the root node
  double per_metre = 1;      // another unit, unless `millimetres` is set
  bool nameless = false;     // without names
};

struct Site {
  std::string name;
  std::vector<Part> parts;
  std::vector<Place> places;  // places to visit
  Vec3 entry;                 // on the floor at the entrance
  Vec3 offset;                // of the survey frame, by variant

  // The surface under a point of the survey frame, in metres.
  Standing at(const Vec3& ground) const;
};

std::span<const char* const> site_names();  // office, house, street, plant
// Throws std::invalid_argument if there is no such site.
Site make_site(const std::string& name, const Variant& variant = {});
// Writes a GLB without roles; the same arguments give the same bytes.
void write_site(const Site& site, const Variant& variant, const std::filesystem::path& file);

Site office();
Site house();
Site street();
Site plant();

}  // namespace vantage::test
