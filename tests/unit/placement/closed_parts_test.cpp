// SPDX-License-Identifier: Apache-2.0
// Ground that something bars the way to: where one enters, what is entered by default, and what is said of the rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "placement_scenes.hpp"
#include "vantage/placement.hpp"
#include "vantage/summary.hpp"

namespace vantage {
namespace {

using test::Builder;
using test::origin;

// Collects named meshes into one scene.
class Named {
 public:
  Named& add(const std::string& name, const Builder& part, bool glass = false) {
    const SceneData own = part.data();
    const auto first = static_cast<std::uint32_t>(data_.positions.size());
    MeshRange range{static_cast<std::uint32_t>(data_.triangles.size()),
                    static_cast<std::uint32_t>(own.triangles.size()), 0};
    data_.positions.insert(data_.positions.end(), own.positions.begin(), own.positions.end());
    for (const Triangle& t : own.triangles) data_.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    data_.local_bounds.extend(own.local_bounds.min), data_.local_bounds.extend(own.local_bounds.max);
    data_.ranges.push_back(range);
    data_.meshes.push_back({.name = name,
                            .role = glass ? Role::blocking : Role::surveyed,
                            .triangle_count = range.triangle_count,
                            .glass = glass});
    return *this;
  }
  Scene scene() {
    data_.origin = origin;
    data_.materials.emplace_back();
    return Scene(std::make_shared<const SceneData>(data_));
  }

