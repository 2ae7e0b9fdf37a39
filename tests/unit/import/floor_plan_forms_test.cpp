// SPDX-License-Identifier: Apache-2.0
// One room or two, drawn by each form of entity that DXF has: the importer reads it all, or reports the loss.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "drawing.hpp"
#include "import_fixture.hpp"
#include "vantage/scene.hpp"

namespace vantage::test {
namespace {

class FloorPlanFormsTest : public ImportTest {
 protected:
  Scene load(const DrawingText& drawing, const SceneOptions& options = {}) const {
    return Scene::load(write("plan.dxf", drawing.str()), options);
  }
  // Areas of named rooms in cm², by their names; the outline of each holds no more than its floor.
  std::map<std::string, long> rooms_of(const Scene& scene) const {
    std::map<std::string, long> rooms;
    for (const Room& room : scene.rooms()) rooms[room.name] = std::lround(1e4 * floor_area(room));
    return rooms;
  }
  std::string notes_of(const Scene& scene) const {
    std::string all;
    for (const std::string& note : scene.notes()) all += note + "\n";
    return all;
  }
  using Rooms = std::map<std::string, long>;

  void expect_rooms(const char* what, const DrawingText& drawing, const Rooms& wanted, long within = 20,
                    const std::string& note = {}) const {
    const Scene scene = load(drawing);
    const Rooms rooms = rooms_of(scene);
    EXPECT_EQ(rooms.size(), wanted.size()) << what << '\n' << notes_of(scene);
    for (const auto& [name, area] : wanted) {
      const auto found = rooms.find(name);
      ASSERT_NE(found, rooms.end()) << what << ": no room " << name << '\n' << notes_of(scene);
      EXPECT_NEAR(static_cast<double>(found->second), static_cast<double>(area), static_cast<double>(within))
          << what << ": " << name << '\n'
          << notes_of(scene);
    }
    EXPECT_NE(notes_of(scene).find(note), std::string::npos) << what << ": " << note << " is not in\n"
                                                             << notes_of(scene);
  }
};

constexpr const char* kWall = "A-WALL";

// Walls of 0.2 m around 6 × 4 m from (0, 0), with a door in the south wall, and names at (1.5, 2) and (5.4, 2).
DrawingText room(int unit = 6, double scale = 1, double east = 0, double north = 0) {
  DrawingText d(unit, scale, east, north);
  for (const auto& [layer, colour, flags] :
       {std::tuple(kWall, 7, 0), std::tuple("OFF", -7, 0), std::tuple("FROZEN", 7, 1)})
    d.layer(layer, colour, flags);
  d.layer("SCREEN", 7, 0, false);
  d.line(kWall, 2.8, 0, 0, 0), d.line(kWall, 0, 0, 0, 4), d.line(kWall, 0, 4, 6, 4), d.line(kWall, 6, 4, 6, 0);
  d.line(kWall, 6, 0, 3.7, 0), d.line(kWall, 3.7, 0, 3.7, -0.2), d.line(kWall, 2.8, 0, 2.8, -0.2);
  d.line(kWall, 2.8, -0.2, -0.2, -0.2), d.line(kWall, -0.2, -0.2, -0.2, 4.2), d.line(kWall, -0.2, 4.2, 6.2, 4.2);
  d.line(kWall, 6.2, 4.2, 6.2, -0.2), d.line(kWall, 6.2, -0.2, 3.7, -0.2);
  d.arc("A-DOOR", 2.8, 0, 0.9, 0, 90), d.line("A-DOOR", 2.8, 0, 2.8, 0.9);
  d.text("A-TEXT", 1.5, 2, "West"), d.text("A-TEXT", 5, 2, "East");
  return d;
}
const std::map<std::string, long> kOne{{"West / East", 240'000}};
// Both sides of a wall of 0.1 m from (4.4, 0) to (4.4, 4) and (4.5, 0) to (4.5, 4).
const std::map<std::string, long> kTwo{{"West", 176'000}, {"East", 60'000}};

TEST_F(FloorPlanFormsTest, NothingMoreIsOneRoom) {
  const Scene scene = load(room());
  ASSERT_EQ(scene.rooms().size(), 1u);
  EXPECT_NEAR(floor_area(scene.rooms()[0]), 24, 1e-3);
  EXPECT_EQ(notes_of(scene).find("left out"), std::string::npos) << notes_of(scene);
  EXPECT_EQ(notes_of(scene).find("no part of"), std::string::npos) << notes_of(scene);
}

TEST_F(FloorPlanFormsTest, EveryFormOfAWallParts) {
  using Draw = std::function<void(DrawingText&)>;
  const DrawingText::Points both{{4.4, 0}, {4.5, 0}, {4.5, 4}, {4.4, 4}};
  const std::vector<DrawingText::Vertex> corners{{4.4, 0}, {4.5, 0}, {4.5, 4}, {4.4, 4}};
  const std::pair<const char*, Draw> forms[]{
      {"LINE", [](DrawingText& d) { d.line(kWall, 4.4, 0, 4.4, 4), d.line(kWall, 4.5, 4, 4.5, 0); }},
      {"LWPOLYLINE", [&](DrawingText& d) { d.polyline(kWall, both); }},
      {"POLYLINE", [&](DrawingText& d) { d.old_polyline(kWall, corners, true); }},
      {"POLYLINE in space", [&](DrawingText& d) { d.old_polyline(kWall, corners, true, true); }},
      {"open POLYLINE",
       [](DrawingText& d) {
         d.old_polyline(kWall, {{4.4, 0}, {4.4, 1}, {4.4, 4}}, false);
         d.old_polyline(kWall, {{4.5, 0}, {4.5, 4}}, false, true);
       }},
      {"wide polyline",
       [](DrawingText& d) {
         d.polyline(kWall, {{4.45, 0}, {4.45, 4}}, false, 0.1);
       }},
      {"SOLID", [](DrawingText& d) { d.solid(kWall, 4.4, 0, 4.5, 4); }},
      {"polyface mesh",
       [&](DrawingText& d) {
         d.faces(kWall, both, {{1, 2, -3}, {3, 4, -1}});
       }},
      {"MLINE", [](DrawingText& d) { d.multiline(kWall, 4.45, 0, 4.45, 4, 0.1); }},
      {"HATCH with seeds", [&](DrawingText& d) { d.hatch(kWall, {both}, {.seeds = 3}); }},
      {"HATCH of edges",
       [&](DrawingText& d) { d.hatch(kWall, {both}, {.boundary = DrawingText::Boundary::edges, .seeds = 1}); }},
      {"block, by another case, nested",
       [](DrawingText& d) {
         d.begin_block("Inner", 1, 1);
         d.line("0", 1, 1, 3, 1), d.line("0", 1, 2, 3, 2);
         d.end_block();
         d.begin_block("outer");
         d.insert("0", "INNER", 0, 0);
         d.end_block();
         d.insert(kWall, "OUTER", 4.5, 0, 2, 0.1, 90);
       }},
      {"MINSERT",
       [](DrawingText& d) {
         d.begin_block("piece");
         d.rectangle(kWall, 0, 0, 0.1, 1);
         d.end_block();
         d.insert(kWall, "piece", 4.4, 0, 1, 1, 0, {1, 4, 0, 1});
       }},
      {"mirrored INSERT",
       [](DrawingText& d) {
         d.begin_block("half");
         d.line(kWall, -1, 0, -1, 2), d.line(kWall, -1.1, 0, -1.1, 2);
         d.end_block();
         d.insert("0", "half", 3.4, 0, -1, 1);
         d.insert("0", "half", 3.4, 4, -1, -1);
       }},
  };
  for (const bool below : {false, true})
    for (const auto& [what, draw] : forms) {
      DrawingText d = room();
      d.look({.below = below});
      draw(d);
      expect_rooms(what, d, kTwo);
    }
}

TEST_F(FloorPlanFormsTest, WhatDoesNotShowIsLeftOutAndTold) {
  const auto wall = [](DrawingText& d, const char* layer) {
    d.line(layer, 4.4, 0, 4.4, 4), d.line(layer, 4.5, 0, 4.5, 4);
  };
  DrawingText invisible = room();
  invisible.look({.invisible = true});
  wall(invisible, kWall);
  expect_rooms("group 60", invisible, kOne, 20, "invisible, left out (A-WALL: 2 LINE)");
  DrawingText sheet = room();
  sheet.look({.on_sheet = true});
  wall(sheet, kWall);
  expect_rooms("paper space", sheet, kOne, 20, "on sheets (paper space), left out (A-WALL: 2 LINE)");
  for (const char* hidden : {"OFF", "FROZEN"}) {
    DrawingText own = room();
    wall(own, hidden);
    expect_rooms(hidden, own, kOne, 20,
                 "on layers that are off or frozen, left out (" + std::string(hidden) + ": 2 LINE)");
    // Content on layer 0 is on the layer of its block; other content shows unless that is frozen.
    for (const char* layer : {"0", kWall}) {
      DrawingText block = room();
      block.begin_block("part");
      wall(block, layer);
      block.end_block();
      block.insert(hidden, "PART", 0, 0);
      const bool shows = layer == kWall && std::string_view(hidden) == "OFF";
      expect_rooms(hidden, block, shows ? kTwo : kOne, 20, shows ? "" : "off or frozen, left out (");
    }
  }
  DrawingText screen = room();
  screen.begin_block("part");
  wall(screen, "0");
  screen.end_block();
  wall(screen, "SCREEN");
  expect_rooms("not plotted, no layer of walls", screen, kOne, 20, "or stairs (SCREEN: 2 LINE)");
}

TEST_F(FloorPlanFormsTest, WhatIsNotReadIsTold) {
  DrawingText d = room();
  d.raw("REGION", kWall), d.raw("REGION", kWall), d.raw("DIMENSION", "A-DIM"), d.insert(kWall, "elsewhere", 0, 0);
  d.circle("GRID", 2, 2, 0.5);
  d.raw("LINE", kWall, "39\n3.2\n10\n-0.2\n20\n-0.2\n11\n1\n21\n-0.2\n");
  const Scene scene = load(d);
  for (const char* note : {"not read (A-DIM: 1 DIMENSION; A-WALL: 2 REGION)",
                           "blocks and external references that the file does not hold (A-WALL: 1 INSERT of elsewhere)",
                           "no part of walls, doors, windows, furniture or stairs (GRID: 1 CIRCLE)",
                           "1 line with a thickness, mostly of 3.20 m, raised like the others"})
    EXPECT_NE(notes_of(scene).find(note), std::string::npos) << note << " is not in\n" << notes_of(scene);
}

TEST_F(FloorPlanFormsTest, ColumnsAreAsRoundAsTheyAreDrawn) {
  constexpr double kPi = std::numbers::pi;
  const auto less = [](double area) { return Rooms{{"West / East", std::lround(1e4 * (24 - area))}}; };
  for (const bool below : {false, true}) {
    DrawingText circle = room(), spline = room(), ellipse = room(), bulges = room(), block = room();
    for (DrawingText* d : {&circle, &spline, &ellipse, &bulges, &block}) d->look({.below = below});
    circle.circle(kWall, 3, 2.5, 0.25);
    expect_rooms("CIRCLE", circle, less(kPi / 16), 80);
    spline.round_spline(kWall, 3, 2.5, 0.25);
    expect_rooms("SPLINE", spline, less(kPi / 16), 80);
    ellipse.ellipse(kWall, 3, 2.5, 0.3, 0.4, 0.5);
    expect_rooms("ELLIPSE", ellipse, less(kPi * 0.125), 80);
    bulges.old_polyline(kWall, {{2.75, 2.5, 1}, {3.25, 2.5, 1}}, true);
    expect_rooms("bulges", bulges, less(kPi / 16), 80);
    block.begin_block("column");
    block.circle(kWall, 0, 0, 1);
    block.end_block();
    block.insert(kWall, "Column", 3, 2.5, 0.5, 0.25, 30);
    expect_rooms("CIRCLE, scaled unequally", block, less(kPi / 8), 80);
  }
}

TEST_F(FloorPlanFormsTest, IslandsOfHatchesAreHoles) {
  const DrawingText::Points outer{{4, 1}, {6, 1}, {6, 3}, {4, 3}},
      inner{{4.5, 1.5}, {5.5, 1.5}, {5.5, 2.5}, {4.5, 2.5}}, inmost{{4.9, 1.9}, {5.1, 1.9}, {5.1, 2.1}, {4.9, 2.1}};
  const auto drawn = [&](const DrawingText::Hatch& hatch) {
    DrawingText d(6);
    d.rectangle(kWall, -0.1, -0.1, 8.1, 4.1), d.rectangle(kWall, 0, 0, 8, 4);
    d.arc("A-DOOR", 1, 0, 0.9, 0, 90), d.text("A-TEXT", 1, 2, "Hall"), d.text("A-TEXT", 4.6, 1.6, "Core");
    d.hatch(kWall, {outer, inmost, inner}, hatch);
    return d;
  };
  expect_rooms("odd", drawn({}), {{"Hall", 280'000}, {"Core", 9'600}});
  expect_rooms("outermost", drawn({.style = 1}), {{"Hall", 280'000}, {"Core", 10'000}});
  expect_rooms("all", drawn({.style = 2}), {{"Hall", 280'000}});
  expect_rooms("around texts", drawn({.flags = {1, 8, 8}}), {{"Hall", 280'000}});
}

TEST_F(FloorPlanFormsTest, TextsAreWhereTheyShow) {
  DrawingText d(6);
  d.rectangle(kWall, -0.1, -0.1, 8.1, 4.1), d.rectangle(kWall, 0, 0, 8, 4), d.rectangle(kWall, 4, 0, 4.1, 4);
  d.arc("A-DOOR", 1, 0, 0.9, 0, 90);
  d.look({.below = true});
  d.text("A-TEXT", 1, 2, "Office");
  d.begin_block("tag");
  d.text("0", 0, 0, "Store");
  d.end_block();
  d.insert("A-TEXT", "TAG", 5, 2);
  expect_rooms("seen from below", d, {{"Office", 160'000}, {"Store", 156'000}});
}

TEST_F(FloorPlanFormsTest, WhatIsDrawnTwiceCountsOnce) {
  DrawingText d = room();
  d.line(kWall, 2.8, 0, 0, 0), d.text("A-TEXT", 1.5, 2, "West"), d.text("A-TEXT", 5.01, 1.99, "East");
  expect_rooms("lines, names and a shadow", d, kOne, 0);
}

TEST_F(FloorPlanFormsTest, WallsThatMissEachOtherByCentimetresAreJoined) {
  for (const double miss : {0.001, 0.01, 0.04, 0.049}) {
    const std::string what = std::to_string(miss);
    DrawingText ends = room();
    ends.rectangle(kWall, 4.4, 0, 4.5, 4 - miss);
    expect_rooms(("ends drawn, " + what).c_str(), ends, kTwo, 20, "cm between walls filled (5 cm at most)");
    DrawingText open = room();
    open.line(kWall, 4.4, miss / 2, 4.4, 4 - miss), open.line(kWall, 4.5, 0, 4.5, 4 - miss);
    expect_rooms(("open ends, " + what).c_str(), open, kTwo, 20, "cm at most)");
    DrawingText single = room();
    single.line(kWall, 4.45, miss, 4.45, 4 - miss);
    expect_rooms(("single line, " + what).c_str(), single, kTwo, 20, "joined to what they missed");
    DrawingText halves = room();
    halves.solid(kWall, 4.4, 0, 4.5, 2), halves.solid(kWall, 4.4, 2 + miss, 4.5, 4);
    expect_rooms(("two halves, " + what).c_str(), halves, kTwo, 20, "1 gap of up to");
  }
  DrawingText corners(6);
  for (const double out : {0.0, 0.2}) {  // each side stops short of its corners
    const double low = -out, right = 6 + out, top = 4 + out;
    corners.line(kWall, low + 0.04, low, right - 0.02, low), corners.line(kWall, right, low, right, top - 0.04);
    corners.line(kWall, right - 0.01, top, low, top), corners.line(kWall, low, top - 0.02, low, low + 0.02);
  }
  corners.arc("A-DOOR", 2.8, 0, 0.9, 0, 90), corners.text("A-TEXT", 1.5, 2, "West");
  expect_rooms("corners", corners, {{"West", 240'000}}, 20, "ends of wall lines joined to what they missed");
  DrawingText open = room();  // a door's place
  open.rectangle(kWall, 4.4, 0, 4.5, 3.1);
  EXPECT_NE(notes_of(load(open)).find("1 door and 1 passage"), std::string::npos) << notes_of(load(open));
}

TEST_F(FloorPlanFormsTest, WallsEndAtTheFacesOfWidePolylines) {
  for (const double wide : {0.06, 0.1, 0.3})
    for (const double miss : {0.0, 0.027}) {  // at its north end
      const auto outer = [&] {
        DrawingText d(6);
        const double h = wide / 2;
        d.polyline(kWall, {{-h, -h}, {6 + h, -h}, {6 + h, 4 + h}, {-h, 4 + h}}, true, wide);
        d.arc("A-DOOR", 2.8, 0, 0.9, 0, 90), d.line("A-DOOR", 2.8, 0, 2.8, 0.9);
        d.text("A-TEXT", 1.5, 2, "West"), d.text("A-TEXT", 5, 2, "East");
        return d;
      };
      const std::string what = std::to_string(wide) + ", " + std::to_string(miss);
      DrawingText lines = outer();
      lines.line(kWall, 4.4, 0, 4.4, 4 - miss), lines.line(kWall, 4.5, 0, 4.5, 4 - miss);
      expect_rooms(("two lines, " + what).c_str(), lines, kTwo);
      DrawingText middle = outer();  // into the middle of the wall
      for (const double x : {4.4, 4.5}) middle.line(kWall, x, -wide / 2, x, 4 - miss);
      expect_rooms(("to the middle, " + what).c_str(), middle, kTwo);
      DrawingText single = outer();
      single.line(kWall, 4.45, 0, 4.45, 4 - miss);
      expect_rooms(("one line, " + what).c_str(), single, kTwo);
    }
}

TEST_F(FloorPlanFormsTest, SingleLinesAreWallsFromWallToWall) {
  DrawingText straight = room();
  straight.line(kWall, 4.45, 0, 4.45, 4);
  expect_rooms("straight", straight, kTwo);
  DrawingText slanted = room();  // from (4, 0) to (4.9, 4): as much is left of its middle
  slanted.line(kWall, 4, 0, 4.9, 4);
  const double loss = 0.1 * std::hypot(0.9, 4) / 2;
  expect_rooms("slanted", slanted,
               {{"West", std::lround(1e4 * (17.8 - loss))}, {"East", std::lround(1e4 * (6.2 - loss))}}, 60);
  DrawingText corner = room();  // around a corner of the room, with a T
  corner.line(kWall, 4.45, 4, 4.45, 2.8), corner.line(kWall, 4.45, 2.8, 6, 2.8), corner.line(kWall, 4.45, 2.8, 4.45, 0);
  corner.text("A-TEXT", 5, 3.5, "Attic");
  expect_rooms("T", corner, {{"West", 176'000}, {"East", 41'250}, {"Attic", 17'250}});
  DrawingText all(6);
  all.rectangle(kWall, 0, 0, 6, 4);
  all.arc("A-DOOR", 2, 0, 0.9, 0, 90), all.line(kWall, 4, 0, 4, 1), all.line(kWall, 4, 1.9, 4, 4);
  all.text("A-TEXT", 1, 2, "West"), all.text("A-TEXT", 4.5, 2, "East");
  expect_rooms("all", all, {{"West", 152'100}, {"East", 74'100}}, 20, "1 door and 1 passage");
}

TEST_F(FloorPlanFormsTest, JambsMayHaveSeveralLines) {
  using Points = DrawingText::Points;
  // The end of the partition's south part, from its east side to its west side, and the begin of its north part.
  const std::pair<const char*, std::pair<Points, Points>> jambs[]{
      {"in pieces", {{{4.5, 1}, {4.47, 1}, {4.43, 1}, {4.4, 1}}, {{4.4, 1.9}, {4.44, 1.9}, {4.5, 1.9}}}},
      {"with a rebate",
       {{{4.5, 1}, {4.46, 1}, {4.46, 0.97}, {4.4, 0.97}}, {{4.4, 1.93}, {4.46, 1.93}, {4.46, 1.9}, {4.5, 1.9}}}},
      {"with a frame",
       {{{4.5, 0.95}, {4.52, 0.95}, {4.52, 1}, {4.38, 1}, {4.38, 0.95}, {4.4, 0.95}},
        {{4.4, 1.95}, {4.38, 1.95}, {4.38, 1.9}, {4.52, 1.9}, {4.52, 1.95}, {4.5, 1.95}}}}};
  for (const auto& [what, ends] : jambs) {
    DrawingText d = room();
    Points south{{4.5, 0}}, north{{4.4, 4}};
    south.insert(south.end(), ends.first.begin(), ends.first.end()), south.emplace_back(4.4, 0);
    north.insert(north.end(), ends.second.begin(), ends.second.end()), north.emplace_back(4.5, 4);
    d.polyline(kWall, south, false), d.polyline(kWall, north, false);
    expect_rooms(what, d, kTwo, 400, "1 door and 1 passage");
  }
}

TEST_F(FloorPlanFormsTest, MillimetresAtNationalCoordinatesKeepTheirPlace) {
  const Scene scene = load(room(4, 1000, 500'000, 5'400'000));
  ASSERT_EQ(scene.rooms().size(), 1u);
  EXPECT_NEAR(floor_area(scene.rooms()[0]), 24, 1e-3);
  EXPECT_NEAR(scene.rooms()[0].box.min.x, 500'000, 1e-3);
  EXPECT_NEAR(scene.rooms()[0].box.min.y, 5'400'000, 1e-3);
}

// An exploded hatch on the layer of walls.
TEST_F(FloorPlanFormsTest, ThousandsOfWallLinesEndInTime) {
  constexpr int kLines = 20'000;
  constexpr unsigned kSeconds = 60;
  DrawingText level = room(), slanted = room(), crossing = room();
  for (int k = 0; k < kLines; ++k) {
    const double at = 0.01 * k;
    level.line(kWall, 10, at, 60, at), slanted.line(kWall, 10 + at, 0, 60 + at, 50);
    if (k % 2 == 0) crossing.line(kWall, 10, at, 210, at), crossing.line(kWall, 10 + at, 0, 10 + at, 200);
  }
  for (const DrawingText* drawing : {&level, &slanted}) {
    const Scene scene = load_within(write("plan.dxf", drawing->str()), kSeconds);
    ASSERT_EQ(scene.rooms().size(), 1u);
    EXPECT_NEAR(floor_area(scene.rooms()[0]), 24, 1e-3);
  }
  expect_error(Errc::malformed_file, "cross more than 100,000 times",
               [&] { load_within(write("plan.dxf", crossing.str()), kSeconds); });
}

// Two rooms with double walls and a passage between them, without a door that tells the unit.
DrawingText without_doors(int unit, double scale) {
  DrawingText d(unit, scale);
  d.polyline(kWall, {{-0.2, -0.2}, {9.2, -0.2}, {9.2, 4.2}, {-0.2, 4.2}});
  d.polyline(kWall,
             {{0, 0}, {5, 0}, {5, 1}, {5.2, 1}, {5.2, 0}, {9, 0}, {9, 4}, {5.2, 4}, {5.2, 2}, {5, 2}, {5, 4}, {0, 4}});
  d.text("A-TEXT", 1.5, 2, "West"), d.text("A-TEXT", 6, 2, "East");
  return d;
}

TEST_F(FloorPlanFormsTest, AUnitInWhichWallsAreNoneIsAsked) {
  enum { inches = 1, feet, millimetres = 4, centimetres, metres };
  const double foot = 0.3048, inch = 0.0254;
  for (const auto& [unit, scale] :
       {std::pair{metres, 1.0}, std::pair{millimetres, 1e3}, std::pair{feet, 1 / foot}, std::pair{inches, 1 / inch}})
    expect_rooms("stated rightly", without_doors(unit, scale), {{"West", 200'000}, {"East", 152'000}});
  for (const auto& [unit, scale, meant] :
       {std::tuple(inches, 1e3, "in mm"), std::tuple(centimetres, 1e3, "in mm"), std::tuple(metres, 1 / foot, "in ft"),
        std::tuple(feet, 1.0, "in m"), std::tuple(centimetres, 1 / inch, "in in")}) {
    const std::filesystem::path file = write("plan.dxf", without_doors(unit, scale).str());
    expect_error(Errc::malformed_file, std::string("its walls and rooms are those of a building ") + meant,
                 [&] { Scene::load(file); });
  }
  DrawingText thick(14, 10);  // decimetres, which the doors confirm, though its walls are none but in inches
  thick.rectangle(kWall, -1, -1, 13, 9), thick.rectangle(kWall, 0, 0, 12, 8);
  thick.arc("A-DOOR", 2, 0, 0.9, 0, 90), thick.text("A-TEXT", 1, 1, "Vault");
  expect_rooms("doors confirm it", thick, {{"Vault", 960'000}}, 25'000);
  DrawingText single(metres);  // a corridor between single lines is no wall in feet
  single.rectangle(kWall, 0, 0, 12, 8), single.line(kWall, 0, 3.2, 12, 3.2), single.line(kWall, 0, 4.8, 12, 4.8);
  single.text("A-TEXT", 1, 1, "Hall");
  EXPECT_EQ(load(single).rooms().size(), 1u);
}

TEST_F(FloorPlanFormsTest, UnitsOfTheHeaderAreMany) {
  for (const auto& [code, scale] : {std::pair(10, 1 / 0.9144), std::pair(14, 10.0), std::pair(21, 3937.0 / 1200)})
    expect_rooms(std::to_string(code).c_str(), room(code, scale), kOne);
}

}  // namespace
}  // namespace vantage::test
