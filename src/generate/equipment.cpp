// SPDX-License-Identifier: Apache-2.0
#include "generate/equipment.hpp"

#include <algorithm>
#include <cmath>

#include "generate/piping.hpp"

namespace vantage::built_in {
namespace {

constexpr dvec3 kEast{1, 0, 0}, kSouth{0, -1, 0};

// Depth to which a branch must reach into a cylinder so that its whole rim lies inside.
double burial(double vessel_radius, double branch_radius) {
  return vessel_radius - std::sqrt(vessel_radius * vessel_radius - branch_radius * branch_radius) + 0.01;
}

// A plate across x that carries a lying cylinder: flat below, cut out above. `centre` is on the cylinder's axis; the
// foot is at `low`.
void add_saddle(Shaper& shaper, const dvec3& centre, double radius, double low, double half_width,
                double half_thickness) {
  const int steps = std::max(4, shaper.detail().around(radius) / 4);
  const auto edge = [&](int i) { return half_width * std::sin(kPi / 2 * (2.0 * i / steps - 1)); };
  const auto top = [&](double y) { return centre.z - std::sqrt(radius * radius - y * y) + 0.004; };
  for (int i = 0; i < steps; ++i) {
    const double y0 = edge(i), y1 = edge(i + 1);
    const double z0 = top(y0), z1 = top(y1), z = std::min(z0, z1);
    for (const double side : {-1.0, 1.0}) {
      const double x = centre.x + side * half_thickness;
      const dvec3 corner{x, side > 0 ? centre.y + y0 : centre.y + y1, low};
      shaper.face(corner, {0, side * (y1 - y0), 0}, {0, 0, z - low});
      // the slanted remainder up to the vessel
      const double rise0 = side > 0 ? z0 : z1, rise1 = side > 0 ? z1 : z0;
      shaper.triangle(
          corner + dvec3{0, 0, z - low}, corner + dvec3{0, side * (y1 - y0), z - low},
          rise0 > rise1 ? corner + dvec3{0, 0, rise0 - low} : corner + dvec3{0, side * (y1 - y0), rise1 - low});
    }
  }
  const double rim = top(half_width);
  shaper.face({centre.x - half_thickness, centre.y - half_width, low}, {2 * half_thickness, 0, 0}, {0, 0, rim - low});
  shaper.face({centre.x + half_thickness, centre.y + half_width, low}, {-2 * half_thickness, 0, 0}, {0, 0, rim - low});
}

void add_motor(Shaper& shaper, const Frame& f, double radius, double length, bool close_start) {
  const ProfilePoint profile[] = {{0, 0},
                                  {0, radius},
                                  {length, radius},
                                  {length, 1.06 * radius},
                                  {1.25 * length, 1.06 * radius},
                                  {1.25 * length, 0}};
  shaper.turn(f, std::span(profile).subspan(close_start ? 0 : 1), shaper.detail().around(radius));
  const int fins = shaper.detail().rough() ? 0 : shaper.detail().sagitta_m < 2e-3 ? 24 : 8;
  for (int i = 0; i < fins; ++i) {
    const double angle = 2 * kPi * (i + 0.5) / fins, thickness = 0.004;
    const dvec3 out = f.x * std::cos(angle) + f.y * std::sin(angle);
    const Frame fin{f.origin, out, cross(f.z, out), f.z};
    shaper.box(fin, {0.98 * radius, -0.5 * thickness, 0.06 * length}, {1.14 * radius, 0.5 * thickness, 0.94 * length},
               kLeft);
  }
}

}  // namespace

void add_upright_vessel(Shaper& shell, Shaper& legs, const UprightVessel& v) {
  const int sides = shell.detail().around(v.radius);
  const double bulge = 0.5 * v.radius;
  const Frame base{v.foot};
  const ProfilePoint wall[] = {{v.shell_low, v.radius}, {v.shell_high, v.radius}};
  shell.turn(base, wall, sides);
  shell.head(base.ahead(v.shell_high), v.radius, bulge, sides);
  shell.head({base.ahead(v.shell_low).origin, base.x, -base.y, -base.z}, v.radius, bulge, sides);

  const double at = 0.87 * v.radius, leg = 0.05 + 0.03 * v.radius;
  const double buried =
      v.shell_low - bulge * std::sqrt(1 - (at + 0.7 * leg) * (at + 0.7 * leg) / (v.radius * v.radius)) + 0.02;
  for (int i = 0; i < 4; ++i) {
    const double angle = kPi / 4 + kPi / 2 * i;
    const dvec3 foot = v.foot + dvec3{at * std::cos(angle), at * std::sin(angle), 0};
    const double plate = leg + 0.06;
    legs.box(foot + dvec3{-plate, -plate, 0}, foot + dvec3{plate, plate, 0.02}, kBottom);
    for (const double x : {-1.0, 1.0})
      for (const double y : {-1.0, 1.0})
        add_bolts(legs, Frame{foot + dvec3{x * (plate - 0.025), y * (plate - 0.025), 0.02}}, 0, 0.012, 1);
    legs.cylinder(Frame{foot + dvec3{0, 0, 0.02}}, leg, buried - 0.02, false, false);
  }
  if (v.manhole) {
    const double hole = 0.22 * v.radius;
    add_nozzle(shell, frame_along(v.foot + kEast * v.radius + kUp * (v.shell_high - 0.45), kEast), hole, 0.12,
               burial(v.radius, hole));
  }
  // A level gauge on the north side: two branches and a glass.
  const double gauge_y = v.radius + 0.1, low = v.shell_low + 0.15, high = v.shell_high - 0.15;
  for (const double z : {low, high})
    shell.rod(v.foot + dvec3{0, v.radius - 0.01, z}, v.foot + dvec3{0, gauge_y, z}, 0.012, false);
  shell.rod(v.foot + dvec3{0, gauge_y, low - 0.08}, v.foot + dvec3{0, gauge_y, high + 0.08}, 0.018);
  if (v.agitator) {
    const Frame top = base.ahead(v.shell_high + bulge);
    add_nozzle(shell, top, 0.12, 0.05, burial(2 * v.radius, 0.12));
    add_motor(shell, top.ahead(0.05 + 1.8 * flange_for(0.12).half_thickness), 0.1, 0.16, false);
  }
}

void add_lying_vessel(Shaper& shell, Shaper& saddles, const LyingVessel& v) {
  const int sides = shell.detail().around(v.radius);
  const Frame start = frame_along(v.centre - kEast * (0.5 * v.shell_length), kEast);
  const ProfilePoint wall[] = {{0, v.radius}, {v.shell_length, v.radius}};
  shell.turn(start, wall, sides);
  shell.head(start.ahead(v.shell_length), v.radius, 0.5 * v.radius, sides);
  shell.head({start.origin, start.x, -start.y, -start.z}, v.radius, 0.5 * v.radius, sides);
  for (const double at : {-0.31, 0.31}) {
    const dvec3 centre = v.centre + kEast * (at * v.shell_length);
    const double plinth = v.centre.z - v.radius - 0.2, half_width = 0.8 * v.radius;
    saddles.box({centre.x - 0.2, centre.y - 0.9 * v.radius, 0}, {centre.x + 0.2, centre.y + 0.9 * v.radius, plinth},
                kBottom);
    for (const double x : {-0.1, 0.1}) add_saddle(saddles, centre + kEast * x, v.radius, plinth, half_width, 0.012);
  }
  add_nozzle(shell, frame_along(v.centre + kEast * (0.25 * v.shell_length) + kUp * v.radius, kUp), 0.24, 0.16,
             burial(v.radius, 0.24));
  add_nozzle(shell, frame_along(v.centre - kEast * (0.4 * v.shell_length) + kUp * v.radius, kUp), 0.05, 0.2,
             burial(v.radius, 0.05));
}

void add_exchanger(Shaper& shell, Shaper& saddles, const dvec3& centre, double length, double radius,
                   double support_from) {
  const double joint = radius + 0.09, thick = 0.035, tube_sheet = 0.78 * length, channel = length - 0.03;
  const Frame f = frame_along(centre - kEast * (0.5 * length), kEast);
  const int sides = shell.detail().around(radius);
  // Cap at the start, shell, tube sheet between two flanges, channel, end cover.
  const ProfilePoint profile[] = {{0, radius},
                                  {tube_sheet - thick, radius},
                                  {tube_sheet - thick, joint},
                                  {tube_sheet - 0.006, joint},
                                  {tube_sheet - 0.006, joint - 0.03},
                                  {tube_sheet + 0.006, joint - 0.03},
                                  {tube_sheet + 0.006, joint},
                                  {tube_sheet + thick, joint},
                                  {tube_sheet + thick, radius},
                                  {channel - 2 * thick, radius},
                                  {channel - 2 * thick, joint},
                                  {channel, joint},
                                  {channel, 0}};
  shell.turn(f, profile, sides);
  shell.head({f.origin, f.x, -f.y, -f.z}, radius, 0.5 * radius, sides);
  const Frame back{f.origin, f.x, -f.y, -f.z};
  const double circle = radius + 0.055;
  add_bolts(shell, f.ahead(tube_sheet + thick), circle, 0.014, 20);
  add_bolts(shell, back.ahead(-(tube_sheet - thick)), circle, 0.014, 20);
  add_bolts(shell, f.ahead(channel), circle, 0.014, 20);
  add_bolts(shell, back.ahead(-(channel - 2 * thick)), circle, 0.014, 20);
  for (const double at : {0.16, 0.62}) {
    const dvec3 at_axis = f.ahead(at * length).origin;
    const double foot = centre.z - radius - 0.12;
    if (foot > support_from + 0.05)
      saddles.box({at_axis.x - 0.12, centre.y - 0.26, support_from}, {at_axis.x + 0.12, centre.y + 0.26, foot},
                  support_from == 0 ? static_cast<unsigned>(kBottom) : 0U);
    for (const double x : {-0.06, 0.06}) add_saddle(saddles, at_axis + kEast * x, radius, foot, 0.75 * radius, 0.008);
  }
}

void add_pump(Shaper& pump, Shaper& motor, Shaper& base, const dvec3& s, double discharge_height) {
  // Along y, from south to north: suction flange, volute, bearing housing, guard over the coupling, motor.
  const double axis = s.z;
  const Frame f = frame_along(s, -kSouth);
  base.box({s.x - 0.25, s.y + 0.12, 0}, {s.x + 0.25, s.y + 1.55, 0.1}, kBottom);
  base.box({s.x - 0.2, s.y + 0.2, 0.1}, {s.x + 0.2, s.y + 1.5, 0.16}, kBottom);
  const Flange flange = flange_for(0.07);
  const double t = 2 * flange.half_thickness;
  const ProfilePoint casing[] = {{0, 0.07},   {0, flange.radius}, {t, flange.radius}, {t, 0.08},    {0.18, 0.1},
                                 {0.2, 0.2},  {0.24, 0.23},       {0.36, 0.23},       {0.4, 0.2},   {0.41, 0.12},
                                 {0.5, 0.11}, {0.56, 0.11},       {0.57, 0.07},       {0.75, 0.06}, {0.75, 0}};
  pump.turn(f, casing, pump.detail().around(0.2));
  add_bolts(pump, f.ahead(t), flange.bolt_circle, flange.bolt_radius, flange.bolts);
  pump.box({s.x - 0.09, s.y + 0.26, 0.16}, {s.x + 0.09, s.y + 0.34, axis - 0.19}, kBottom | kTop);
  const Frame up = frame_along({s.x, s.y + 0.3, axis + 0.23}, kUp);
  const double length = discharge_height - axis - 0.23;
  const ProfilePoint neck[] = {
      {-0.03, 0.075}, {length - t, 0.06}, {length - t, flange.radius}, {length, flange.radius}, {length, 0.06}};
  pump.turn(up, neck, pump.detail().around(0.07));
  add_bolts(pump, Frame{up.origin, up.x, -up.y, -up.z}.ahead(-(length - t)), flange.bolt_circle, flange.bolt_radius,
            flange.bolts);
  // The guard is a half barrel on two sides.
  base.box({s.x - 0.1, s.y + 0.76, 0.16}, {s.x + 0.1, s.y + 0.96, axis + 0.1}, kBottom);
  add_motor(motor, f.ahead(0.98), 0.17, 0.42, true);
  motor.box({s.x - 0.07, s.y + 1.1, axis + 0.165}, {s.x + 0.07, s.y + 1.28, axis + 0.28}, kBottom);
  for (const double y : {1.06, 1.32})
    base.box({s.x - 0.09, s.y + y, 0.16}, {s.x + 0.09, s.y + y + 0.05, axis - 0.13}, kBottom | kTop);
}

void add_cabinet(Shaper& shaper, const dvec3& low, const dvec3& high) {
  constexpr double kPlinth = 0.1, kFrame = 0.05, kRelief = 0.015;
  shaper.box({low.x + 0.03, low.y + 0.03, low.z}, {high.x - 0.03, high.y - 0.03, low.z + kPlinth}, kBottom | kTop);
  shaper.box({low.x, low.y, low.z + kPlinth}, high);
  // two doors on the west face
  const double middle = 0.5 * (low.y + high.y);
  for (const auto& [from, to] : {std::pair{low.y + kFrame, middle - 0.01}, std::pair{middle + 0.01, high.y - kFrame}}) {
    shaper.box({low.x - kRelief, from, low.z + kPlinth + kFrame}, {low.x, to, high.z - kFrame}, kRight);
    shaper.box({low.x - kRelief - 0.03, to - 0.06, 0.5 * (low.z + high.z) - 0.08},
               {low.x - kRelief, to - 0.04, 0.5 * (low.z + high.z) + 0.08}, kRight);
  }
}

}  // namespace vantage::built_in