 private:
  SceneData data_;
};

bool holds(const SearchArea& area, double x, double y, double z) {
  const auto uv = area.project(origin + Vec3{x, y, z});
  if (!uv) return false;
  const auto ground = area.locate(*uv);
  return ground && std::abs(ground->z - origin.z - z) < 0.3;
}

const ClosedPart* part_at(std::span<const ClosedPart> parts, double x0, double x1) {
  const auto found = std::ranges::find_if(
      parts, [&](const ClosedPart& part) { return part.place.x - origin.x > x0 && part.place.x - origin.x < x1; });
  return found == parts.end() ? nullptr : &*found;
}

Builder& slab(Builder& builder, double x0, double y0, double x1, double y1, double z) {
  return builder.box({x0, y0, z - 0.2}, {x1, y1, z});
}

// A room of 6 x 6 m, walls of 3 m under a ceiling, from x on; the wall between it and the one before has an opening of
// this width, from `sill` to `head`.
Builder rooms_with_opening(double width, double sill, double head) {
  Builder b;
  slab(b, 0, 0, 12, 6, 0);
  b.box({-0.2, -0.2, 3}, {12.2, 6.2, 3.2});
  b.box({-0.2, -0.2, 0}, {12.2, 0, 3}).box({-0.2, 6, 0}, {12.2, 6.2, 3});
  b.box({12, 0, 0}, {12.2, 6, 3});
  b.box({-0.2, 0, 0}, {0, 2, 3}).box({-0.2, 3, 0}, {0, 6, 3}).box({-0.2, 2, 2.1}, {0, 3, 3});  // the way in
  b.box({5.9, 0, 0}, {6.1, 3 - width / 2, 3}).box({5.9, 3 + width / 2, 0}, {6.1, 6, 3});
  b.box({5.9, 3 - width / 2, head}, {6.1, 3 + width / 2, 3});
  if (sill > 0) b.box({5.9, 3 - width / 2, 0}, {6.1, 3 + width / 2, sill});
  return b;
}

TEST(ClosedParts, OneStoopsUnderALowHeadAndIsTold) {
  Builder b = rooms_with_opening(0.9, 0, 1.6);
  slab(b, -8, -4, 0, 10, 0);  // one comes from outside
  const Scene scene = b.scene();
  const SearchArea area = SearchArea::build(scene);
  EXPECT_TRUE(holds(area, 3, 3, 0));
  EXPECT_TRUE(holds(area, 9, 3, 0));
  ASSERT_EQ(area.entered().size(), 1u);
  EXPECT_EQ(area.entered()[0].bar, Bar::headroom);
  EXPECT_NEAR(area.entered()[0].height_m, 1.6, 0.05);
  EXPECT_NE(entered_text(area).find("headroom of 1.60 m"), std::string::npos) << entered_text(area);
  EXPECT_NE(entered_text(area).find("stoops"), std::string::npos);
  EXPECT_TRUE(area.not_entered().empty());

  const SearchArea left = SearchArea::build(scene, {.enter_closed = false});
  EXPECT_FALSE(holds(left, 9, 3, 0));
  ASSERT_EQ(left.not_entered().size(), 1u);
  EXPECT_TRUE(left.not_entered()[0].to_decide());
  EXPECT_NEAR(left.not_entered()[0].share, 0.18, 0.02);  // with the ground before the house
  EXPECT_TRUE(entered_text(left).empty());
}

TEST(ClosedParts, WhoNamesAnEntranceGetsThatAndWhatElseThereIsIsTold) {
  const SearchArea area =
      SearchArea::build(rooms_with_opening(0.9, 0, 1.6).scene(), {.enter = {origin + Vec3{9, 3, 0}}});
  EXPECT_TRUE(holds(area, 9, 3, 0));
  EXPECT_FALSE(holds(area, 3, 3, 0));
  EXPECT_TRUE(area.entered().empty());
  EXPECT_EQ(area.not_entered().size(), 1u);
}

// A door's leaf and a pane bar the way, and are named; behind a window there is a room that nothing leads to.
TEST(ClosedParts, ClosedLeavesAndPanesAreNamed) {
  for (const bool glass : {false, true}) {
    const SearchArea area =
        SearchArea::build(Named()
                              .add("house", rooms_with_opening(1.0, 0, 2.1))
                              .add("LEAF-7", Builder().box({5.98, 2.5, 0.01}, {6.02, 3.5, 2.1}), glass)
                              .scene());
    EXPECT_TRUE(holds(area, 9, 3, 0)) << glass;
    ASSERT_EQ(area.entered().size(), 1u);
    EXPECT_EQ(area.entered()[0].bar, Bar::door);
    EXPECT_EQ(area.entered()[0].doors, std::vector<std::string>{"LEAF-7"});
  }
  const SearchArea window = SearchArea::build(rooms_with_opening(1.0, 0.9, 2.1).scene());
  EXPECT_TRUE(holds(window, 9, 3, 0));
  ASSERT_EQ(window.entered().size(), 1u);
  EXPECT_EQ(window.entered()[0].bar, Bar::no_way);
}

// Nobody can tell a room from a hollow if it has no opening.
TEST(ClosedParts, WhatHasNoOpeningIsNoRoom) {
  Builder b = rooms_with_opening(1.0, 0, 2.1);
  slab(b, 20, 0, 24, 6, 0);
  b.box({19.8, -0.2, 0}, {20, 6.2, 3}).box({24, -0.2, 0}, {24.2, 6.2, 3});
  b.box({20, -0.2, 0}, {24, 0, 3}).box({20, 6, 0}, {24, 6.2, 3}).box({19.8, -0.2, 3}, {24.2, 6.2, 3.2});
  const SearchArea area = SearchArea::build(b.scene());
  EXPECT_FALSE(holds(area, 22, 3, 0));
  const ClosedPart* hollow = part_at(area.not_entered(), 20, 24);
  ASSERT_TRUE(hollow);
  EXPECT_EQ(hollow->kind, ClosedKind::hollow);
  EXPECT_FALSE(hollow->to_decide());
}

// A platform of 0.9 m is floor; goods of that height are none, as long as their tops are too narrow to stand on.
TEST(ClosedParts, APlatformIsEnteredOverItsStepAndGoodsAreNot) {
  Builder b;
  slab(b, 0, 0, 30, 20, 0);
  slab(b, -40, 0, 0, 20, 0);  // one comes from outside
  b.box({-0.2, -0.2, 5}, {30.2, 20.2, 5.2});
  b.box({-0.2, -0.2, 0}, {30.2, 0, 5}).box({-0.2, 20, 0}, {30.2, 20.2, 5}).box({30, 0, 0}, {30.2, 20, 5});
  b.box({-0.2, 0, 0}, {0, 8, 5}).box({-0.2, 12, 0}, {0, 20, 5}).box({-0.2, 8, 3}, {0, 12, 5});
  b.box({22, 0, 0}, {30, 20, 0.9});                                                // the platform
  for (int k = 0; k < 3; ++k) b.box({4 + 4.0 * k, 2, 0}, {5.2 + 4 * k, 19, 0.9});  // 20 m² each
  const SearchArea area = SearchArea::build(b.scene());
  EXPECT_TRUE(holds(area, 26, 10, 0.9));
  EXPECT_FALSE(holds(area, 4.6, 10, 0.9));
  ASSERT_EQ(area.entered().size(), 1u);
  EXPECT_EQ(area.entered()[0].bar, Bar::step);
  EXPECT_NEAR(area.entered()[0].height_m, 0.9, 0.01);
  for (const ClosedPart& part : area.not_entered()) EXPECT_EQ(part.kind, ClosedKind::top);
}

// Two storeys, the upper with an opening in its floor: a ladder with rungs leads up, or nothing.
Builder storeys(bool ladder) {
  Builder b;
  slab(b, -5, -5, 13, 11, 0);
  for (const double z : {0.0, 3.2}) {
    b.box({-0.2, -0.2, z}, {8.2, 0, z + 3}).box({-0.2, 6, z}, {8.2, 6.2, z + 3}).box({8, 0, z}, {8.2, 6, z + 3});
    b.box({-0.2, 0, z}, {0, 2, z + 3}).box({-0.2, 3.2, z}, {0, 6, z + 3}).box({-0.2, 2, z + 2.1}, {0, 3.2, z + 3});
    if (z > 0) b.box({-0.2, 2, z}, {0, 3.2, z + 1});  // a window
  }
  b.box({-0.2, -0.2, 3}, {8.2, 2, 3.2}).box({-0.2, 4, 3}, {8.2, 6.2, 3.2});
  b.box({-0.2, 2, 3}, {4, 4, 3.2}).box({5.2, 2, 3}, {8.2, 4, 3.2});
  b.box({-0.2, -0.2, 6.2}, {8.2, 6.2, 6.4});
  if (!ladder) return b;
  for (const double y : {2.7, 3.25}) b.box({5.1, y, 0}, {5.14, y + 0.05, 4.2});
  for (int k = 1; k <= 11; ++k) b.box({5.1, 2.75, 0.28 * k - 0.03}, {5.14, 3.25, 0.28 * k});
  return b;
}

TEST(ClosedParts, AGalleryThatNothingLeadsToIsEnteredAndARoofIndoorsIsNot) {
  const auto hall = [](const Builder& part) {
    Builder b = part;
    b.floor(0, 0, 20, 16, 0).box({0, 0, 8}, {20, 16, 8.2});
    b.box({-0.2, 0, 0}, {0, 16, 8}).box({20, 0, 0}, {20.2, 16, 8}).box({0, 16, 0}, {20, 16.2, 8});
    b.box({0, -0.2, 0}, {9, 0, 8}).box({11, -0.2, 0}, {20, 0, 8}).box({9, -0.2, 2.2}, {11, 0, 8});
    return SearchArea::build(b.floor(-10, -20, 30, -0.2, 0).scene());
  };
  const Vec3 low{0, 11, 3.8}, high{20, 16, 4};
  Builder gallery, roof, sail;
  gallery.box(low, high).box({0, 11, 4}, {20, 11.1, 5});
  EXPECT_TRUE(holds(hall(gallery), 10, 14, 4));
  roof.box({4, 4, 0}, {14, 12, 3});  // of a block indoors
  EXPECT_FALSE(holds(hall(roof), 9, 8, 3));
  sail.box({4, 4, 4}, {14, 12, 4.1});  // hangs from the ceiling
  EXPECT_FALSE(holds(hall(sail), 9, 8, 4.1));
}

// A window lights what is below the roof: a floor by any other name is planned, too.
TEST(ClosedParts, TheVoidAboveACeilingIsNoFloor) {
  const auto hall = [](const std::string& name) {
    Builder walls, ceiling;
    walls.floor(0, 0, 20, 16, 0).box({0, 0, 9}, {20, 16, 9.2}).floor(-10, -20, 30, -0.2, 0);
    walls.box({-0.2, 0, 0}, {0, 16, 9}).box({0, 16, 0}, {20, 16.2, 9});
    walls.box({20, 0, 0}, {20.2, 16, 6.8}).box({20, 0, 8}, {20.2, 16, 9});
    walls.box({0, -0.2, 0}, {9, 0, 9}).box({11, -0.2, 0}, {20, 0, 9}).box({9, -0.2, 2.2}, {11, 0, 9});
    ceiling.box({0, 0, 5.8}, {20, 16, 6});
    return SearchArea::build(Named().add("hall", walls).add(name, ceiling).scene());
  };
  const SearchArea deck = hall("Deck 2"), ceiling = hall("Plafond_salle");
  EXPECT_TRUE(holds(deck, 10, 12, 6));
  EXPECT_FALSE(holds(ceiling, 10, 12, 6));
  const ClosedPart* const part = part_at(ceiling.not_entered(), 0, 20);
  ASSERT_TRUE(part);
  EXPECT_EQ(part->kind, ClosedKind::attic);
}

TEST(ClosedParts, ARoofOverWhereNobodyStandsIsNoGround) {
  Builder b;
  b.floor(-10, -30, 40, 0, 0);
  for (int k = 0; k < 24; ++k) b.box({0, 0.5 * k, 0}, {30, 0.5 * k + 0.5, 0.8 * (k + 1)});  // too steep for a person
  b.box({-1, -1, 24}, {31, 12.5, 24.3}).box({0, 12, 0}, {30, 12.4, 24});
  const SearchArea area = SearchArea::build(b.scene());
  EXPECT_TRUE(holds(area, 15, -15, 0));
  EXPECT_FALSE(holds(area, 15, 5, 24.3));
}

// The slab of a low house lies on the ground, which alone would have room for a head.
TEST(ClosedParts, NobodyStandsInASlab) {
  Builder b;
  b.floor(-10, -10, 20, 20, 0).box({0, 0, 0.05}, {8, 8, 0.25}).box({0, 0, 2.0}, {8, 8, 2.2});
  const SearchArea area = SearchArea::build(b.scene());
  EXPECT_TRUE(holds(area, -5, -5, 0));
  EXPECT_FALSE(holds(area, 4, 4, 0));
}

TEST(ClosedParts, AFloorOnWhichOneStoopsAllOverIsToldAndTheRimOfARoomIsNot) {
  const auto house = [](double ceiling) {
    Builder b;
    b.floor(-10, -10, 20, 20, 0).box({0, 0, ceiling}, {8, 8, ceiling + 0.2});
    b.box({0, 0, 0}, {0.2, 8, ceiling}).box({7.8, 0, 0}, {8, 8, ceiling}).box({0, 7.8, 0}, {8, 8, ceiling});
    return b.box({0, 0, 0}, {3, 0.2, ceiling}).box({4, 0, 0}, {8, 0.2, ceiling}).scene();
  };
  const SearchArea low = SearchArea::build(house(1.7));
  ASSERT_EQ(low.not_entered().size(), 1U);
  const ClosedPart& part = low.not_entered()[0];
  EXPECT_EQ(part.kind, ClosedKind::low);
  EXPECT_TRUE(part.to_decide());
  EXPECT_NEAR(part.height_m, 1.7, 0.02);
  EXPECT_NEAR(part.area_m2, 7.0 * 7.0, 4);
  EXPECT_TRUE(SearchArea::build(house(1.4)).not_entered().empty());
  EXPECT_TRUE(holds(SearchArea::build(house(2.2)), 4, 4, 0));
  Builder canopy;
  canopy.floor(-10, -10, 20, 20, 0).box({0, 0, 1.7}, {8, 8, 1.9});
  EXPECT_TRUE(SearchArea::build(canopy.scene()).not_entered().empty());
}

TEST(ClosedParts, ALadderIsAWay) {
  const SearchArea up = SearchArea::build(storeys(true).scene());
  EXPECT_TRUE(holds(up, 2, 5, 3.2));
  ASSERT_FALSE(up.entered().empty());
  EXPECT_EQ(up.entered()[0].bar, Bar::climb);
  EXPECT_LE(up.entered()[0].height_m, 0.45);
  // The storey has a window, and is planned without the ladder, too.
  const SearchArea none = SearchArea::build(storeys(false).scene());
  ASSERT_FALSE(none.entered().empty());
  EXPECT_EQ(none.entered()[0].bar, Bar::no_way);
}

// A river between two banks too high to climb, 5 m above it, a road on one of them: ground at any height, not water.
TEST(ClosedParts, GroundLiesWhereItIsLargestAndNotAtTheLowestPoint) {
  Builder terrain, road, pier;
  terrain.floor(-40, -20, -12, 20, 5).floor(12, -20, 40, 20, 5);
  terrain.quad({-12, -20, 5}, {-8, -20, -1}, {-8, 20, -1}, {-12, 20, 5});
  terrain.quad({8, -20, -1}, {12, -20, 5}, {12, 20, 5}, {8, 20, -1});
  road.box({-40, -3, 5.2}, {40, 3, 5.6});
  for (const double y : {-3.0, 2.9}) road.box({-40, y, 5.6}, {40, y + 0.1, 6.6});
  pier.box({-1, -2, -4}, {1, 2, 5.2});
  const SearchArea area = SearchArea::build(Named()
                                                .add("Gelaende", terrain)
                                                .add("Strasse", road)
                                                .add("Pfeiler", pier)
                                                .add("Wasser", Builder().floor(-9, -20, 9, 20, 0))
                                                .scene());
  EXPECT_FALSE(area.on_plane());
  EXPECT_TRUE(holds(area, -30, 10, 5));
  EXPECT_TRUE(holds(area, 30, 10, 5));
  EXPECT_TRUE(holds(area, 0, 0, 5.6));
  EXPECT_FALSE(holds(area, 0, 10, 0)) << "on the water";
}

// The tops of blocks are no ground, whatever part of the outline they cover.
TEST(ClosedParts, TopsOfBlocksAreNoGround) {
  Builder b;
  b.box({0, 0, 0}, {20, 12, 8}).box({26, 0, 0}, {40, 12, 9});
  const SearchArea area = SearchArea::build(b.scene());
  EXPECT_TRUE(area.on_plane());
  EXPECT_TRUE(area.not_entered().empty());
}

// Terrain that is drawn as a block ends like the top of something: it is told where it is larger than the pit in it.
TEST(ClosedParts, APlateauLargerThanThePitInItIsTold) {
  Builder b;
  b.box({0, 0, -2}, {50, 10, 10}).box({0, 40, -2}, {50, 50, 10}).box({0, 10, -2}, {10, 40, 10});
  b.box({40, 10, -2}, {50, 40, 10}).box({10, 10, -2}, {40, 40, 0});
  const SearchArea area = SearchArea::build(b.scene());
  EXPECT_FALSE(area.on_plane());
  EXPECT_TRUE(holds(area, 25, 25, 0));
  ASSERT_EQ(area.not_entered().size(), 1u);
  EXPECT_GT(area.not_entered()[0].area_m2, 1500);
  EXPECT_TRUE(area.not_entered()[0].to_decide());
}

// A gap that one steps over has no height; of steps that lead to a part, the lowest is told.
TEST(ClosedParts, OneStepsOverAGapAndTheLowestStepIsTold) {
  const auto with_gap = [](double width, double drop) {
    Builder gap;
    slab(gap, 0, 0, 10, 8, 0);
    slab(gap, 10 + width, 0, 16, 8, -drop);
    return SearchArea::build(gap.scene());
  };
  for (const double drop : {0.0, 0.12, 0.2}) {
    const SearchArea over = with_gap(0.25, drop);
    EXPECT_TRUE(holds(over, 13, 4, -drop));
    EXPECT_TRUE(over.entered().empty() && over.not_entered().empty()) << drop;
  }
  EXPECT_EQ(with_gap(0.7, 0).entered().size(), 1u);
  Builder step;
  slab(step, 0, 0, 10, 8, 0);
  step.box({10, 0, -0.2}, {16, 8, 0.8}).box({9, 3, 0}, {10, 5, 0.4});
  const SearchArea up = SearchArea::build(step.scene());
  ASSERT_EQ(up.entered().size(), 1u);
  EXPECT_EQ(up.entered()[0].bar, Bar::step);
  EXPECT_NEAR(up.entered()[0].height_m, 0.4, 0.01);
}

// Bars of 5 mm every 40 mm carry a person and a tripod.
TEST(ClosedParts, AGratingIsAFloor) {
  Builder b;
  slab(b, 0, 0, 10, 6, 0);
  for (double y = 0; y < 6; y += 0.04) b.box({10, y, -0.04}, {18, y + 0.005, 0});
  for (double x = 10.3; x < 18; x += 0.8) b.box({x, 0, -0.03}, {x + 0.006, 6, -0.005});
  const SearchArea area = SearchArea::build(b.scene());
  int found = 0;
  for (double x = 10.5; x < 17.5; x += 0.17)
    for (double y = 0.5; y < 5.5; y += 0.17) found += holds(area, x, y, 0);
  EXPECT_GT(found, 1100);  // of 1230
}

// A stair leads onto the tops of walls without a ceiling: a way of a kind, and no place for a tripod.
TEST(ClosedParts, TheTopOfAWallIsNoPlaceForATripod) {
  for (const double width : {0.3, 0.8}) {
    Builder b;
    b.floor(-5, -5, 15, 15, 0);
    b.box({0, 0, 0}, {10, width, 2}).box({0, 0, 0}, {width, 10, 2});
    for (int k = 0; k < 10; ++k) b.box({2 + 0.3 * k, width, 0}, {5, width + 1, 0.2 * (k + 1)});  // from the west
    const SearchArea area = SearchArea::build(b.scene());
    EXPECT_TRUE(holds(area, 12, 12, 0));
    EXPECT_EQ(holds(area, 8, width / 2, 2), width > 0.5) << width;
    EXPECT_EQ(holds(area, width / 2, 8, 2), width > 0.5) << width;
    EXPECT_TRUE(holds(area, 4.85, width + 0.85, 2)) << "a corner of the landing";
  }
}

TEST(ClosedParts, AWingOverTheFloorIsNoFloor) {
  Builder b;
  b.floor(-10, -30, 40, -0.2, 0).floor(0, 0, 30, 30, 0).box({-0.2, -0.2, 9}, {30.2, 30.2, 9.2});
  b.box({-0.2, 0, 0}, {0, 30, 9}).box({30, 0, 0}, {30.2, 30, 9}).box({0, 30, 0}, {30, 30.2, 9});
  b.box({0, -0.2, 0}, {12, 0, 9}).box({18, -0.2, 0}, {30, 0, 9});  // the gate is open
  b.box({3, 12, 3.8}, {27, 15, 4.0});
  const SearchArea area = SearchArea::build(b.scene());
  EXPECT_TRUE(holds(area, 15, 5, 0));
  EXPECT_FALSE(holds(area, 15, 13.5, 4));
}

// Between a tunnel's roof and the street above it there is earth, which no model has.
TEST(ClosedParts, TheEarthAroundATunnelIsNoRoom) {
  Builder b;
  b.floor(-20, -12, 0, 12, 0);  // before the portal
  b.box({0, -4, -0.5}, {40, 4, 0}).box({0, -4, 0}, {40, -3.6, 4}).box({0, 3.6, 0}, {40, 4, 4});
  b.box({0, -4, 4}, {40, 4, 4.4}).box({2, -12, 8}, {40, 12, 8.4});
  const SearchArea area = SearchArea::build(b.scene());
  EXPECT_TRUE(holds(area, 20, 0, 0));
  EXPECT_FALSE(holds(area, 20, 0, 4.4));
}

TEST(ClosedParts, NobodyStandsOnTheBedOfALake) {
  for (const bool filled : {true, false}) {
    Named site;
    Builder valley;
    valley.floor(-20, 0, 20, 6, 10);                                  // the crest of a dam
    valley.quad({-20, 0, 10}, {-20, 0, 0}, {20, 0, 0}, {20, 0, 10});  // its face
    valley.floor(-20, -30, 20, 0, 0).box({-21, -30, -1}, {-20, 6, 14}).box({20, -30, -1}, {21, 6, 14});
    site.add("Terreno", valley);
    if (filled) site.add("Acqua_invaso", Builder().floor(-20, -30, 20, 0, 8));
    const SearchArea area = SearchArea::build(site.scene());
    EXPECT_TRUE(!filled || holds(area, 0, 3, 10));
    EXPECT_EQ(holds(area, 0, -15, 0), !filled);
    EXPECT_FALSE(holds(area, 0, -15, 8)) << filled;
  }
}

// Under the hull of a ship no water is drawn; the bed there is none of the model's rooms.
TEST(ClosedParts, NobodyStandsUnderAKeel) {
  Builder quay, water;
  quay.floor(-30, 0, 30, 20, 0).floor(-30, -40, 30, 0, -7).quad({-30, 0, -7}, {30, 0, -7}, {30, 0, 0}, {-30, 0, 0});
  water.floor(-30, -40, 30, -18, -2).floor(-30, -8, 30, 0, -2).floor(-30, -18, -18, -8, -2).floor(18, -18, 30, -8, -2);
  const SearchArea area = SearchArea::build(
      Named().add("kade", quay).add("Water", water).add("schip", Builder().box({-18, -18, -5}, {18, -8, 1})).scene());
  EXPECT_TRUE(holds(area, 0, 10, 0));
  EXPECT_FALSE(holds(area, 0, -12, -7)) << "under the hull";
  EXPECT_FALSE(holds(area, 0, -30, -7));
}

TEST(ClosedParts, APipeOfWaterIsNoLake) {
  Builder pipe;
  for (int k = 0; k < 8; ++k) {  // upper half of a pipe along x
    const auto at = [](int i, double x) {
      const double angle = 3.14159265358979 * i / 8;
      return Vec3{x, 10 + 0.4 * std::cos(angle), 3 + 0.4 * std::sin(angle)};
    };
    pipe.quad(at(k, 0), at(k, 40), at(k + 1, 40), at(k + 1, 0));
  }
  const SearchArea area =
      SearchArea::build(Named().add("yard", Builder().floor(0, 0, 40, 20, 0)).add("pipe-water", pipe).scene());
  EXPECT_TRUE(holds(area, 20, 10, 0));
}

// A terrace over a floor; its ladder begins on a platform that one has to step onto.
TEST(ClosedParts, WhatAnEnteredPartLeadsToIsEnteredToo) {
  for (const bool ladder : {true, false}) {
    Builder b;
    b.floor(-40, 0, 22, 20, 0).box({22, 0, 0}, {30, 20, 0.9}).floor(30, 0, 50, 20, 0).box({30, 0, 3.8}, {50, 20, 4});
    b.box({30, 0, 0}, {30.2, 20, 3.8}).box({49.8, 0, 0}, {50, 20, 3.8});
    b.box({30, 0, 0}, {50, 0.2, 3.8}).box({30, 19.8, 0}, {50, 20, 3.8});
    for (int k = 1; k <= 11 && ladder; ++k) b.box({29.9, 9.75, 0.87 + 0.27 * k}, {29.94, 10.25, 0.9 + 0.27 * k});
    const SearchArea area = SearchArea::build(b.scene());
    EXPECT_TRUE(holds(area, 26, 10, 0.9)) << ladder;
    EXPECT_EQ(holds(area, 40, 10, 4), ladder);
  }
}

}  // namespace
}  // namespace vantage
