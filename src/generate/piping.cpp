// SPDX-License-Identifier: Apache-2.0
#include "generate/piping.hpp"

#include <algorithm>
#include <cmath>

namespace vantage::built_in {
namespace {

// An interruption of a straight run, at a distance from its start.
struct Fitting {
  double at = 0, half_length = 0;
  bool valve = false;
};

// The bend at a corner of a route.
struct Bend {
  double cut = 0, angle = 0;  // cut: length taken from each neighbouring run
  dvec3 axis{};
};

std::vector<Bend> bends_of(const std::vector<dvec3>& route, double radius) {
  std::vector<Bend> bends(route.size());
  for (std::size_t i = 1; i + 1 < route.size(); ++i) {
    const dvec3 in = route[i] - route[i - 1], out = route[i + 1] - route[i];
    const dvec3 axis = cross(normalize(in), normalize(out));
    const double sine = glm::length(axis);
    bends[i].angle = std::atan2(sine, dot(normalize(in), normalize(out)));
    bends[i].axis = axis * (1 / sine);
    // two bends share a run; one alone may take nearly all of it
    const double before = (i == 1 ? 0.92 : 0.46) * glm::length(in),
                 after = (i + 2 == route.size() ? 0.92 : 0.46) * glm::length(out);
    bends[i].cut = std::min({3 * radius * std::tan(bends[i].angle / 2), before, after});
  }
  return bends;
}

// Bonnet, stem and handwheel of a valve whose body is centred at `frame`. The stem points up; on upright pipes, to the
// north.
void add_valve_top(Shaper& shaper, const Frame& frame, double radius) {
  const Frame stem = frame_along(frame.origin, std::abs(frame.z.z) < 0.5 ? dvec3{0, 0, 1} : dvec3{0, 1, 0});
  const double top = 2.4 * radius + 0.06, joint = 1.7 * radius;
  const double wheel = 1.3 * radius + 0.04, tube = 0.1 * wheel;
  if (shaper.detail().rough()) {
    const ProfilePoint bonnet[] = {
        {1.4 * radius, 0.75 * radius}, {joint, 0.75 * radius}, {top, 0.3 * radius}, {top, 0}};
    shaper.turn(stem, bonnet, shaper.detail().around(radius));
    shaper.hoop(stem.ahead(top), wheel, tube, 2 * kPi);
    return;
  }
  const ProfilePoint bonnet[] = {
      {1.4 * radius, 0.75 * radius}, {joint, 0.75 * radius},       {joint, 1.1 * radius},
      {joint + 0.02, 1.1 * radius},  {joint + 0.02, 0.5 * radius}, {2.1 * radius + 0.02, 0.4 * radius},
      {2.1 * radius + 0.02, 0.012},  {top + 0.03, 0.012},          {top + 0.03, 0}};
  shaper.turn(stem, bonnet, shaper.detail().around(radius));
  add_bolts(shaper, stem.ahead(joint + 0.02), 0.85 * radius, std::max(0.12 * radius, 0.005), 6);
  shaper.hoop(stem.ahead(top), wheel, tube, 2 * kPi);
  for (int spoke = 0; spoke < 3; ++spoke) {
    const double angle = 2 * kPi * spoke / 3;
    const dvec3 out = stem.x * std::cos(angle) + stem.y * std::sin(angle), centre = stem.ahead(top).origin;
    shaper.rod(centre + out * 0.013, centre + out * (wheel - 0.8 * tube), 0.5 * tube, false);
  }
}

// The outline of a valve's body between two flanges, from −half to +half.
std::vector<ProfilePoint> valve_body(double half, double radius, double end_radius, double end_thickness, int steps) {
  std::vector<ProfilePoint> profile{
      {-half, radius}, {-half, end_radius}, {-half + end_thickness, end_radius}, {-half + end_thickness, 1.1 * radius}};
  const double reach = half - end_thickness;
  for (int i = 1; i < steps; ++i) {
    const double t = -1 + 2.0 * i / steps;
    profile.push_back({t * reach, radius * (1.1 + 0.6 * std::cos(t * kPi / 2))});
  }
  profile.insert(
      profile.end(),
      {{half - end_thickness, 1.1 * radius}, {half - end_thickness, end_radius}, {half, end_radius}, {half, radius}});
  return profile;
}

void add_fitting(Shaper& shaper, const Frame& centre, const Fitting& fitting, double radius, int sides) {
  const Flange flange = flange_for(radius);
  const double half = fitting.half_length;
  if (fitting.valve) {
    shaper.turn(centre,
                valve_body(half, radius, flange.radius, flange.half_thickness,
                           shaper.detail().rough() ? 3 : std::clamp(sides / 2, 6, 64)),
                sides);
    add_valve_top(shaper, centre, radius);
  } else {
    const double gap = 0.15 * half, groove = 0.5 * (radius + flange.radius);  // two flanges with a gasket between them
    const ProfilePoint pair[] = {{-half, radius}, {-half, flange.radius}, {-gap, flange.radius}, {-gap, groove},
                                 {gap, groove},   {gap, flange.radius},   {half, flange.radius}, {half, radius}};
    const ProfilePoint disc[] = {{-half, radius}, {-half, flange.radius}, {half, flange.radius}, {half, radius}};
    if (shaper.detail().sagitta_m < 1e-3)
      shaper.turn(centre, pair, sides);
    else
      shaper.turn(centre, disc, sides);
  }
  const Frame back{centre.origin, centre.x, -centre.y, -centre.z};
  add_bolts(shaper, centre.ahead(half), flange.bolt_circle, flange.bolt_radius, flange.bolts);
  add_bolts(shaper, back.ahead(half), flange.bolt_circle, flange.bolt_radius, flange.bolts);
}

std::vector<Fitting> fittings_of(double length, double radius, std::size_t run, bool first, bool last, bool rough,
                                 const PipeOptions& options) {
  const double half = flange_for(radius).half_thickness;
  std::vector<Fitting> fittings;
  if (first && options.flange_at_start) fittings.push_back({2.5 * half + 0.02, half, false});
  if (last && options.flange_at_end) fittings.push_back({length - 2.5 * half - 0.02, half, false});
  for (const Valve& valve : options.valves)
    if (valve.run == run) fittings.push_back({valve.share * length, 2.2 * radius + 0.03, true});
  const int joints = options.flange_every_m > 0 && !rough ? static_cast<int>(length / options.flange_every_m) : 0;
  for (int i = 1; i <= joints; ++i) fittings.push_back({length * i / (joints + 1), half, false});
  std::ranges::stable_sort(fittings, {}, &Fitting::at);
  std::vector<Fitting> kept;  // those that neither leave the run nor touch the previous one
  for (const Fitting& fitting : fittings) {
    const double clear = kept.empty() ? 0.005 : kept.back().at + kept.back().half_length + 0.005;
    if (fitting.at - fitting.half_length < clear || fitting.at + fitting.half_length > length - 0.005) continue;
    kept.push_back(fitting);
  }
  return kept;
}

}  // namespace

Flange flange_for(double pipe_radius) {
  Flange flange;
  flange.radius = 1.5 * pipe_radius + 0.035;
  flange.half_thickness = 0.012 + 0.12 * pipe_radius;
  flange.bolt_circle = 0.5 * (pipe_radius + flange.radius);
  flange.bolt_radius = std::min(0.26 * (flange.radius - pipe_radius), 0.022);
  flange.bolts = pipe_radius < 0.055 ? 4 : pipe_radius < 0.13 ? 8 : pipe_radius < 0.3 ? 16 : 24;
  return flange;
}

void add_bolts(Shaper& shaper, const Frame& frame, double circle_radius, double bolt_radius, int count) {
  const double sagitta = shaper.detail().sagitta_m;
  if (bolt_radius < 4 * sagitta) return;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * kPi * (i + 0.5) / count;
    const Frame bolt = frame.at(frame.point(circle_radius * std::cos(angle), circle_radius * std::sin(angle), 0));
    const double height = 0.85 * bolt_radius;
    if (sagitta > 3e-4) {
      shaper.prism(bolt, bolt_radius, height, 6);
      continue;
    }
    const double washer = 0.15 * bolt_radius;  // washer, nut and the end of the stud
    shaper.cylinder(bolt, 1.2 * bolt_radius, washer, false, true);
    shaper.prism(bolt.ahead(washer), bolt_radius, height, 6);
    shaper.cylinder(bolt.ahead(washer + height), 0.55 * bolt_radius, 0.5 * bolt_radius, false, true);
  }
}

