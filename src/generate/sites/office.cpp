// SPDX-License-Identifier: Apache-2.0
// One floor of an office, 24 × 15 m: a corridor with four rooms on either side, ceiling, plenum and a flat roof with a
// parapet. The entrance is at the eastern end of the corridor.
#include "generate/sites/shapes.hpp"

namespace vantage::sites {

Site office() {
  constexpr double kX = 24, kY = 15, kClear = 2.8, kTop = 3.5, kOuter = 0.3, kInner = 0.12;
  constexpr double kSouth = 6.48, kNorth = 8.4;  // the corridor's walls begin here
  Site site;
  site.entry = {kX - 0.6, 7.5, 0};
  add_box(add_part(site, "floor_slab", kConcrete, Surface::floor), block(0, kX, 0, kY, -0.3, 0));
  add_box(add_part(site, "ceiling", kPlaster, Surface::sealed),
          block(kOuter, kX - kOuter, kOuter, kY - kOuter, kClear, kClear + 0.05));
  add_box(add_part(site, "roof_slab", kConcrete, Surface::roof),
          block(kOuter, kX - kOuter, kOuter, kY - kOuter, 3.25, kTop));
  add_block(site, "roof_unit", block(10, 12.5, 5, 6.5, kTop, kTop + 1.3), Surface::roof);

  struct Room {
    const char* name;
    double x0, x1;
  };
  const Room south[] = {
      {"office_1", 0.3, 5.94}, {"office_2", 6.06, 11.94}, {"office_3", 12.06, 17.94}, {"meeting", 18.06, 23.7}};
  const Room north[] = {
      {"kitchen", 0.3, 4.94}, {"open_office", 5.06, 14.94}, {"office_4", 15.06, 19.94}, {"store", 20.06, 23.7}};
  std::vector<Box> outer{block(0, kX, 0, kY, 0, kTop + 0.3)};
  std::vector<Box> open{block(kOuter, kX - kOuter, kOuter, kY - kOuter, 0, kTop + 0.3),
                        block(kX - kOuter, kX, 7.0, 8.0, 0, 2.1)};  // the entrance
  std::vector<Box> walls{block(kOuter, kX - kOuter, kSouth, kSouth + kInner, 0, kClear),
                         block(kOuter, kX - kOuter, kNorth, kNorth + kInner, 0, kClear)};
  std::vector<Box> doors;
  for (const bool to_the_south : {true, false})
    for (const Room& room : to_the_south ? south : north) {
      const double y0 = to_the_south ? kOuter : kNorth + kInner, y1 = to_the_south ? kSouth : kY - kOuter;
      site.places.push_back({room.name, 0, room.x0, room.x1, y0, y1, 0});
      if (room.x1 < 23) walls.push_back(block(room.x1, room.x1 + kInner, y0, y1, 0, kClear));
      const double wall = to_the_south ? kSouth : kNorth;
      doors.push_back(block(room.x0 + 0.6, room.x0 + 1.5, wall, wall + kInner, 0, 2.1));
      const double face = to_the_south ? 0 : kY - kOuter;
      for (double x = room.x0 + 0.8; x + 1.6 < room.x1; x += 2.4)
        open.push_back(block(x, x + 1.6, face, face + kOuter, 0.9, 2.1));
    }
  site.places.push_back({"corridor", 0, kOuter, kX - kOuter, kSouth + kInner, kNorth, 0});
  carve(add_part(site, "outer_walls", kPlaster, Surface::wall_top), outer, open);
  carve(add_part(site, "inner_walls", kPlaster, Surface::wall_top), walls, doors);

  int desks = 0;
  const auto desk = [&](double x, double y) {
    const std::string number = std::to_string(++desks);
    add_table(site, "desk_" + number, block(x, x + 1.6, y, y + 0.8, 0, 0.74));
    add_chair(site, "chair_" + number, x + 0.8, y - 0.35, 0);
  };
  for (const double x : {0.3, 6.06, 12.06}) desk(x + 0.9, 2.0), desk(x + 3.3, 2.0), desk(x + 3.3, 4.2);
  for (const double x : {6.4, 9.0, 11.6}) desk(x, 10.8), desk(x, 13.2);
  desk(16.5, 12.5);
  add_table(site, "meeting_table", block(19.3, 22.3, 2.6, 4.0, 0, 0.74));
  for (int i = 0; i < 4; ++i) {
    add_chair(site, "meeting_chair_" + std::to_string(2 * i + 1), 19.7 + 0.75 * i, 2.2, 0);
    add_chair(site, "meeting_chair_" + std::to_string(2 * i + 2), 19.7 + 0.75 * i, 4.6, 0);
  }
  add_block(site, "kitchen_counter", block(0.3, 3.9, 14.1, 14.7, 0, 0.9));
  add_block(site, "refrigerator", block(4.2, 4.9, 14.05, 14.7, 0, 1.9));
  add_table(site, "kitchen_table", block(1.4, 2.8, 11.2, 12.0, 0, 0.75));
  for (int i = 0; i < 5; ++i)
    add_block(site, "shelf_" + std::to_string(i + 1), block(20.1 + 0.7 * i, 20.7 + 0.7 * i, 14.2, 14.7, 0, 2.0));
  add_block(site, "shelf_6", block(23.2, 23.7, 9.5, 13.0, 0, 2.0));
  for (const double x : {0.35, 6.11, 12.11}) add_block(site, "cupboard", block(x, x + 0.45, 3.6, 5.2, 0, 1.8));
  add_block(site, "copier", block(14.0, 14.7, 6.6, 7.1, 0, 1.1));
  return site;
}

}  // namespace vantage::sites
