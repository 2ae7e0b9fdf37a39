// SPDX-License-Identifier: Apache-2.0
// A small process plant of 15 × 14.5 × 4.5 m, composed along its process lines, for the method's complex case
// (section 5.2).
//
//   north  y                          drum with platform-north, stairs and ladder
//     ^        tanks | platform-west | aisle | pipe rack (two levels, cable tray)
//     |                                        exchangers (two, stacked)
//     +--> x   platform-south with reactors, stairs | pumps
//
// Tanks drain into a header around the west side, which feeds the pumps; pumps lift to the rack; the rack feeds tanks,
// exchangers and drum; vapour returns above. Aisles of a metre and more run between all groups.
#include <cmath>
#include <deque>
#include <limits>
#include <string>

#include "generate/equipment.hpp"
#include "generate/ground.hpp"
#include "generate/model.hpp"
#include "generate/piping.hpp"
#include "generate/structure.hpp"
#include "vantage/error.hpp"

namespace vantage::built_in {
namespace {

using Colour = std::array<float, 3>;
constexpr Colour kTank{0.36F, 0.44F, 0.38F}, kSteel{0.10F, 0.13F, 0.17F}, kDeckColour{0.22F, 0.23F, 0.24F},
    kYellow{0.72F, 0.45F, 0.03F}, kWater{0.05F, 0.24F, 0.09F}, kSteam{0.48F, 0.48F, 0.50F},
    kProduct{0.34F, 0.15F, 0.06F}, kGas{0.60F, 0.42F, 0.06F}, kPump{0.03F, 0.12F, 0.34F}, kMotor{0.18F, 0.28F, 0.30F},
    kConcrete{0.40F, 0.39F, 0.36F}, kZinc{0.50F, 0.51F, 0.52F}, kBlack{0.03F, 0.03F, 0.03F},
    kCabinet{0.58F, 0.58F, 0.54F}, kGroundColour{0.24F, 0.20F, 0.13F};

constexpr double kDiffuse = 0.24;  // as in the method, after the dark green look of its model
constexpr Deck kDeckWest{-4.4, -4.19, -2.7, 5.8, 2.4, false}, kDeckSouth{-6.9, -6.8, -2.7, -4.2, 2.4, false};
constexpr double kRackX[4] = {-1.6, 1.2, 4.0, 6.8}, kRackHalf = 1.0, kLower = 2.7, kUpper = 3.4, kRackTop = 3.9;

// The plant's parts, one glTF node each, at one detail.
class Plant {
 public:
  Plant(const Detail& detail, bool counting, bool grating) : detail_(detail), counting_(counting), grating_(grating) {
    compose();
  }
  std::size_t triangles() const {
    std::size_t sum = 0;
    for (const Entry& entry : entries_) sum += entry.shaper.triangles();
    return sum;
  }
  std::vector<Part> take() {
    std::vector<Part> parts;
    for (Entry& entry : entries_)
      parts.push_back({entry.name, Role::surveyed, kDiffuse, entry.colour, entry.shaper.take()});
    return parts;
  }
  static Deck deck_north(bool grating) { return {1.6, 2.7, 6.2, 4.1, 2.2, grating}; }

 private:
  struct Entry {
    std::string name;
    Colour colour;
    Shaper shaper;
  };
  Shaper& part(const std::string& name, const Colour& colour) {
    entries_.push_back({name, colour, Shaper(detail_, counting_)});
    return entries_.back().shaper;
  }
  void compose() {
    tanks();
    reactors();
    drum();
    exchangers();
    pumps();
    rack();
    rack_piping();
    drain_piping();
    pump_piping();
    vapour_piping();
    platforms();
    electrical();
  }
  void tanks();
  void reactors();
  void drum();
  void exchangers();
  void pumps();
  void rack();
  void rack_piping();
  void drain_piping();
  void pump_piping();
  void vapour_piping();
  void platforms();
  void electrical();
  void support(Shaper& shaper, const dvec3& under, double pipe_radius);
  void shoe(Shaper& shaper, const dvec3& pipe, double radius, double beam_top);

