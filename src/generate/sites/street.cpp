// SPDX-License-Identifier: Apache-2.0
// A street of 60 × 30 m between two rows of three houses. The houses have no doors, so their floors and attics are
// sealed.
#include "generate/sites/shapes.hpp"

namespace vantage::sites {

Site street() {
  constexpr double kKerb = 0.12, kWallTop = 5.6, kWall = 0.3;
  Site site;
  site.entry = {2, 15, 0};
  std::vector<Box> plots;
  std::vector<std::pair<double, double>> corners;  // of the houses
  for (const double y : {1.5, 21.5})
    for (const double x : {4.0, 24.0, 44.0})
      corners.emplace_back(x, y), plots.push_back(block(x, x + 12, y, y + 7, -0.3, kKerb));

  add_box(add_part(site, "road", {0.06F, 0.06F, 0.06F}, Surface::floor), block(0, 60, 12, 18, -0.3, 0));
  carve(add_part(site, "pavement", kConcrete, Surface::floor),
        {block(0, 60, 10, 12, -0.3, kKerb), block(0, 60, 18, 20, -0.3, kKerb)});
  carve(add_part(site, "gardens", kGrass, Surface::floor),
        {block(0, 60, 0, 10, -0.3, kKerb), block(0, 60, 20, 30, -0.3, kKerb)}, plots);
  site.places = {{"road", 0, 0, 60, 12, 18, 0, true},
                 {"south_pavement", 0, 0, 60, 10, 12, kKerb, true},
                 {"north_pavement", 0, 0, 60, 18, 20, kKerb, true},
                 {"south_gardens", 0, 0, 60, 0, 10, kKerb, true},
                 {"north_gardens", 0, 0, 60, 20, 30, kKerb, true}};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto [x, y] = corners[i];
    const std::string house = "house_" + std::to_string(i + 1);
    const Box inner = block(x + kWall, x + 12 - kWall, y + kWall, y + 7 - kWall, 0, 0);
    add_box(add_part(site, house + "_floor", kConcrete, Surface::sealed),
            block(x, x + 12, y, y + 7, -0.3, kKerb + 0.1));
    carve(add_part(site, house + "_walls", kPlaster, Surface::wall_top),
          {block(x, x + 12, y, y + 7, kKerb + 0.1, kWallTop)},
          {block(inner.min.x, inner.max.x, inner.min.y, inner.max.y, kKerb + 0.1, kWallTop)});
    add_box(add_part(site, house + "_ceiling", kPlaster, Surface::sealed),
            block(inner.min.x, inner.max.x, inner.min.y, inner.max.y, kWallTop - 0.4, kWallTop - 0.15));
    Part tiles{house + "_roof", kTiles, Surface::roof}, gables{house + "_gables", kPlaster, Surface::wall_top};
    add_gabled_roof(tiles, gables, block(x, x + 12, y, y + 7, 0, 0), kWallTop, 40, 0.4);
    site.parts.push_back(tiles);
    site.parts.push_back(gables);
  }
  add_car(site, "car_1", 7, 12.15, 0);
  add_car(site, "car_2", 19, 16.05, 0);
  add_car(site, "car_3", 36, 12.15, 0);
  add_car(site, "van", 50, 16.05, 0);
  for (const double x : {2.0, 20.0, 40.0, 58.0}) {
    const std::string number = std::to_string(static_cast<int>(x));
    add_tree(site, "tree_s" + number, x, 10.6, kKerb);
    add_tree(site, "tree_n" + number, x, 19.4, kKerb);
  }
  add_table(site, "bench", block(29.2, 30.8, 18.3, 18.7, kKerb, kKerb + 0.45));
  return site;
}

}  // namespace vantage::sites
