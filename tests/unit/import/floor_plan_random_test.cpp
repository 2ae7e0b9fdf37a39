// SPDX-License-Identifier: Apache-2.0
// Random valid drawings of a row of rooms: form of each wall, unit, place, blocks, visibility. Their truth is known:
// the result equals it, and the notes list all that is left out. VANTAGE_SEEDS=first..last chooses the drawings.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <random>

#include "drawing.hpp"
#include "import_fixture.hpp"
#include "vantage/scene.hpp"

namespace vantage::test {
namespace {

constexpr const char* kWallLayer = "A-WALL";

class RandomPlan {
 public:
  explicit RandomPlan(std::uint64_t seed) : random_(seed), text_(drawing()) { draw(); }

  struct RoomTruth {
    std::string name;
    double area = 0, east = 0;  // m²; its west side's place
  };
  std::vector<RoomTruth> rooms;
  std::vector<std::string> told;  // words that notes must have
  std::string str() const { return text_.str(); }

 private:
  double between(double low, double high) {
    // To the millimetre, as drawings are.
    return std::round(1000 * std::uniform_real_distribution(low, high)(random_)) / 1000;
  }
  std::size_t one_of(std::size_t count) { return random_() % count; }
  bool chance(double share) { return std::uniform_real_distribution(0.0, 1.0)(random_) < share; }

  DrawingText drawing() {
    struct Choice {
      int code;
      double scale;
    };
    constexpr Choice kChoices[]{{6, 1},          {5, 100},        {4, 1000}, {14, 10},
                                {1, 1 / 0.0254}, {2, 1 / 0.3048}, {0, 1000}, {0, 1}};
    const Choice choice = kChoices[one_of(std::size(kChoices))];
    if (chance(0.3)) east_ = 400'000 + between(0, 200'000), north_ = 5'000'000 + between(0, 900'000);
    return DrawingText(choice.code, choice.scale, east_, north_);
  }

  void draw() {
    for (const char* layer : {kWallLayer, "A-DOOR", "A-TEXT"}) text_.layer(layer);
    text_.layer("SWITCHED", -3), text_.layer("COLD", 3, 1);
    deep_ = between(3, 6);
    const std::size_t count = 1 + one_of(4);
    double x = 0;
    for (std::size_t r = 0; r < count; ++r) {
      const double wide = between(2.5, 6);
      rooms.push_back({"Room " + std::string(1, static_cast<char>('A' + r)), wide * deep_, x});
      add_door(x + 0.4);
      column(rooms.back(), x + wide - 0.9);
      text_.look({.below = chance(0.3)});
      text_.text("A-TEXT", x + 0.5, deep_ - 0.5, rooms.back().name);
      x += wide;
      if (r + 1 < count) x += partition(x);
    }
    outer(x);
    decoys(x);
  }

  void add_door(double x) {
    text_.look({.below = chance(0.3)});
    text_.arc("A-DOOR", x, 0, 0.9, 0, 90);
    text_.line("A-DOOR", x, 0, x, 0.9);
  }

  void outer(double wide) {
    const double t = between(0.1, 0.4);
    const DrawingText::Points in{{0, 0}, {wide, 0}, {wide, deep_}, {0, deep_}},
        out{{-t, -t}, {wide + t, -t}, {wide + t, deep_ + t}, {-t, deep_ + t}};
    text_.look({.below = chance(0.3)});
    switch (one_of(5)) {
      case 0:
        for (const auto& ring : {in, out})
          for (std::size_t k = 0; k < 4; ++k)
            text_.line(kWallLayer, ring[k].first, ring[k].second, ring[(k + 1) % 4].first, ring[(k + 1) % 4].second);
        break;
      case 1:
        for (const auto& ring : {in, out}) text_.old_polyline(kWallLayer, vertices(ring), true, chance(0.5));
        break;
      case 2:
        text_.hatch(kWallLayer, {out, in},
                    {.boundary = chance(0.5) ? DrawingText::Boundary::edges : DrawingText::Boundary::polyline,
                     .seeds = static_cast<int>(one_of(3))});
        break;
      case 3: {
        const DrawingText::Points middle{
            {-t / 2, -t / 2}, {wide + t / 2, -t / 2}, {wide + t / 2, deep_ + t / 2}, {-t / 2, deep_ + t / 2}};
        text_.polyline(kWallLayer, vertices(middle), true, t);
        break;
      }
      default:
        text_.begin_block("Shell", 1, 2);
        for (const auto& ring : {in, out}) {
          DrawingText::Points moved;
          for (const auto& [px, py] : ring) moved.emplace_back(1 - py, 2 + px);  // turned by 90°
          text_.polyline("0", moved);
        }
        text_.end_block();
        text_.insert(kWallLayer, chance(0.5) ? "SHELL" : "shell", 0, 0, 1, 1, -90);
    }
  }

  static std::vector<DrawingText::Vertex> vertices(const DrawingText::Points& points) {
    std::vector<DrawingText::Vertex> out;
    for (const auto& [px, py] : points) out.push_back({px, py});
    return out;
  }

