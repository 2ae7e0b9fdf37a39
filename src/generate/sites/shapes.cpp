// SPDX-License-Identifier: Apache-2.0
#include "generate/sites/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vantage::sites {
namespace {

std::uint32_t add_point(Part& part, const Vec3& p) {
  part.positions.push_back(p);
  return static_cast<std::uint32_t>(part.positions.size() - 1);
}

// A planar convex polygon, counter-clockwise seen from outside.
void add_polygon(Part& part, const std::vector<Vec3>& corners) {
  const auto first = static_cast<std::uint32_t>(part.positions.size());
  for (const Vec3& p : corners) add_point(part, p);
  for (std::uint32_t i = 2; i < corners.size(); ++i) part.triangles.push_back({first, first + i - 1, first + i});
}

double& axis(Vec3& v, int a) { return a == 0 ? v.x : a == 1 ? v.y : v.z; }
double axis(const Vec3& v, int a) { return a == 0 ? v.x : a == 1 ? v.y : v.z; }

// Cells between all faces of the boxes; each cell is solid or empty as a whole.
struct Cells {
  std::vector<double> at[3];
  std::vector<char> solid;
  int count(int a) const { return static_cast<int>(at[a].size()) - 1; }
  char& cell(int i, int j, int k) {
    return solid[(static_cast<std::size_t>(k) * static_cast<std::size_t>(count(1)) + static_cast<std::size_t>(j)) *
                     static_cast<std::size_t>(count(0)) +
                 static_cast<std::size_t>(i)];
  }
  bool filled(int i, int j, int k) {
    return i >= 0 && j >= 0 && k >= 0 && i < count(0) && j < count(1) && k < count(2) && cell(i, j, k);
  }
  void fill(const Box& box, char value) {
    int first[3], last[3];
    for (int a = 0; a < 3; ++a) {
      const auto place = [&](double v) { return static_cast<int>(std::ranges::lower_bound(at[a], v) - at[a].begin()); };
      first[a] = place(axis(box.min, a)), last[a] = place(axis(box.max, a));
    }
    for (int k = first[2]; k < last[2]; ++k)
      for (int j = first[1]; j < last[1]; ++j)
        for (int i = first[0]; i < last[0]; ++i) cell(i, j, k) = value;
  }
};

// Faces across axis `a` at plane `n`, merged into rectangles.
void add_faces(Part& part, Cells& cells, int a, int n, bool forward) {
  const int b = (a + 1) % 3, c = (a + 2) % 3;
  const int columns = cells.count(b), rows = cells.count(c);
  const auto shown = [&](int p, int q) {
    int behind[3], before[3];
    behind[a] = n - 1, before[a] = n;
    behind[b] = before[b] = p, behind[c] = before[c] = q;
    const bool low = cells.filled(behind[0], behind[1], behind[2]),
               high = cells.filled(before[0], before[1], before[2]);
    return forward ? low && !high : high && !low;
  };
  std::vector<char> done(static_cast<std::size_t>(columns * rows));
  const auto open = [&](int p, int q) { return !done[static_cast<std::size_t>(q * columns + p)] && shown(p, q); };
  for (int q = 0; q < rows; ++q)
    for (int p = 0; p < columns; ++p) {
      if (!open(p, q)) continue;
      int p1 = p + 1, q1 = q + 1;
      while (p1 < columns && open(p1, q)) ++p1;
      const auto whole_row = [&](int row) {
        for (int i = p; i < p1; ++i)
          if (!open(i, row)) return false;
        return true;
      };
      while (q1 < rows && whole_row(q1)) ++q1;
      for (int j = q; j < q1; ++j)
        for (int i = p; i < p1; ++i) done[static_cast<std::size_t>(j * columns + i)] = 1;
      const auto corner = [&](int i, int j) {
        Vec3 v;
        axis(v, a) = cells.at[a][static_cast<std::size_t>(n)];
        axis(v, b) = cells.at[b][static_cast<std::size_t>(i)];
        axis(v, c) = cells.at[c][static_cast<std::size_t>(j)];
        return v;
      };
      std::vector<Vec3> corners{corner(p, q), corner(p1, q), corner(p1, q1), corner(p, q1)};
      if (!forward) std::ranges::reverse(corners);
      add_polygon(part, corners);
    }
}

}  // namespace

