// SPDX-License-Identifier: Apache-2.0
// A façade of 40 × 12 m behind a scaffold: three rows of windows, poles every 2.5 m, a deck every 2 m, and 15 m of open
// ground before it.
#include "generate/sites/shapes.hpp"

namespace vantage::sites {

Site facade() {
  constexpr double kLength = 40, kHeight = 12, kNear = 0.6, kFar = 1.5, kPole = 0.024;
  Site site;
  site.entry = {kLength / 2, -10, 0};
  add_box(add_part(site, "ground", kGrass, Surface::floor), block(0, kLength, -15, 0.4, -0.3, 0));
  std::vector<Box> windows;
  for (double z = 1; z < kHeight - 2; z += 4)
    for (double x = 1.5; x < kLength - 1; x += 3) windows.push_back(block(x, x + 1.1, 0, 0.12, z, z + 1.6));
  carve(add_part(site, "facade", kPlaster, Surface::wall_top), {block(0, kLength, 0, 0.4, 0, kHeight)}, windows);
  Part& poles = add_part(site, "poles", kSteel, Surface::wall_top);
  for (double x = 0.2; x < kLength; x += 2.5)
    for (const double y : {-kNear, -kFar}) add_cylinder(poles, {x, y, 0}, 2, kPole, kHeight + 1, 8);
  for (double z = 3; z < kHeight + 1; z += 2)
    for (const double y : {-kNear, -kFar}) add_cylinder(poles, {0.1, y, z}, 0, kPole, kLength - 0.2, 8);
  Part& decks = add_part(site, "decks", kWood, Surface::equipment);
  for (double z = 2; z < kHeight; z += 2) add_box(decks, block(0.1, kLength - 0.1, -kFar, -kNear, z, z + 0.05));
  site.places = {{"ground", 0, 0, kLength, -15, -kFar - 0.5, 0, true}};
  return site;
}

}  // namespace vantage::sites
