// SPDX-License-Identifier: Apache-2.0
// Sites as users have them: unmarked models of whole places, with the truth about where a person can stand.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "generate/sites/site.hpp"
#include "vantage/types.hpp"

namespace vantage::sites {
const char* to_string(Surface surface);
}  // namespace vantage::sites

namespace vantage::test {

using sites::Part;
using sites::Place;
using sites::Surface;

constexpr double kUpright_m = 1.9;
constexpr double kTouch_m = 0.05;

// A point's surface, and its place: a place's name, else the part's (a stair, a threshold).
struct Standing {
  Surface surface = Surface::outside;
  std::string place;
  int storey = 0;
};

// Ways in which exporters write the same model.
struct Variant {
  bool millimetres = false;  // every length times 1000
  bool z_up = false;         // coordinates as modelled, not turned to glTF's Y up
  bool utm = false;          // 500 km east, 5400 km north, 400 m up, in the translation of the root node
  double per_metre = 1;      // another unit, unless `millimetres` is set
  bool nameless = false;     // without names
  unsigned wound = 0;        // not 0: the seed by which each face, of two triangles as they stand, is turned or not
};

struct KnownSite : sites::Site {
  Vec3 offset = {};  // of the survey frame, by variant

  // The surface under a point of the survey frame, in metres.
  Standing at(const Vec3& ground) const;
};

std::span<const char* const> site_names();  // office, house, street, plant
// Throws std::invalid_argument if there is no such site.
KnownSite make_site(const std::string& name, const Variant& variant = {});
// Writes a GLB without roles; the same arguments give the same bytes.
void write_site(const KnownSite& site, const Variant& variant, const std::filesystem::path& file);

}  // namespace vantage::test
