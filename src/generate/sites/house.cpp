// SPDX-License-Identifier: Apache-2.0
// A house of two storeys, 10 × 8 m, in a garden of 26 × 22 m: a hall with a stair of 17 rises of 0.18 m, two rooms
// below and three above, and a gabled roof over an inaccessible attic. The front door stands open.
#include "generate/sites/shapes.hpp"

namespace vantage::sites {

Site house() {
  constexpr double kX = 10, kY = 8, kOuter = 0.3, kInner = 0.12;
  constexpr double kGround = 0.15, kRise = 0.18, kGoing = 0.27;
  constexpr int kRises = 17;
  constexpr double kUpper = kGround + kRises * kRise, kCeiling = kUpper + 2.6, kWallTop = kCeiling + 0.25;
  constexpr double kWest = 3.78, kEast = 6.1;  // the hall's walls begin here
  constexpr double kStair0 = kWest + kInner, kStair1 = kStair0 + 0.95, kFoot = 2.0,
                   kHead = kFoot + (kRises - 1) * kGoing;
  Site site;
  site.entry = {5.4, -2, 0};

  carve(add_part(site, "garden", kGrass, Surface::floor), {block(-8, 18, -8, 14, -0.4, 0)},
        {block(0, kX, 0, kY, -0.4, 0)});
  add_box(add_part(site, "ground_slab", kConcrete, Surface::floor), block(0, kX, 0, kY, -0.4, kGround));
  carve(add_part(site, "upper_slab", kWood, Surface::floor),
        {block(kOuter, kX - kOuter, kOuter, kY - kOuter, kUpper - 0.3, kUpper)},
        {block(kStair0, kStair1, kFoot, kHead, kUpper - 0.3, kUpper)});
  add_box(add_part(site, "upper_ceiling", kPlaster, Surface::sealed),
          block(kOuter, kX - kOuter, kOuter, kY - kOuter, kCeiling, kCeiling + 0.2));

  std::vector<Box> open{block(kOuter, kX - kOuter, kOuter, kY - kOuter, kGround, kWallTop),
                        block(4.9, 5.9, 0, kOuter, kGround, kGround + 2.1)};
  for (const double floor : {kGround, kUpper})
    for (const double face : {0.0, kY - kOuter})
      for (const double x : {1.3, 7.4})
        open.push_back(block(x, x + 1.2, face, face + kOuter, floor + 0.9, floor + 2.1));
  for (const double face : {0.0, kX - kOuter})
    open.push_back(block(face, face + kOuter, 5.0, 6.4, kUpper + 0.9, kUpper + 2.1));
  carve(add_part(site, "outer_walls", kPlaster, Surface::wall_top), {block(0, kX, 0, kY, kGround, kWallTop)}, open);

  std::vector<Box> walls, doors;
  for (const double floor : {kGround, kUpper}) {
    const double top = floor == kGround ? kUpper - 0.3 : kCeiling;
    for (const double x : {kWest, kEast}) walls.push_back(block(x, x + kInner, kOuter, kY - kOuter, floor, top));
    walls.push_back(block(kEast + kInner, kX - kOuter, 4.0, 4.0 + kInner, floor, top));
    doors.push_back(block(kWest, kWest + kInner, 0.6, 1.5, floor, floor + 2.1));
    doors.push_back(block(kEast, kEast + kInner, 1.2, 2.1, floor, floor + 2.1));
    doors.push_back(block(kEast, kEast + kInner, 5.4, 6.3, floor, floor + 2.1));
  }
  carve(add_part(site, "inner_walls", kPlaster, Surface::wall_top), walls, doors);
  add_flight(add_part(site, "stair", kWood, Surface::floor), kStair0, kStair1, kFoot, kGround, kRises, kRise, kGoing);
  carve(add_part(site, "balustrade", kWood, Surface::wall_top),
        {block(kStair1, kStair1 + 0.05, kFoot - 0.05, kHead, kUpper, kUpper + 0.95),
         block(kStair0, kStair1, kFoot - 0.05, kFoot, kUpper, kUpper + 0.95)});
  Part roof{"roof", kTiles, Surface::roof}, gables{"gables", kPlaster, Surface::wall_top};
  add_gabled_roof(roof, gables, block(0, kX, 0, kY, 0, 0), kWallTop, 38, 0.4);
  site.parts.push_back(roof);
  site.parts.push_back(gables);

  const auto room = [&](const char* name, int storey, double x0, double x1, double y0, double y1) {
    site.places.push_back({name, storey, x0, x1, y0, y1, storey == 0 ? kGround : kUpper});
  };
  for (const int storey : {0, 1}) {
    room(storey ? "bedroom_1" : "living", storey, kOuter, kWest, kOuter, kY - kOuter);
    room(storey ? "landing" : "hall", storey, kStair0, kEast, kOuter, kY - kOuter);
    room(storey ? "bath" : "kitchen", storey, kEast + kInner, kX - kOuter, kOuter, 4.0);
    room(storey ? "bedroom_2" : "dining", storey, kEast + kInner, kX - kOuter, 4.0 + kInner, kY - kOuter);
  }
  site.places.push_back({.name = "garden", .x0 = -8, .x1 = 18, .y0 = -8, .y1 = 14, .outdoors = true});

  add_block(site, "sofa", block(0.4, 1.3, 3.0, 5.2, kGround, kGround + 0.45));
  add_table(site, "coffee_table", block(1.8, 2.4, 3.6, 4.6, kGround, kGround + 0.42));
  add_block(site, "bookcase", block(0.6, 2.6, 7.4, 7.7, kGround, kGround + 2.1));
  add_block(site, "kitchen_counter", block(9.1, 9.7, 0.3, 3.6, kGround, kGround + 0.9));
  add_table(site, "dining_table", block(7.4, 8.9, 5.4, 6.4, kGround, kGround + 0.75));
  for (int i = 0; i < 2; ++i) {
    add_chair(site, "dining_chair_" + std::to_string(2 * i + 1), 7.8 + 0.7 * i, 5.1, kGround);
    add_chair(site, "dining_chair_" + std::to_string(2 * i + 2), 7.8 + 0.7 * i, 6.8, kGround);
  }
  add_block(site, "bed_1", block(0.4, 2.4, 3.4, 5.2, kUpper, kUpper + 0.5));
  add_block(site, "wardrobe_1", block(0.4, 2.4, 7.1, 7.7, kUpper, kUpper + 2.1));
  add_block(site, "bed_2", block(7.8, 9.6, 5.6, 7.6, kUpper, kUpper + 0.5));
  add_block(site, "bathtub", block(8.9, 9.7, 0.5, 2.3, kUpper, kUpper + 0.55));
  add_block(site, "washbasin", block(6.9, 7.5, 0.3, 0.8, kUpper, kUpper + 0.85));
  add_table(site, "garden_table", block(13.0, 14.6, -3.0, -2.1, 0, 0.74));
  add_tree(site, "apple_tree", -4.5, 10, 0);
  return site;
}

}  // namespace vantage::sites
