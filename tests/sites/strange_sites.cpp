// SPDX-License-Identifier: Apache-2.0
#include "sites/strange_sites.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "generate/sites/shapes.hpp"

namespace vantage::test {
namespace {

using sites::add_box;
using sites::add_part;
using sites::block;
using sites::carve;

void add_quad(Part& part, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto first = static_cast<std::uint32_t>(part.positions.size());
  part.positions.insert(part.positions.end(), {a, b, c, d});
  part.triangles.push_back({first, first + 1, first + 2}), part.triangles.push_back({first, first + 2, first + 3});
}

Place place(const char* name, double x0, double x1, double y0, double y1, double z, bool outdoors = false) {
  return {.name = name, .x0 = x0, .x1 = x1, .y0 = y0, .y1 = y1, .z = z, .outdoors = outdoors};
}

void add_leaf(RandomSite& made, const std::string& name, const Box& box) {
  made.leaves.push_back({.name = name, .colour = sites::kWood});
  add_box(made.leaves.back(), box);
}

// A hut of 3 x 2.6 m with an open doorway. Such small buildings tell the unit, and which way is up.
void add_hut(RandomSite& made, const Draws& draw, double x, double y, double z) {
  carve(add_part(made.site, draw.name("wall"), sites::kPlaster, Surface::wall_top),
        {block(x, x + 3, y, y + 0.2, z, z + 2.4), block(x, x + 3, y + 2.4, y + 2.6, z, z + 2.4),
         block(x, x + 0.2, y, y + 2.6, z, z + 2.4), block(x + 2.8, x + 3, y, y + 2.6, z, z + 2.4)},
        {block(x + 1, x + 1.95, y, y + 0.2, z, z + 2.05)});
  add_box(add_part(made.site, draw.name("roof"), sites::kTiles, Surface::roof),
          block(x - 0.2, x + 3.2, y - 0.2, y + 2.8, z + 2.4, z + 2.6));
}

// Two plateaus of sheets above a river, a road over it between railings, and a house that is a mere block.
void terrain(RandomSite& made, const Draws& draw) {
  made.named = true;  // nothing but its name tells water from a floor
  const double z = draw.uniform(4, 9), y1 = draw.uniform(20, 40), half = draw.uniform(6, 9),
               wide = draw.uniform(20, 35);
  const double edge = half + z / std::tan(draw.uniform(0.9, 1.1));  // 50° to 63°
  Part& ground = add_part(made.site, draw.name("terrain"), sites::kGrass, Surface::floor);
  add_quad(ground, {-edge - wide, 0, z}, {-edge, 0, z}, {-edge, y1, z}, {-edge - wide, y1, z});
  add_quad(ground, {edge, 0, z}, {edge + wide, 0, z}, {edge + wide, y1, z}, {edge, y1, z});
  Part& banks = add_part(made.site, draw.name("bank"), sites::kGrass, Surface::roof);
  add_quad(banks, {-edge, 0, z}, {-half, 0, 0}, {-half, y1, 0}, {-edge, y1, z});
  add_quad(banks, {half, 0, 0}, {edge, 0, z}, {edge, y1, z}, {half, y1, 0});
  Part& water = add_part(made.site, draw.name("water"), sites::kPaint, Surface::equipment);
  add_quad(water, {-half, 0, 0.1}, {half, 0, 0.1}, {half, y1, 0.1}, {-half, y1, 0.1});
  const double road = y1 / 2, top = z + 0.5;
  add_box(add_part(made.site, draw.name("road"), sites::kConcrete, Surface::floor),
          block(-edge - wide, edge + wide, road - 3, road + 3, z - 0.4, top));
  Part& rails = add_part(made.site, draw.name("railing"), sites::kSteel, Surface::wall_top);
  for (const double y : {road - 3, road + 2.9})
    add_box(rails, block(-edge - wide, edge + wide, y, y + 0.1, top, top + 1));
  add_box(add_part(made.site, draw.name("house"), sites::kPlaster, Surface::roof),
          block(edge + 6, edge + 13, 1, road - 5, z - 1, z + 6));
  add_hut(made, draw, -edge - wide + 2, 2, z);
  made.site.places = {place("left", -edge - wide, -edge, 0, road - 3, z, true),
                      place("road", -edge - wide, edge + wide, road - 3, road + 3, top, true),
                      place("right", edge, edge + wide, road + 3, y1, z, true)};
  made.told = "terrain on both sides of a river";
}

// A yard behind a wall, with a gate of two leaves to the street.
void yard(RandomSite& made, const Draws& draw) {
  const double x1 = draw.uniform(12, 24), y1 = draw.uniform(10, 18), thick = draw.uniform(0.3, 0.6);
  const double wide = draw.uniform(1.9, 2.9), high = draw.uniform(2.2, 2.8), from = draw.uniform(2, x1 - wide - 2);
  carve(add_part(made.site, draw.name("floor"), sites::kConcrete, Surface::floor),
        {block(-4, x1 + 4, -7, y1 + 1, -0.3, 0)});
  carve(add_part(made.site, draw.name("wall"), sites::kPlaster, Surface::wall_top),
        {block(0, x1, 0, thick, 0, 3.4), block(0, x1, y1 - thick, y1, 0, 3.4), block(0, thick, 0, y1, 0, 3.4),
         block(x1 - thick, x1, 0, y1, 0, 3.4)},
        {block(from, from + wide, 0, thick, 0, high)});
  const double middle = from + wide / 2, y = thick / 2;
  add_leaf(made, draw.name("leaf"), block(from + 0.01, middle - 0.01, y - 0.04, y + 0.04, 0.01, high - 0.02));
  add_leaf(made, draw.name("leaf"), block(middle + 0.01, from + wide - 0.01, y - 0.04, y + 0.04, 0.01, high - 0.02));
  made.site.places = {place("street", -4, x1 + 4, -7, 0, 0, true),
                      place("yard", thick, x1 - thick, thick, y1 - thick, 0, true)};
  made.told = "yard behind a gate of two leaves";
}

// A shop behind a front of glass, whose sliding door is closed.
void shop(RandomSite& made, const Draws& draw) {
  const double x1 = draw.uniform(9, 18), y1 = draw.uniform(8, 14), high = draw.uniform(2.8, 3.2), t = 0.15;
  carve(add_part(made.site, draw.name("floor"), sites::kConcrete, Surface::floor),
        {block(-t, x1 + t, -4, y1 + t, -0.3, 0)});
  add_box(add_part(made.site, draw.name("ceiling"), sites::kPlaster, Surface::roof),
          block(-t, x1 + t, -4, y1 + t, high, high + 0.1));
  carve(add_part(made.site, draw.name("wall"), sites::kPlaster, Surface::wall_top),
        {block(-t, 0, 0, y1, 0, high), block(x1, x1 + t, 0, y1, 0, high), block(-t, x1 + t, y1, y1 + t, 0, high)});
  Part& frame = add_part(made.site, draw.name("frame"), sites::kSteel, Surface::wall_top);
  const double a = x1 / 2 - 1.4, b = x1 / 2 + 1.4;
  for (const double x : {0.03, a, b, x1 - 0.03}) add_box(frame, block(x - 0.03, x + 0.03, -0.05, 0.05, 0, high));
  add_box(frame, block(a, b, -0.1, 0.1, 2.3, 2.55));
  for (const auto& [from, to] : {std::array{0.06, a - 0.03}, {b + 0.03, x1 - 0.06}})
    add_box(add_part(made.site, draw.name("pane"), sites::kSteel, Surface::wall_top),
            block(from, to, -0.006, 0.006, 0.02, high));
  add_box(add_part(made.site, draw.name("pane"), sites::kSteel, Surface::wall_top),
          block(a + 0.03, b - 0.03, -0.006, 0.006, 2.55, high));
  add_leaf(made, "SLD-" + draw.name("leaf"), block(a + 0.03, x1 / 2, 0.02, 0.04, 0.01, 2.3));
  add_leaf(made, "SLD-" + draw.name("leaf"), block(x1 / 2, b - 0.03, 0.02, 0.04, 0.01, 2.3));
  for (double x = 2; x + 2 < x1; x += 2.4)
    add_box(add_part(made.site, draw.name("shelf"), sites::kSteel, Surface::furniture),
            block(x, x + 0.6, 3, y1 - 2, 0, 1.6));
  made.site.places = {place("passage", -t, x1 + t, -4, 0, 0), place("shop", 0, x1, 0, y1, 0)};
  made.told = "shop behind a sliding door of glass";
}

// A platform of bars that a flight of steps leads to.
void platform(RandomSite& made, const Draws& draw) {
  const double x1 = draw.uniform(6, 12), y1 = draw.uniform(4, 8), apart = draw.uniform(0.03, 0.04);
  const int rises = 4 + static_cast<int>(draw.uniform(0, 4));
  const double z = 0.19 * rises;
  add_box(add_part(made.site, draw.name("floor"), sites::kConcrete, Surface::floor),
          block(-8, x1 + 4, -5, y1 + 4, -0.3, 0));
  sites::add_flight(add_part(made.site, draw.name("stair"), sites::kSteel, Surface::floor), 1, 2.4, -0.26 * (rises - 1),
                    0, rises, 0.19, 0.26);
  Part& whole = add_part(made.site, draw.name("grating"), sites::kSteel, Surface::floor);
  add_box(whole, block(0, x1, 0, y1, z - 0.04, z));
  Part bars{.name = whole.name, .colour = whole.colour};
  for (double y = 0; y + 0.005 <= y1; y += apart) add_box(bars, block(0, x1, y, y + 0.005, z - 0.04, z));
  for (double x = 0; x <= x1; x += 0.5) add_box(bars, block(x, x + 0.006, 0, y1, z - 0.03, z - 0.005));
  made.drawn[whole.name] = std::move(bars);
  add_hut(made, draw, -7, 0, 0);
  made.site.places = {place("ground", -8, -0.5, -5, y1 + 4, 0, true), place("platform", 0, x1, 0, y1, z, true)};
  made.told = "platform of gratings";
}

// A barn with a loft: a ladder leads through a hatch.
void loft(RandomSite& made, const Draws& draw) {
  const double x1 = draw.uniform(8, 14), y1 = draw.uniform(6, 9), storey = draw.uniform(2.7, 3.3), t = 0.25;
  carve(add_part(made.site, draw.name("floor"), sites::kConcrete, Surface::floor),
        {block(-6, x1 + 6, -6, y1 + 6, -0.3, 0), block(0, x1, 0, y1, storey - 0.2, storey),
         block(0, x1, 0, y1, 2 * storey, 2 * storey + 0.2)},
        {block(x1 - 3, x1 - 1.6, y1 - 2.4, y1 - 1.2, storey - 0.2, storey)});
  carve(add_part(made.site, draw.name("wall"), sites::kPlaster, Surface::wall_top),
        {block(0, x1, 0, t, 0, 2 * storey), block(0, x1, y1 - t, y1, 0, 2 * storey), block(0, t, 0, y1, 0, 2 * storey),
         block(x1 - t, x1, 0, y1, 0, 2 * storey)},
        {block(1, 2.2, 0, t, 0, 2.1), block(3, 4.2, 0, t, storey + 0.9, storey + 2)});
  Part& ladder = add_part(made.site, draw.name("ladder"), sites::kWood, Surface::furniture);
  const double x = x1 - 1.75, y = y1 - 2.1;
  for (const double side : {y - 0.04, y + 0.5}) add_box(ladder, block(x, x + 0.04, side, side + 0.04, 0, storey + 0.9));
  for (double z = 0.28; z < storey + 0.05; z += 0.28) add_box(ladder, block(x, x + 0.04, y, y + 0.5, z - 0.03, z));
  made.site.places = {place("barn", t, x1 - t, t, y1 - t, 0), place("loft", t, x1 - t, t, y1 - t, storey)};
  made.told = "barn with a ladder to its loft";
}

// Rooms whose walls, floor and ceiling are single sheets.
void sheets(RandomSite& made, const Draws& draw) {
  const double x1 = draw.uniform(4, 7), x2 = x1 + draw.uniform(4, 7), y1 = draw.uniform(4, 7), h = draw.uniform(2.5, 3);
  Part& floor = add_part(made.site, draw.name("floor"), sites::kConcrete, Surface::floor);
  add_quad(floor, {0, 0, 0}, {x2, 0, 0}, {x2, y1, 0}, {0, y1, 0});
  Part& shell = add_part(made.site, draw.name("wall"), sites::kPlaster, Surface::roof);
  add_quad(shell, {0, 0, h}, {0, y1, h}, {x2, y1, h}, {x2, 0, h});
  add_quad(shell, {0, 0, 0}, {0, 0, h}, {x2, 0, h}, {x2, 0, 0});
  add_quad(shell, {0, y1, 0}, {x2, y1, 0}, {x2, y1, h}, {0, y1, h});
  add_quad(shell, {x2, 0, 0}, {x2, 0, h}, {x2, y1, h}, {x2, y1, 0});
  for (const double x : {0.0, x1}) {  // a doorway 1 m wide in each
    add_quad(shell, {x, 0, 0}, {x, 1.5, 0}, {x, 1.5, h}, {x, 0, h});
    add_quad(shell, {x, 2.5, 0}, {x, y1, 0}, {x, y1, h}, {x, 2.5, h});
    add_quad(shell, {x, 1.5, 2.1}, {x, 2.5, 2.1}, {x, 2.5, h}, {x, 1.5, h});
  }
  made.site.places = {place("first", 0, x1, 0, y1, 0), place("second", x1, x2, 0, y1, 0)};
  made.told = "two rooms of sheets";
}

// A yard over a cellar with a barrel vault, and an open stair between walls that leads down to its doorway.
void vault(RandomSite& made, const Draws& draw) {
  constexpr int kFacets = 12, kRises = 18;
  constexpr double kGoing = 0.28, kWide = 1.4, t = 0.4;
  const double x1 = draw.uniform(5, 7), y1 = draw.uniform(9, 16), depth = draw.uniform(3.2, 3.5), spring = 1.5;
  const double rise = draw.uniform(0.9, 1.3), a = x1 / 2 - kWide / 2, b = a + kWide,
               y2 = y1 + t + kGoing * (kRises - 1);
  carve(add_part(made.site, draw.name("floor"), sites::kConcrete, Surface::floor),
        {block(-6, x1 + 6, -4, y2 + 6, -0.3, 0)}, {block(a, b, y1 + t, y2, -0.3, 0)});
  carve(add_part(made.site, draw.name("floor"), sites::kConcrete, Surface::floor),
        {block(-t, x1 + t, -t, y1 + t, -depth - 0.3, -depth), block(a - t, b + t, y1, y2, -depth - 0.3, -depth)});
  Part& walls = add_part(made.site, draw.name("wall"), sites::kPlaster, Surface::wall_top);
  const double top = -depth + spring + rise + 0.1;
  carve(walls,
        {block(-t, 0, -t, y1 + t, -depth, -depth + spring), block(x1, x1 + t, -t, y1 + t, -depth, -depth + spring),
         block(0, x1, -t, 0, -depth, top), block(0, x1, y1, y1 + t, -depth, top)},
        {block(a, b, y1, y1 + t, -depth, -depth + 2.1)});
  for (const double x : {a - t, b}) add_box(walls, block(x, x + t, y1 + t, y2, -depth, 0.9));
  add_box(walls, block(a, b, y1 + 0.01, y1 + t, top, 0.9));
  Part& shell = add_part(made.site, draw.name("vault"), sites::kPlaster, Surface::roof);
  const auto on_arc = [&](int k, double y) {
    const double angle = std::numbers::pi * k / kFacets;
    return Vec3{x1 / 2 - x1 / 2 * std::cos(angle), y, -depth + spring + rise * std::sin(angle)};
  };
  for (int k = 0; k < kFacets; ++k)  // seen from below
    add_quad(shell, on_arc(k, 0), on_arc(k, y1), on_arc(k + 1, y1), on_arc(k + 1, 0));
  sites::add_flight(add_part(made.site, draw.name("stair"), sites::kConcrete, Surface::floor), a, b, y1 + t, -depth,
                    kRises, depth / kRises, kGoing);
  add_hut(made, draw, -5, -3, 0);
  made.site.places = {place("yard", -6, x1 + 6, -4, y2 + 6, 0, true), place("cellar", 0, x1, 0, y1, -depth)};
  made.told = "cellar with a vault below a yard";
}

// Decks for cars between parapets, with columns, and a ramp from each to the next.
void car_park(RandomSite& made, const Draws& draw) {
  constexpr double kRamp = 3.6, kSlab = 0.3, kFrom = 4;
  const int levels = 2 + static_cast<int>(draw.uniform(0, 2));
  const double storey = draw.uniform(2.7, 3), run = storey / draw.uniform(0.13, 0.15);
  const double x1 = draw.uniform(18, 26), y1 = kFrom + run + draw.uniform(6, 9);
  const auto ramp_from = [&](int level) { return x1 - 0.5 - kRamp - level * (kRamp + 0.5); };  // to the next deck
  for (int level = 0; level < levels; ++level) {
    const double z = level * storey, ramp = ramp_from(level), hole = ramp_from(level - 1);
    std::vector<Box> holes;
    if (level > 0) holes.push_back(block(hole, hole + kRamp, kFrom, kFrom + run, z - kSlab, z));
    carve(add_part(made.site, draw.name("deck"), sites::kConcrete, Surface::floor),
          {block(0, x1, level > 0 ? 0 : -6, y1, z - kSlab, z)}, holes);
    const double high = z + 1.1;
    Part& parapets = add_part(made.site, draw.name("parapet"), sites::kPlaster, Surface::wall_top);
    std::vector<Box> openings;
    if (level == 0) openings.push_back(block(3, 9, 0, 0.2, z, high));
    carve(parapets,
          {block(0, x1, 0, 0.2, z, high), block(0, x1, y1 - 0.2, y1, z, high), block(0, 0.2, 0, y1, z, high),
           block(x1 - 0.2, x1, 0, y1, z, high)},
          openings);
    if (level > 0) {
      for (const double x : {hole - 0.15, hole + kRamp})
        add_box(parapets, block(x, x + 0.15, kFrom, kFrom + run, z, high));
      add_box(parapets, block(hole, hole + kRamp, kFrom - 0.15, kFrom, z, high));
    }
    for (int car = 0, cars = 2 + static_cast<int>(draw.uniform(0, 4)); car < cars; ++car)
      sites::add_car(made.site, draw.name("car"), 3 + draw.uniform(0, 0.4), 3.5 + 3.1 * car, z);
    if (level + 1 == levels) continue;
    Part& columns = add_part(made.site, draw.name("column"), sites::kConcrete, Surface::wall_top);
    for (double x = 0.2; x < ramp - 1; x += 8)
      for (double y = 0.2; y < y1 - 0.5; y += 7.5)
        add_box(columns, block(x, x + 0.4, y, y + 0.4, z, z + storey - kSlab));
    const double end = kFrom + run, next = z + storey;
    sites::add_prism(add_part(made.site, draw.name("ramp"), sites::kConcrete, Surface::floor),
                     {{kFrom, z - 0.25}, {end, next - 0.25}, {end, next}, {kFrom, z}}, ramp, ramp + kRamp);
  }
  for (int level = 0; level < levels; ++level)
    made.site.places.push_back(place("deck", 0, x1, 0, y1, level * storey, level + 1 == levels));
  made.told = std::to_string(levels) + " decks for cars with ramps";
}

// A house on a slope: terrain of one sheet, a level floor on a foundation, a closed door on the uphill side.
void hillside(RandomSite& made, const Draws& draw) {
  constexpr int kCells = 24;
  constexpr double kCell = 1.75, kSize = kCells * kCell, t = 0.3;
  const double slope = draw.uniform(0.06, 0.16), swell = draw.uniform(0.2, 0.7), phase = draw.uniform(0, 6);
  const auto at = [&](double x, double y) {
    return Vec3{x, y, 30 + slope * x + swell * std::sin(0.17 * y + phase) * std::sin(std::numbers::pi * x / kSize)};
  };
  Part& terrain = add_part(made.site, draw.name("terrain"), sites::kGrass, Surface::floor);
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j) {
      const double x = i * kCell, y = j * kCell;
      add_quad(terrain, at(x, y), at(x + kCell, y), at(x + kCell, y + kCell), at(x, y + kCell));
    }
  const double x0 = draw.uniform(10, 14), x1 = x0 + draw.uniform(6, 9), y0 = draw.uniform(14, 18),
               y1 = y0 + draw.uniform(5, 7), door = y0 + 2;
  double z = at(x1, door).z;
  for (const double y : {y0, door, door + 1, y1}) z = std::max(z, at(x1, y).z + 0.1);
  add_box(add_part(made.site, draw.name("foundation"), sites::kConcrete, Surface::floor),
          block(x0, x1, y0, y1, z - 4, z));
  const double high = z + 2.6, middle = (x0 + x1) / 2;
  carve(
      add_part(made.site, draw.name("wall"), sites::kPlaster, Surface::wall_top),
      {block(x0, x1, y0, y0 + t, z, high), block(x0, x1, y1 - t, y1, z, high), block(x0, x0 + t, y0, y1, z, high),
       block(x1 - t, x1, y0, y1, z, high), block(middle - 0.1, middle + 0.1, y0, y1, z, high)},
      {block(x1 - t, x1, door, door + 1, z, z + 2.1), block(middle - 0.1, middle + 0.1, y0 + 1, y0 + 1.9, z, z + 2.05),
       block(x0, x0 + t, y0 + 2, y0 + 3.4, z + 0.9, z + 2.1)});
  add_box(add_part(made.site, draw.name("roof"), sites::kTiles, Surface::roof),
          block(x0 - 0.4, x1 + 0.4, y0 - 0.4, y1 + 0.4, high, high + 0.25));
  add_leaf(made, draw.name("leaf"),
           block(x1 - t / 2 - 0.02, x1 - t / 2 + 0.02, door + 0.01, door + 0.99, z + 0.01, z + 2.09));
  sites::add_tree(made.site, draw.name("tree"), 5, 8, at(5, 8).z);
  made.site.places = {place("hall", middle, x1, y0, y1, z), place("chamber", x0, middle, y0, y1, z)};
  made.told = "house on a slope";
}

}  // namespace

void make_strange(RandomSite& made, std::size_t kind, const Draws& draw) {
  constexpr std::array kinds{loft, sheets, terrain, yard, shop, platform, vault, car_park, hillside};
  static_assert(kinds.size() == kStrangeKinds);
  kinds[kind % kinds.size()](made, draw);
}

}  // namespace vantage::test