  // A wall from south to north, whose west side is at x. Returns its thickness.
  double partition(double x) {
    const double t = between(0.08, 0.3), miss = chance(0.4) ? between(0.001, 0.045) : 0, top = deep_ - miss;
    const DrawingText::Points ring{{x, 0}, {x + t, 0}, {x + t, top}, {x, top}};
    text_.look({.below = chance(0.3)});
    switch (one_of(10)) {
      case 0: text_.line(kWallLayer, x, 0, x, top), text_.line(kWallLayer, x + t, top, x + t, 0); return t;
      case 1: text_.old_polyline(kWallLayer, vertices(ring), true, chance(0.5)); return t;
      case 2: text_.polyline(kWallLayer, ring); return t;
      case 3: text_.polyline(kWallLayer, {{x + t / 2, 0}, {x + t / 2, top}}, false, t); return t;
      case 4: text_.solid(kWallLayer, x, 0, x + t, top); return t;
      case 5: text_.multiline(kWallLayer, x + t / 2, 0, x + t / 2, top, t); return t;
      case 6: text_.hatch(kWallLayer, {ring}, {.seeds = static_cast<int>(one_of(3))}); return t;
      case 7: text_.faces(kWallLayer, ring, {{1, 2, 3}, {1, 3, 4}}); return t;
      case 8: {
        const std::string name = "part" + std::to_string(blocks_++);
        text_.begin_block(name, 1, 1);
        text_.rectangle("0", 1, 1, 3, 2);
        text_.end_block();
        if (chance(0.5))
          text_.insert(kWallLayer, name, x, 0, t / 2, top);
        else
          text_.insert(kWallLayer, name, x + t, 0, -t / 2, top);
        return t;
      }
      default: text_.line(kWallLayer, x + 0.05, miss / 2, x + 0.05, deep_ - miss / 2); return 0.1;  // a single line
    }
  }

  void column(RoomTruth& room, double x) {
    if (chance(0.5)) return;
    constexpr double kRadius = 0.25;
    const double y = deep_ - 1;
    text_.look({.below = chance(0.3)});
    double area = std::numbers::pi * kRadius * kRadius;
    switch (one_of(5)) {
      case 0: text_.circle(kWallLayer, x, y, kRadius); break;
      case 1: text_.round_spline(kWallLayer, x, y, kRadius); break;
      case 2: text_.old_polyline(kWallLayer, {{x - kRadius, y, 1}, {x + kRadius, y, 1}}, true); break;
      case 3:
        text_.ellipse(kWallLayer, x, y, 0.28, 0, 0.5);
        area = std::numbers::pi * 0.28 * 0.14;
        break;
      default: text_.solid(kWallLayer, x - 0.2, y - 0.2, x + 0.2, y + 0.2); area = 0.16;
    }
    room.area -= area;
  }

  // Draws entities across a room that are invisible, or that the importer does not read.
  void decoys(double wide) {
    const double x = std::min(wide, rooms.front().area / deep_) / 2;
    const auto across = [&](const char* layer) {
      text_.line(layer, x, 0, x, deep_), text_.line(layer, x + 0.1, 0, x + 0.1, deep_);
    };
    if (chance(0.3)) {
      text_.look({.invisible = true});
      across(kWallLayer), told.emplace_back("invisible, left out (A-WALL: 2 LINE)");
    }
    if (chance(0.3)) {
      text_.look({.on_sheet = true});
      across(kWallLayer), told.emplace_back("paper space");
    }
    text_.look({});
    if (chance(0.3)) across("SWITCHED"), told.emplace_back("SWITCHED: 2 LINE");
    if (chance(0.3)) {
      text_.begin_block("cold");
      across(kWallLayer);
      text_.end_block();
      text_.insert("COLD", "Cold", 0, 0), told.emplace_back("COLD: 1 INSERT");
    }
    if (chance(0.3)) text_.raw("REGION", kWallLayer), told.emplace_back("not read (A-WALL: 1 REGION)");
    if (chance(0.3)) text_.insert(kWallLayer, "gone", 0, 0), told.emplace_back("1 INSERT of gone");
  }

  std::mt19937_64 random_;
  double east_ = 0, north_ = 0, deep_ = 0;
  int blocks_ = 0;
  DrawingText text_;

 public:
  double east() const { return east_; }
};

class FloorPlanRandomTest : public ImportTest {};

std::pair<std::uint64_t, std::uint64_t> plan_seeds() {
  unsigned long long first = 1, last = 20;
  if (const char* text = std::getenv("VANTAGE_SEEDS"); text && std::sscanf(text, "%llu..%llu", &first, &last) != 2)
    ADD_FAILURE() << "VANTAGE_SEEDS must be first..last: " << text;
  return {first, last};
}

TEST_F(FloorPlanRandomTest, WhatIsReadIsWhatWasDrawn) {
  const auto [first, last] = plan_seeds();
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const RandomPlan plan(seed);
    const auto file = write("plan.dxf", plan.str());
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::optional<Scene> read;
    try {
      read = Scene::load(file);
    } catch (const Error& error) {
      ADD_FAILURE() << error.what();
      continue;
    }
    const Scene& scene = *read;
    std::string notes;
    for (const std::string& note : scene.notes()) notes += note + "\n";
    EXPECT_EQ(scene.rooms().size(), plan.rooms.size()) << notes;
    for (const auto& wanted : plan.rooms) {
      const auto room = std::ranges::find(scene.rooms(), wanted.name, &Room::name);
      if (room == scene.rooms().end()) {
        ADD_FAILURE() << wanted.name << " is missing\n" << notes;
        continue;
      }
      // Curves stray by 5 mm at most.
      EXPECT_NEAR(floor_area(*room), wanted.area, 0.01) << wanted.name << '\n' << notes;
      EXPECT_NEAR(room->box.min.x, plan.east() + wanted.east, 2e-3) << wanted.name << '\n' << notes;
    }
    for (const std::string& words : plan.told)
      EXPECT_NE(notes.find(words), std::string::npos) << words << " is not in\n" << notes;
  }
}

}  // namespace
}  // namespace vantage::test