Box block(double x0, double x1, double y0, double y1, double z0, double z1) { return {{x0, y0, z0}, {x1, y1, z1}}; }

void carve(Part& part, const std::vector<Box>& solids, const std::vector<Box>& holes) {
  Cells cells;
  for (int a = 0; a < 3; ++a) {
    for (const auto* boxes : {&solids, &holes})
      for (const Box& box : *boxes) cells.at[a].push_back(axis(box.min, a)), cells.at[a].push_back(axis(box.max, a));
    std::ranges::sort(cells.at[a]);
    const auto repeated = std::ranges::unique(cells.at[a]);
    cells.at[a].erase(repeated.begin(), repeated.end());
  }
  cells.solid.resize(static_cast<std::size_t>(cells.count(0)) * static_cast<std::size_t>(cells.count(1)) *
                     static_cast<std::size_t>(cells.count(2)));
  for (const Box& box : solids) cells.fill(box, 1);
  for (const Box& box : holes) cells.fill(box, 0);
  for (int a = 0; a < 3; ++a)
    for (int n = 0; n <= cells.count(a); ++n)
      for (const bool forward : {false, true}) add_faces(part, cells, a, n, forward);
}

void add_box(Part& part, const Box& box) { carve(part, {box}); }

void add_prism(Part& part, const std::vector<std::pair<double, double>>& profile, double x0, double x1) {
  const auto point = [&](std::size_t i, double x) {
    const auto& [y, z] = profile[i % profile.size()];
    return Vec3{x, y, z};
  };
  std::vector<Vec3> near, far;
  for (std::size_t i = 0; i < profile.size(); ++i) near.push_back(point(i, x0)), far.push_back(point(i, x1));
  add_polygon(part, far);
  std::ranges::reverse(near);
  add_polygon(part, near);
  for (std::size_t i = 0; i < profile.size(); ++i)
    add_polygon(part, {point(i, x0), point(i + 1, x0), point(i + 1, x1), point(i, x1)});
}

void add_cylinder(Part& part, const Vec3& end, int along, double radius, double length, int sides) {
  std::vector<Vec3> near, far;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    Vec3 p = end;
    axis(p, (along + 1) % 3) += radius * std::cos(angle);
    axis(p, (along + 2) % 3) += radius * std::sin(angle);
    near.push_back(p);
    axis(p, along) += length;
    far.push_back(p);
  }
  for (std::size_t i = 0; i < near.size(); ++i) {
    const std::size_t j = (i + 1) % near.size();
    add_polygon(part, {near[i], near[j], far[j], far[i]});
  }
  add_polygon(part, far);
  std::ranges::reverse(near);
  add_polygon(part, near);
}

void add_ball(Part& part, const Vec3& centre, double radius) {
  constexpr int kRings = 6, kSides = 10;
  const auto point = [&](int ring, int side) {
    const double zenith = std::numbers::pi * ring / kRings, azimuth = 2 * std::numbers::pi * (side % kSides) / kSides;
    const double across = ring == 0 || ring == kRings ? 0 : radius * std::sin(zenith);
    return centre + Vec3{across * std::cos(azimuth), across * std::sin(azimuth), radius * std::cos(zenith)};
  };
  for (int ring = 0; ring < kRings; ++ring)
    for (int side = 0; side < kSides; ++side) {
      std::vector<Vec3> corners{point(ring, side), point(ring + 1, side)};
      if (ring + 1 < kRings) corners.push_back(point(ring + 1, side + 1));
      if (ring > 0) corners.push_back(point(ring, side + 1));
      add_polygon(part, corners);
    }
}

