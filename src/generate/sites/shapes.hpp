// SPDX-License-Identifier: Apache-2.0
// Closed shells that the sites are made of.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "generate/sites/site.hpp"

namespace vantage::sites {

Box block(double x0, double x1, double y0, double y1, double z0, double z1);

// Adds the union of `solids` minus `holes`, as one shell without interior faces.
void carve(Part& part, const std::vector<Box>& solids, const std::vector<Box>& holes = {});
void add_box(Part& part, const Box& box);
// A convex profile of (y, z) points, counter-clockwise seen from +x, extruded along x.
void add_prism(Part& part, const std::vector<std::pair<double, double>>& profile, double x0, double x1);
// A cylinder with `sides` sides, from the centre of one end along axis 0, 1 or 2.
void add_cylinder(Part& part, const Vec3& end, int axis, double radius, double length, int sides = 16);
void add_ball(Part& part, const Vec3& centre, double radius);
// A gabled roof over a rectangle, its ridge along x: two slabs 0.2 m thick with an overhang of `eaves`, and the gables.
// The walls below end at `z`; the slabs rest on their middles.
void add_gabled_roof(Part& roof, Part& gables, const Box& plan, double z, double slope_deg, double eaves);
// A flight of closed steps from (x, y) along +y: `count` rises of `rise` each; the last one is the floor above.
void add_flight(Part& part, double x0, double x1, double y, double z, int count, double rise, double going);

// Objects common to several sites, one node each.
Part& add_part(Site& site, const std::string& name, const std::array<float, 3>& colour, Surface top);
void add_table(Site& site, const std::string& name, const Box& box);  // a top on four legs
void add_chair(Site& site, const std::string& name, double x, double y, double z);
void add_block(Site& site, const std::string& name, const Box& box, Surface top = Surface::furniture);
void add_tree(Site& site, const std::string& name, double x, double y, double z);
void add_car(Site& site, const std::string& name, double x, double y, double z);  // 4.4 m along x

constexpr std::array<float, 3> kPlaster{0.75F, 0.73F, 0.68F}, kConcrete{0.45F, 0.44F, 0.42F},
    kWood{0.42F, 0.26F, 0.13F}, kTiles{0.35F, 0.10F, 0.06F}, kGrass{0.12F, 0.25F, 0.06F}, kSteel{0.40F, 0.42F, 0.45F},
    kPaint{0.10F, 0.16F, 0.45F};

}  // namespace vantage::sites
