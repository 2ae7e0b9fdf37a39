// SPDX-License-Identifier: Apache-2.0
#include "placement/nearest_place.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "placement/place_head.hpp"
#include "placement_scenes.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

using test::origin;

constexpr double kHeight = 1.85;

double apart(const Vec3& a, const Vec3& b) { return std::sqrt(dot(a - b, a - b)); }

// A floor, an upper floor over a part of it, and boxes on both.
struct Store {
  Scene scene;
  ClashChecker clash;
  SearchArea area;

  static Scene make(std::mt19937& random) {
    test::Builder builder;
    builder.floor(-6, -6, 6, 6, 0).box({-6, -6, 2.8}, {-2, 6, 3});
    std::uniform_real_distribution<double> at(-5, 5), side(0.2, 1.6);
    for (int k = 0; k < 14; ++k) {
      const double x = at(random), y = at(random), ground = k % 4 == 0 ? 3 : 0;
      builder.box({x, y, ground}, {x + side(random), y + side(random), ground + 2});
    }
    return builder.scene();
  }
  explicit Store(std::mt19937& random)
      : scene(make(random)),
        clash(scene),
        area(SearchArea::from_mesh(
            {{origin + Vec3{-6, -6, 0}, origin + Vec3{6, -6, 0}, origin + Vec3{6, 6, 0}, origin + Vec3{-6, 6, 0},
              origin + Vec3{-6, -6, 3}, origin + Vec3{-2, -6, 3}, origin + Vec3{-2, 6, 3}, origin + Vec3{-6, 6, 3}},
             {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {2, 0}, {3, 0}, {3, 1}, {2, 1}},
             {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}})) {}
};

// Against every place of a lattice of 4 cm: none of them is nearer, and one is nearly as near.
TEST(NearestPlace, IsTheNearestOfAll) {
  std::mt19937 random(7);
  std::size_t moved = 0, none = 0;
  for (int trial = 0; trial < 4; ++trial) {
    const Store store(random);
    constexpr double kStep = 0.04, kReach = 1.5;
    std::vector<Vec3> free;
    for (const double z : {0.0, 3.0})
      for (double x = -6 + kStep / 2; x < (z > 0 ? -2 : 6); x += kStep)
        for (double y = -6 + kStep / 2; y < 6; y += kStep) {
          const Vec3 head = origin + Vec3{x, y, z + kHeight};
          if (place_head(&store.area, store.clash, kHeight, head).station.status == StationStatus::ok)
            free.push_back(head);
        }
    std::uniform_real_distribution<double> at(-7.5, 7.5), up(-0.5, 4.5);
    for (int k = 0; k < 60; ++k) {
      const Vec3 head = origin + Vec3{at(random), at(random), up(random) + kHeight};
      double least = std::numeric_limits<double>::infinity();
      for (const Vec3& place : free) least = std::min(least, apart(head, place));
      const auto found = nearest_place(store.area, store.clash, kHeight, head, kReach);
      if (least <= kReach) {
        ASSERT_TRUE(found) << head.x << ' ' << head.y << ' ' << head.z << ", " << least << " m away";
        EXPECT_LE(apart(found->position, head), least + 0.01);
        ++moved;
      }
      if (!found) {
        ++none;
        continue;
      }
      EXPECT_LE(apart(found->position, head), kReach);
      EXPECT_GE(apart(found->position, head), std::min(least, kReach) - kStep) << "no such place is free";
      EXPECT_EQ(place_head(&store.area, store.clash, kHeight, found->position).station.status, StationStatus::ok);
      EXPECT_NEAR(found->position.z - found->ground.z, kHeight, 1e-9);
      EXPECT_NEAR(apart(*store.area.locate(found->uv), found->ground), 0, 1e-6);
    }
  }
  EXPECT_GT(moved, 100u);
  EXPECT_GT(none, 20u);
}

TEST(NearestPlace, OfAFreePlaceIsThatPlace) {
  const Scene scene = test::Builder().floor(-6, -6, 6, 6, 0).box({-6, -6, 0}, {-4, -4, 2}).scene();
  const SearchArea area = SearchArea::build(scene);
  const Vec3 head = origin + Vec3{2, 1, kHeight};
  EXPECT_NEAR(apart(nearest_place(area, ClashChecker(scene), kHeight, head)->position, head), 0, 1e-6);
  // Without the check nothing is in the way.
  const ClashChecker off(scene, {.radius_m = 0});
  const auto moved = nearest_place(area, off, kHeight, head + Vec3{0, 0, 0.4});
  EXPECT_NEAR(moved->position.z, head.z, 1e-6);
  EXPECT_FALSE(nearest_place(area, off, kHeight, head + Vec3{0, 0, 0.4}, 0.3));
  EXPECT_THROW(nearest_place(area, off, kHeight, head, -1), Error);
  EXPECT_THROW(nearest_place(area, off, kHeight, {std::nan(""), 0, 0}), Error);
}

TEST(StationMoves, AreForStationsThatDoNotStandWell) {
  const Scene scene = test::Builder().floor(-6, -6, 6, 6, 0).box({-1, -1, 0}, {1, 1, 2}).scene();
  const SearchArea area = SearchArea::build(scene);
  const ClashChecker clash(scene);
  std::vector<PlacedStation> stations;
  for (const Vec3& head : {Vec3{3, 3, kHeight}, Vec3{1.2, 0, kHeight}, Vec3{0, -1.2, kHeight}, Vec3{90, 0, kHeight}})
    stations.push_back(place_head(&area, clash, kHeight, origin + head).station);
  stations[2].existing = true;
  const auto moves = station_moves(area, clash, kHeight, stations);
  ASSERT_EQ(moves.size(), 2u);
  EXPECT_EQ(moves[0].station, 1u);
  ASSERT_TRUE(moves[0].to);
  EXPECT_NEAR(moves[0].to->position.x, origin.x + 1.5, 0.02);
  EXPECT_NEAR(moves[0].to->position.y, origin.y, 0.2);
  EXPECT_EQ(moves[1].station, 3u);
  EXPECT_FALSE(moves[1].to);
}

}  // namespace
}  // namespace vantage
