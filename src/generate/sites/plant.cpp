// SPDX-License-Identifier: Apache-2.0
// A small process plant on plain ground, 30 × 20 m: tanks, a pipe rack, pumps, and a platform with a stair.
#include "generate/sites/shapes.hpp"

namespace vantage::sites {

Site plant() {
  constexpr double kRise = 0.18, kGoing = 0.28, kDeck = 14 * kRise;
  Site site;
  site.entry = {1, 1, 0};
  add_box(add_part(site, "ground", kConcrete, Surface::floor), block(0, 30, 0, 20, -0.2, 0));
  site.places = {{.name = "ground", .x0 = 0, .x1 = 30, .y0 = 0, .y1 = 20, .outdoors = true},
                 {"platform", 1, 10, 17, 14, 18.5, kDeck, true}};

  for (int i = 0; i < 3; ++i) {
    const double x = 4.0 + 4.0 * i;
    const std::string tank = "tank_" + std::to_string(i + 1);
    add_cylinder(add_part(site, tank, kSteel, Surface::equipment), {x, 4.5, 0}, 2, 1.5, 4.0, 24);
    add_cylinder(add_part(site, tank + "_outlet", kSteel, Surface::equipment), {x, 5.9, 0.4}, 1, 0.1, 2.2, 12);
  }
  add_cylinder(add_part(site, "vessel", kSteel, Surface::equipment), {20, 4.5, 1.6}, 0, 1.0, 5.0, 24);
  carve(add_part(site, "vessel_saddles", kConcrete, Surface::equipment),
        {block(20.8, 21.2, 3.9, 5.1, 0, 0.9), block(23.8, 24.2, 3.9, 5.1, 0, 0.9)});
  for (int i = 0; i < 3; ++i) {
    const std::string pump = "pump_" + std::to_string(i + 1);
    const double x = 4.0 + 4.0 * i;
    carve(add_part(site, pump, kPaint, Surface::equipment),
          {block(x - 0.3, x + 0.3, 8.0, 9.2, 0, 0.3), block(x - 0.2, x + 0.2, 8.1, 9.1, 0.3, 0.7)});
    add_cylinder(add_part(site, pump + "_riser", kSteel, Surface::equipment), {x, 8.5, 0.69}, 2, 0.08, 2.6, 12);
  }

  std::vector<Box> rack;
  for (const double x : {2.0, 9.9, 17.8, 25.7}) {
    for (const double y : {9.8, 11.7}) rack.push_back(block(x, x + 0.2, y, y + 0.2, 0, 3.1));
    rack.push_back(block(x, x + 0.2, 8.4, 11.9, 2.9, 3.1));
  }
  carve(add_part(site, "pipe_rack", kSteel, Surface::equipment), rack);
  for (int i = 0; i < 5; ++i)
    add_cylinder(add_part(site, "pipe_" + std::to_string(i + 1), kSteel, Surface::equipment),
                 {1.0, 8.5 + 0.7 * i, 3.25}, 0, 0.15, 27, 12);

  // the stair arrives beside the deck's eastern edge
  constexpr double kX0 = 10, kX1 = 17, kX2 = 17.9, kY0 = 14, kY1 = 18.5, kFoot = 12.6, kHead = kFoot + 13 * kGoing;
  carve(add_part(site, "platform_deck", kSteel, Surface::floor),
        {block(kX0, kX1, kY0, kY1, kDeck - 0.1, kDeck), block(kX1, kX2, kHead, kY1, kDeck - 0.1, kDeck)});
  std::vector<Box> columns, rails;
  for (const double x : {kX0, kX1 - 0.2})
    for (const double y : {kY0, kY1 - 0.2}) columns.push_back(block(x, x + 0.2, y, y + 0.2, 0, kDeck - 0.1));
  carve(add_part(site, "platform_columns", kSteel, Surface::equipment), columns);
  add_flight(add_part(site, "platform_stair", kSteel, Surface::floor), kX1, kX2, kFoot, 0, 14, kRise, kGoing);
  for (const double up : {0.5, 1.05}) {
    const double low = kDeck + up, high = low + 0.05, wide = 0.05;
    rails.push_back(block(kX0, kX1, kY0, kY0 + wide, low, high));
    rails.push_back(block(kX0, kX0 + wide, kY0, kY1, low, high));
    rails.push_back(block(kX0, kX2, kY1 - wide, kY1, low, high));
    rails.push_back(block(kX2 - wide, kX2, kHead, kY1, low, high));
    rails.push_back(block(kX1 - wide, kX1, kY0, kHead, low, high));
  }
  for (double x = kX0; x < kX1 - 1; x += 1.4)
    for (const double y : {kY0, kY1 - 0.05}) rails.push_back(block(x, x + 0.05, y, y + 0.05, kDeck, kDeck + 1.05));
  carve(add_part(site, "platform_railing", kSteel, Surface::wall_top), rails);
  add_block(site, "control_cabinet", block(10.3, 11.1, 17.6, 18.3, kDeck, kDeck + 1.8), Surface::equipment);
  return site;
}

}  // namespace vantage::sites