void add_pipe(Shaper& shaper, const std::vector<dvec3>& route, double radius, const PipeOptions& options) {
  const int sides = shaper.detail().around(radius);
  const std::vector<Bend> bends = bends_of(route, radius);
  Frame frame = frame_along(route[0], route[1] - route[0]);
  const auto disc = [&](const Frame& at, bool ahead) {
    const ProfilePoint end[] = {{0, ahead ? radius : 0}, {0, ahead ? 0 : radius}};
    shaper.turn(at, end, sides);
  };
  for (std::size_t run = 0; run + 1 < route.size(); ++run) {
    const double length = glm::length(route[run + 1] - route[run]) - bends[run].cut - bends[run + 1].cut;
    const bool first = run == 0, last = run + 2 == route.size();
    if (first && options.blind_start) disc(frame, false);
    double from = 0;
    const auto straight = [&](double to) {
      const ProfilePoint wall[] = {{from, radius}, {to, radius}};
      if (to > from) shaper.turn(frame, wall, sides);
    };
    for (const Fitting& fitting : fittings_of(length, radius, run, first, last, shaper.detail().rough(), options)) {
      straight(fitting.at - fitting.half_length);
      add_fitting(shaper, frame.ahead(fitting.at), fitting, radius, sides);
      from = fitting.at + fitting.half_length;
    }
    straight(length);
    frame = frame.ahead(length);
    if (last) {
      if (options.blind_end) disc(frame, true);
      break;
    }
    const Bend& bend = bends[run + 1];
    const double bend_radius = bend.cut / std::tan(bend.angle / 2);
    const dvec3 centre = frame.origin + cross(bend.axis, frame.z) * bend_radius;
    const int steps =
        std::max({2, shaper.detail().along(bend.angle * bend_radius),
                  static_cast<int>(std::ceil(shaper.detail().around(bend_radius) * bend.angle / (2 * kPi)))});
    std::vector<Ring> rings;
    for (int k = 0; k <= steps; ++k)
      rings.push_back({turned(frame, centre, bend.axis, bend.angle * k / steps), radius});
    shaper.skin(rings, sides);
    frame = rings.back().frame;
  }
}

void add_nozzle(Shaper& shaper, const Frame& frame, double radius, double length, double bury) {
  const Flange flange = flange_for(radius);
  const double thick = 2 * flange.half_thickness;
  const ProfilePoint profile[] = {{-bury, radius},
                                  {length - thick, radius},
                                  {length - thick, flange.radius},
                                  {length + 0.8 * thick, flange.radius},
                                  {length + 0.8 * thick, 0}};
  shaper.turn(frame, profile, shaper.detail().around(radius));
  add_bolts(shaper, frame.ahead(length + 0.8 * thick), flange.bolt_circle, flange.bolt_radius, flange.bolts);
}

}  // namespace vantage::built_in