void add_gabled_roof(Part& roof, Part& gables, const Box& plan, double z, double slope_deg, double eaves) {
  constexpr double kThick = 0.2, kWall = 0.3;
  const double slope = std::tan(slope_deg * std::numbers::pi / 180), middle = (plan.min.y + plan.max.y) / 2;
  const auto under = [&](double y) {  // the slabs' underside: through the middle of the walls' tops
    return z + slope * (std::min(y - plan.min.y, plan.max.y - y) - kWall / 2);
  };
  const double south = plan.min.y - eaves, north = plan.max.y + eaves;
  const double x0 = plan.min.x - eaves, x1 = plan.max.x + eaves;
  add_prism(roof,
            {{south, under(south)},
             {middle, under(middle)},
             {middle, under(middle) + kThick},
             {south, under(south) + kThick}},
            x0, x1);
  add_prism(roof,
            {{middle, under(middle)},
             {north, under(north)},
             {north, under(north) + kThick},
             {middle, under(middle) + kThick}},
            x0, x1);
  // half-way into the slabs, so that no light enters
  const auto gable = [&](double from) {
    const double low = plan.min.y + kWall / 2, high = plan.max.y - kWall / 2;
    add_prism(
        gables,
        {{low, z}, {high, z}, {high, z + kThick / 2}, {middle, under(middle) + kThick / 2}, {low, z + kThick / 2}},
        from, from + kWall);
  };
  gable(plan.min.x);
  gable(plan.max.x - kWall);
}

void add_flight(Part& part, double x0, double x1, double y, double z, int count, double rise, double going) {
  constexpr double kThick = 0.2;
  std::vector<Box> steps;
  for (int i = 0; i + 1 < count; ++i) {
    const double top = z + rise * (i + 1), from = y + going * i;
    // extends under the next one, so that the flight is one body
    steps.push_back(block(x0, x1, from, from + going * (i + 2 < count ? 2 : 1), std::max(z, top - kThick), top));
  }
  carve(part, steps);
}

Part& add_part(Site& site, const std::string& name, const std::array<float, 3>& colour, Surface top) {
  site.parts.push_back({.name = name, .colour = colour, .top = top});
  return site.parts.back();
}

void add_table(Site& site, const std::string& name, const Box& box) {
  Part& part = add_part(site, name, kWood, Surface::furniture);
  const auto [low, high] = box;
  const double top = high.z - 0.04, leg = 0.06;
  std::vector<Box> solids{block(low.x, high.x, low.y, high.y, top, high.z)};
  for (const double x : {low.x, high.x - leg})
    for (const double y : {low.y, high.y - leg}) solids.push_back(block(x, x + leg, y, y + leg, low.z, top));
  carve(part, solids);
}

void add_chair(Site& site, const std::string& name, double x, double y, double z) {
  Part& part = add_part(site, name, kPaint, Surface::furniture);
  carve(part, {block(x - 0.05, x + 0.05, y - 0.05, y + 0.05, z, z + 0.42),
               block(x - 0.22, x + 0.22, y - 0.22, y + 0.22, z + 0.42, z + 0.48),
               block(x - 0.22, x + 0.22, y + 0.18, y + 0.22, z + 0.48, z + 0.95)});
}

void add_block(Site& site, const std::string& name, const Box& box, Surface top) {
  add_box(add_part(site, name, top == Surface::furniture ? kWood : kSteel, top), box);
}

void add_tree(Site& site, const std::string& name, double x, double y, double z) {
  add_cylinder(add_part(site, name + "_trunk", kWood, Surface::tree), {x, y, z}, 2, 0.15, 3.0, 8);
  add_ball(add_part(site, name + "_crown", kGrass, Surface::tree), {x, y, z + 4.2}, 1.7);
}

void add_car(Site& site, const std::string& name, double x, double y, double z) {
  Part& body = add_part(site, name + "_body", kPaint, Surface::car);
  carve(body, {block(x, x + 4.4, y, y + 1.8, z + 0.25, z + 0.85),
               block(x + 1.2, x + 3.5, y + 0.1, y + 1.7, z + 0.85, z + 1.45)});
  Part& wheels = add_part(site, name + "_wheels", {0.03F, 0.03F, 0.03F}, Surface::car);
  for (const double along : {0.8, 3.5})
    for (const double across : {0.02, 1.58}) add_cylinder(wheels, {x + along, y + across, z + 0.3}, 1, 0.3, 0.2, 12);
}

}  // namespace vantage::sites