  Detail detail_;
  bool counting_, grating_;
  std::deque<Entry> entries_;  // references to shapers stay valid
};

constexpr double kTankX = -5.75, kTankRadius = 1.15, kTankY[3] = {4.7, 1.4, -1.9};
constexpr double kHeaderZ = 0.45, kHeaderX = -7.28, kHeaderNorth = 6.85, kHeaderSouth = -6.98;
constexpr double kPumpX[3] = {1.3, 3.4, 5.5}, kSuctionY = -6.2;

void Plant::tanks() {
  for (int i = 0; i < 3; ++i) {
    const std::string name = "tank-" + std::to_string(i + 1);
    Shaper& shell = part(name, kTank);
    add_upright_vessel(shell, part(name + "-legs", kSteel),
                       {{kTankX, kTankY[i], 0}, kTankRadius, 1.25, 3.3, true, false});
  }
}

void Plant::reactors() {
  const double x[2] = {-6.1, -4.75};
  for (int i = 0; i < 2; ++i) {
    const std::string name = "reactor-" + std::to_string(i + 1);
    Shaper& shell = part(name, kSteam);
    add_upright_vessel(shell, part(name + "-legs", kSteel),
                       {{x[i], -5.5, kDeckSouth.z + 0.001}, 0.45, 0.6, 1.45, false, true});
  }
}

void Plant::drum() {
  Shaper& shell = part("drum", kTank);
  add_lying_vessel(shell, part("drum-saddles", kConcrete), {{3.9, 5.2, 2.1}, 0.9, 3.8});
}

void Plant::exchangers() {
  for (int i = 0; i < 2; ++i) {
    const std::string name = "exchanger-" + std::to_string(i + 1);
    Shaper& shell = part(name, kSteam);
    const dvec3 centre{4.5, -3.0, i == 0 ? 0.85 : 1.85};
    add_exchanger(shell, part(name + "-saddles", i == 0 ? kConcrete : kSteel), centre, 3.8, 0.33,
                  i == 0 ? 0 : 1.18 + 0.001);
  }
}

void Plant::pumps() {
  for (int i = 0; i < 3; ++i) {
    const std::string name = "pump-" + std::to_string(i + 1);
    Shaper &casing = part(name, kPump), &motor = part(name + "-motor", kMotor);
    add_pump(casing, motor, part(name + "-base", kConcrete), {kPumpX[i], kSuctionY, kHeaderZ}, 0.9);
  }
}

void Plant::rack() {
  Shaper& steel = part("pipe-rack", kSteel);
  for (const double x : kRackX)
    for (const double y : {-kRackHalf, kRackHalf}) add_column(steel, {x, y, 0}, kRackTop, 0.16);
  for (const double x : kRackX)
    for (const double top : {kLower, kUpper})
      add_beam(steel, {x, -kRackHalf + 0.08, top}, {x, kRackHalf - 0.08, top}, 0.12, 0.18);
  for (int i = 0; i + 1 < 4; ++i)
    for (const double y : {-kRackHalf, kRackHalf})
      for (const double top : {kLower - 0.2, kUpper})
        add_beam(steel, {kRackX[i] + 0.08, y, top}, {kRackX[i + 1] - 0.08, y, top}, 0.1, 0.16);
  for (const double y : {-kRackHalf, kRackHalf}) {  // wind bracing in the middle bay
    steel.bar({kRackX[1] + 0.09, y + 0.02, 0.35}, {kRackX[2] - 0.09, y + 0.02, kLower - 0.45}, 0.012, 0.07);
    steel.bar({kRackX[1] + 0.09, y - 0.02, kLower - 0.45}, {kRackX[2] - 0.09, y - 0.02, 0.35}, 0.012, 0.07);
  }
}

// Depth below a pipe's axis at which an open block of this half width may end without showing its inside, for any
// detail of the pipe.
double hidden_in(double pipe_radius, double half_width) {
  return 0.8 * std::sqrt(pipe_radius * pipe_radius - half_width * half_width);
}

// A block between beam and pipe.
void Plant::shoe(Shaper& shaper, const dvec3& pipe, double radius, double beam_top) {
  shaper.box({pipe.x - 0.05, pipe.y - 0.025, beam_top + 0.001},
             {pipe.x + 0.05, pipe.y + 0.025, pipe.z - hidden_in(radius, 0.025)}, kBottom | kTop);
}

// A post from the ground to the underside of a pipe.
void Plant::support(Shaper& shaper, const dvec3& under, double pipe_radius) {
  const double top = under.z - hidden_in(pipe_radius, 0.035);
  shaper.box({under.x - 0.1, under.y - 0.1, 0}, {under.x + 0.1, under.y + 0.1, 0.02}, kBottom);
  shaper.box({under.x - 0.035, under.y - 0.035, 0.02}, {under.x + 0.035, under.y + 0.035, top}, kBottom | kTop);
}

void Plant::rack_piping() {
  Shaper& shoes = part("pipe-shoes", kSteel);
  const auto on = [](double level, double radius) { return level + 0.06 + radius; };
  const auto shoes_under = [&](double y, double radius, double level) {
    for (const double x : kRackX) shoe(shoes, {x, y, on(level, radius)}, radius, level);
  };
  struct Line {
    const char* name;
    Colour colour;
    double y, radius, level;
    std::vector<dvec3> west, east;  // runs beyond the rack's ends; the level run lies between
    PipeOptions options;
  };
  const double end_west = -1.95, end_east = 7.15;
  const double z1 = on(kLower, 0.09), z2 = on(kLower, 0.08), z3 = on(kLower, 0.06), z5 = on(kUpper, 0.05),
               z4 = on(kLower, 0.05);
  const double tank_face = kTankX + kTankRadius - 0.02;
  const Line lines[] = {
      {"pipe-feed-2",
       kWater,
       0.395,
       0.09,
       kLower,
       {{tank_face, 1.4, 1.8}, {-3.55, 1.4, 1.8}, {-3.55, 0.395, 1.8}, {-2.1, 0.395, 1.8}, {-2.1, 0.395, z1}},
       {},
       {.blind_end = true, .valves = {{0, 0.55}}}},
      {"pipe-feed-1",
       kWater,
       0.735,
       0.08,
       kLower,
       {{tank_face, 4.7, 1.55}, {-2.5, 4.7, 1.55}, {-2.5, 0.735, 1.55}, {-2.5, 0.735, z2}},
       {},
       {.blind_end = true, .valves = {{0, 0.45}}}},
      {"pipe-feed-3",
       kWater,
       -0.78,
       0.06,
       kLower,
       {{tank_face, -1.9, 1.3}, {-2.3, -1.9, 1.3}, {-2.3, -0.78, 1.3}, {-2.3, -0.78, z3}},
       {},
       {.blind_end = true, .valves = {{0, 0.45}}}},
      {"pipe-product", kProduct, -0.49, 0.08, kLower, {}, {}, {.blind_start = true, .blind_end = true}},
      {"pipe-water", kWater, -0.17, 0.08, kLower, {}, {}, {.blind_start = true, .blind_end = true}},
      {"pipe-drum-feed",
       kProduct,
       0.105,
       0.05,
       kLower,
       {},
       {{7.22, 0.105, z4}, {7.22, 5.2, z4}, {7.22, 5.2, 2.1}, {6.23, 5.2, 2.1}},
       {.blind_start = true, .valves = {{1, 0.25}}}},
      {"pipe-reactor-feed",
       kProduct,
       -0.7,
       0.05,
       kUpper,
       {{-4.75, -5.07, 3.65}, {-4.75, -4.75, 3.65}, {-2.05, -4.75, 3.65}, {-2.05, -0.7, 3.65}, {-2.05, -0.7, z5}},
       {},
       {.flange_at_start = false, .blind_end = true, .valves = {{2, 0.3}}}},
      {"pipe-steam", kSteam, -0.35, 0.09, kUpper, {}, {}, {.blind_start = true, .blind_end = true}},
  };
  for (const Line& line : lines) {
    std::vector<dvec3> route = line.west;
    const double z = on(line.level, line.radius);
    if (line.west.empty()) route.push_back({end_west, line.y, z});
    if (line.east.empty()) route.push_back({end_east, line.y, z});
    route.insert(route.end(), line.east.begin(), line.east.end());
    add_pipe(part(line.name, line.colour), route, line.radius, line.options);
    shoes_under(line.y, line.radius, line.level);
  }
}

void Plant::drain_piping() {
  Shaper &header = part("pipe-drain-header", kWater), &posts = part("pipe-supports", kSteel);
  add_pipe(header,
           {{3.9, 5.2, 1.22},
            {3.9, 5.2, kHeaderZ},
            {3.9, kHeaderNorth, kHeaderZ},
            {kHeaderX, kHeaderNorth, kHeaderZ},
            {kHeaderX, kHeaderSouth, kHeaderZ},
            {6.1, kHeaderSouth, kHeaderZ}},
           0.1, {.flange_at_start = false, .blind_end = true, .valves = {{2, 0.2}, {3, 0.93}}});
  for (const double x : {2.9, 0.2, -2.4, -5.0}) support(posts, {x, kHeaderNorth, kHeaderZ}, 0.1);
  support(posts, {7.22, 2.6, kLower + 0.06 + 0.05}, 0.05);
  for (const double y : {5.7, 3.1, -0.3, -3.4, -5.6}) support(posts, {kHeaderX, y, kHeaderZ}, 0.1);
  for (const double x : {-6.2, -3.2, -0.6, 2.3, 4.5}) support(posts, {x, kHeaderSouth, kHeaderZ}, 0.1);
  for (int i = 0; i < 3; ++i)
    add_pipe(part("pipe-drain-" + std::to_string(i + 1), kWater),
             {{kTankX, kTankY[i], 0.70}, {kTankX, kTankY[i], kHeaderZ}, {kHeaderX + 0.08, kTankY[i], kHeaderZ}}, 0.06,
             {.flange_at_start = false, .flange_at_end = false, .valves = {{1, 0.55}}});
}

void Plant::pump_piping() {
  for (int i = 0; i < 3; ++i) {
    const std::string number = std::to_string(i + 1);
    add_pipe(part("pipe-suction-" + number, kWater),
             {{kPumpX[i], kHeaderSouth + 0.08, kHeaderZ}, {kPumpX[i], kSuctionY + 0.001, kHeaderZ}}, 0.07,
             {.flange_at_start = false, .valves = {{0, 0.45}}});
    add_pipe(part("pipe-discharge-" + number, kWater),
             {{kPumpX[i], kSuctionY + 0.3, 0.899}, {kPumpX[i], kSuctionY + 0.3, 3.03}}, 0.06,
             {.flange_at_end = false, .valves = {{0, 0.24}}});
  }
  const double y = kSuctionY + 0.3;
  Shaper& header = part("pipe-discharge-header", kWater);
  add_pipe(header, {{5.9, y, 3.1}, {0.75, y, 3.1}, {0.75, -0.17, 3.1}, {0.75, -0.17, kLower + 0.06 + 0.16 - 0.02}}, 0.1,
           {.flange_at_end = false, .blind_start = true});
  Shaper& posts = part("pipe-discharge-posts", kSteel);
  for (const double x : {2.35, 4.45}) {
    add_column(posts, {x, y, 0}, 2.9, 0.14);
    posts.box({x - 0.06, y - 0.05, 2.901}, {x + 0.06, y + 0.05, 3.02}, kBottom | kTop);
  }
  add_column(posts, {0.75, -3.4, 0}, 2.9, 0.14);
  posts.box({0.7, -3.46, 2.901}, {0.8, -3.34, 3.02}, kBottom | kTop);
}

void Plant::vapour_piping() {
  const double upper = kUpper + 0.06;
  Shaper& header = part("pipe-vapour", kGas);
  add_pipe(header,
           {{-4.7, 4.95, 4.2},
            {-4.7, 0.45, 4.2},
            {-1.95, 0.45, 4.2},
            {-1.95, 0.45, upper + 0.09},
            {7.15, 0.45, upper + 0.09}},
           0.09, {.blind_start = true, .blind_end = true});
  Shaper& shoes = part("pipe-vapour-shoes", kSteel);
  for (const double x : kRackX) shoe(shoes, {x, 0.45, upper + 0.09}, 0.09, kUpper);
  for (int i = 0; i < 2; ++i)
    add_pipe(part("pipe-vapour-" + std::to_string(i + 1), kGas),
             {{kTankX, kTankY[i], 3.86}, {kTankX, kTankY[i], 4.2}, {-4.77, kTankY[i], 4.2}}, 0.06,
             {.flange_at_end = false});
  add_pipe(part("pipe-vapour-3", kGas), {{kTankX, kTankY[2], 3.86}, {kTankX, kTankY[2], 4.38}}, 0.06,
           {.blind_end = true});
  add_pipe(part("pipe-drum-vapour", kGas),
           {{3.0, 5.2, 2.98}, {3.0, 5.2, 3.75}, {3.0, 0.05, 3.75}, {3.0, 0.05, upper + 0.11}}, 0.06,
           {.flange_at_end = false, .valves = {{1, 0.12}}});
  add_pipe(part("pipe-condensate", kSteam), {{-1.95, 0.05, upper + 0.06}, {7.15, 0.05, upper + 0.06}}, 0.06,
           {.blind_start = true, .blind_end = true});
  for (const double x : kRackX) shoe(shoes, {x, 0.05, upper + 0.06}, 0.06, kUpper);
  add_pipe(part("pipe-relief", kGas), {{5.3, 5.2, 2.98}, {5.3, 5.2, 4.48}}, 0.05,
           {.flange_at_end = false, .blind_end = true, .valves = {{0, 0.4}}});
  Shaper& exchanger_lines = part("pipe-exchangers", kProduct);
  add_pipe(exchanger_lines,
           {{3.2, -3.0, 2.17}, {3.2, -3.0, 3.1}, {3.2, -0.49, 3.1}, {3.2, -0.49, kLower + 0.06 + 0.15}}, 0.07,
           {.flange_at_end = false});
  for (const double x : {3.6, 4.4})
    add_pipe(exchanger_lines, {{x, -3.0, 1.16}, {x, -3.0, 1.54}}, 0.07,
             {.flange_at_start = false, .flange_at_end = false, .flange_every_m = 0.2});
  add_pipe(exchanger_lines, {{6.2, -3.0, 2.17}, {6.2, -3.0, 3.84}, {6.2, -0.35, 3.84}, {6.2, -0.35, upper + 0.16}},
           0.07, {.flange_at_end = false, .valves = {{1, 0.45}}});
  add_pipe(exchanger_lines, {{6.1, -3.32, 0.85}, {6.1, -3.75, 0.85}, {6.1, -3.75, 0.3}, {6.9, -3.75, 0.3}}, 0.05,
           {.blind_end = true});
}

void Plant::platforms() {
  const Deck north = deck_north(grating_);
  const double foot = 0.18 + 0.03;  // under deck and edge channel
  Shaper &west = part("platform-west", kDeckColour), &west_columns = part("platform-west-columns", kSteel);
  add_deck(west, kDeckWest);
  for (const double y : {-0.9, 2.2, 5.7})
    for (const double x : {-4.3, -2.8}) add_column(west_columns, {x, y, 0}, kDeckWest.z - foot + 0.028, 0.12);
  Shaper &south = part("platform-south", kDeckColour), &south_columns = part("platform-south-columns", kSteel);
  add_deck(south, kDeckSouth);
  for (const double x : {-6.8, -4.75, -2.8})
    for (const double y : {-6.66, -4.3}) add_column(south_columns, {x, y, 0}, kDeckSouth.z - foot + 0.028, 0.12);
  Shaper &top = part("platform-north", grating_ ? kZinc : kDeckColour),
         &top_columns = part("platform-north-columns", kSteel);
  add_deck(top, north);
  for (const double x : {1.7, 3.9, 6.1})
    for (const double y : {2.8, 4.0}) add_column(top_columns, {x, y, 0}, north.z - foot + 0.028, 0.12);

  constexpr double kInset = 0.03;
  const double w = kDeckWest.z, e = kDeckWest.x1 - kInset, n = kDeckWest.y1 - kInset, i = kDeckWest.x0 + kInset;
  Shaper& west_rails = part("railing-west", kYellow);
  add_railing(west_rails, {{e, -4.15, w}, {e, n, w}, {-3.2, n, w}});  // the gap to the west leads to the ladder
  add_railing(west_rails, {{-3.85, n, w}, {i, n, w}, {i, 5.25, w}});
  add_railing(west_rails, {{i, 4.15, w}, {i, 1.95, w}});
  add_railing(west_rails, {{i, 0.85, w}, {i, -1.35, w}});
  add_railing(west_rails, {{i, -2.45, w}, {i, -4.15, w}});
  const double s = kDeckSouth.z, se = kDeckSouth.x1 - kInset, ss = kDeckSouth.y0 + kInset, sw = kDeckSouth.x0 + kInset,
               sn = kDeckSouth.y1 - kInset;
  Shaper& south_rails = part("railing-south", kYellow);
  add_railing(south_rails, {{se, -4.3, s}, {se, -5.27, s}});
  add_railing(south_rails, {{se, -6.33, s}, {se, ss, s}, {sw, ss, s}, {sw, sn, s}, {-4.5, sn, s}});
  const double ne = north.x1 - kInset, nn = north.y1 - kInset, nw = north.x0 + kInset, ns = north.y0 + kInset,
               nz = north.z;
  Shaper& north_rails = part("railing-north", kYellow);
  add_railing(north_rails, {{nw, 2.88, nz}, {nw, ns, nz}, {ne, ns, nz}, {ne, 3.08, nz}});
  add_railing(north_rails, {{ne, 3.72, nz}, {ne, nn, nz}, {nw, nn, nz}, {nw, 3.92, nz}});

  Shaper &stairs_south = part("stairs-south", kSteel), &stairs_south_rails = part("stairs-south-railing", kYellow);
  add_stairs(stairs_south, stairs_south_rails, {0.25, -5.8, 0}, {kDeckSouth.x1, -5.8, kDeckSouth.z}, 1.0);
  Shaper &stairs_north = part("stairs-north", kSteel), &stairs_north_rails = part("stairs-north-railing", kYellow);
  add_stairs(stairs_north, stairs_north_rails, {-1.1, 3.4, 0}, {north.x0, 3.4, north.z}, 0.95);
  add_ladder(part("ladder-west", kYellow), {-3.525, kDeckWest.y1 + 0.04, 0}, {0, 1, 0}, kDeckWest.z + 1.1);
  add_ladder(part("ladder-north", kYellow), {north.x1 + 0.04, 3.4, 0}, {1, 0, 0}, north.z + 1.1);
  add_ladder(part("ladder-tank-2", kYellow), {kTankX, kTankY[1] - kTankRadius - 0.1, 0}, {0, -1, 0}, 3.15);
}

void Plant::electrical() {
  Shaper& cabinets = part("cabinets", kCabinet);
  add_cabinet(cabinets, {6.7, -5.45, 0}, {7.4, -4.65, 1.9});
  add_cabinet(cabinets, {6.7, -4.63, 0}, {7.4, -4.03, 1.9});
  Shaper &tray = part("cable-tray", kZinc), &cables = part("cables", kBlack);
  const double z = kRackTop + 0.03;
  add_cable_tray(tray, cables, {-1.75, -0.85, z}, {6.88, -0.85, z}, 0.3);
  add_cable_tray(tray, cables, {7.05, -0.68, z}, {7.05, -4.5, z}, 0.3);
  add_cable_tray(tray, cables, {7.1, -4.66, z - 0.02}, {7.1, -4.66, 1.902}, 0.3);
  Shaper& boxes = part("pump-stations", kCabinet);  // local switches at the pumps
  for (const double x : kPumpX) {
    boxes.box({x + 0.42, -4.56, 0}, {x + 0.46, -4.52, 1.15}, kBottom);
    boxes.box({x + 0.36, -4.52, 0.95}, {x + 0.52, -4.42, 1.25});
  }
}

}  // namespace

Model industrial(std::size_t triangles) {
  constexpr std::size_t kFewest = 20'000, kFewestOnGround = 1'250, kGratingFrom = 200'000;
  if (triangles < kFewest)
    throw Error(Errc::invalid_argument, "the industrial site needs at least " + std::to_string(kFewest) +
                                            " triangles; " + std::to_string(triangles) + " were asked for");
  const std::size_t for_plant = triangles - std::max(kFewestOnGround, triangles / 12);
  const bool grating = triangles >= kGratingFrom;
  // The finest detail whose plant fits; the ground takes the remaining triangles.
  double coarse = 0.03, fine = 1e-8;
  for (int i = 0; i < 60; ++i) {
    const double middle = std::sqrt(coarse * fine);
    if (Plant({middle}, true, grating).triangles() <= for_plant)
      coarse = middle;
    else
      fine = middle;
  }
  Plant plant({coarse}, false, grating);
  Model model;
  model.parts = plant.take();
  std::size_t used = 0;
  for (const Part& part : model.parts) used += part.mesh.triangles();
  model.parts.push_back({"ground",
                         Role::blocking,
                         {},
                         kGroundColour,
                         ground_mesh(triangles - std::min(used, triangles - kFewestOnGround))});
  model.parts.push_back({"search-area",
                         Role::search,
                         {},
                         kGroundColour,
                         search_mesh({{kDeckSouth, 6, 5, 1.035, 0.05},
                                      {kDeckWest, 2, 12, 1.035, 0.15},
                                      {Plant::deck_north(grating), 7, 3, 1.035, 0.45}})});
  model.defaults = to_json({.step = 0.0286, .height = 1.85, .noise = "rtc360", .spacing = 0.005, .user_size = 0.01});
  return model;
}

}  // namespace vantage::built_in
