// SPDX-License-Identifier: Apache-2.0
#include "report/sheet_layout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace vantage {
namespace {

Box box(double width, double depth) { return {{500'000, 100, 0}, {500'000 + width, 100 + depth, 3}}; }

std::vector<Vec3> grid(double width, double depth, double apart) {
  std::vector<Vec3> spots;
  for (double x = apart / 2; x < width; x += apart)
    for (double y = apart / 2; y < depth; y += apart) spots.push_back({500'000 + x, 100 + y, 0});
  return spots;
}

TEST(SheetLayout, TakesTheFinestRoundRatioThatFitsOnA4) {
  const SheetLayout house = lay_out(box(12, 9), grid(12, 9, 3), 200, 196);
  EXPECT_EQ(house.paper.name, "A4");
  EXPECT_EQ(house.ratio, 100);  // 12 m are 340 points of 390, and 680 at 1:50
  ASSERT_EQ(house.tiles.size(), 1u);
  EXPECT_EQ(house.tiles[0].name, "");
  const SheetLayout tower = lay_out(box(5, 20), grid(5, 20, 2), 200, 196);
  EXPECT_GT(tower.paper.height, tower.paper.width) << "an upright site on an upright sheet";
}

TEST(SheetLayout, AMetreIsAMetreOverTheRatio) {
  for (const double size : {3.0, 11.0, 70.0, 400.0}) {
    const SheetLayout layout = lay_out(box(size, size / 2), grid(size, size / 2, size / 6), 500, 196);
    EXPECT_NEAR(layout.points_per_metre() * layout.ratio, 72 / 0.0254, 1e-9);
    for (const MapTile& tile : layout.tiles) {
      EXPECT_NEAR(tile.window.size().x * layout.points_per_metre(), tile.map.width, 1e-6);
      EXPECT_NEAR(tile.window.size().y * layout.points_per_metre(), tile.map.height, 1e-6);
      EXPECT_LE(tile.map.right(), layout.map.right() + 1e-6);
      EXPECT_LE(tile.map.bottom(), layout.map.bottom() + 1e-6);
    }
  }
}

TEST(SheetLayout, ALargeStoreyIsOnA3AndALargerOneOnSeveralSheets) {
  const SheetLayout hall = lay_out(box(60, 40), grid(60, 40, 6), 200, 196);
  EXPECT_EQ(hall.paper.name, "A3");
  EXPECT_EQ(hall.ratio, 200);
  EXPECT_EQ(hall.tiles.size(), 1u);
  const auto spots = grid(150, 90, 9);
  const SheetLayout works = lay_out(box(150, 90), spots, 200, 196);
  EXPECT_EQ(works.ratio, 200);
  EXPECT_GT(works.tiles.size(), 4u);
  std::set<std::string> names;
  for (const MapTile& tile : works.tiles) names.insert(tile.name);
  EXPECT_EQ(names.size(), works.tiles.size());
  EXPECT_TRUE(names.contains("A1"));
  for (const Vec3& spot : spots)
    EXPECT_TRUE(std::ranges::any_of(works.tiles,
                                    [&](const MapTile& tile) {
                                      return spot.x >= tile.window.min.x && spot.x <= tile.window.max.x &&
                                             spot.y >= tile.window.min.y && spot.y <= tile.window.max.y;
                                    }))
        << spot.x << ' ' << spot.y << " is on no sheet";
  const Box& first = works.tiles[0].window;
  EXPECT_NEAR(first.max.y, 190, 1e-6) << "A1 is in the north-west";
  EXPECT_NEAR(first.min.x, 500'000, 1e-6);
  EXPECT_EQ(lay_out_overview(box(150, 90), 196).tiles.size(), 1u);
}

// A tunnel or a street: alone across a sheet, it would leave most of it empty.
TEST(SheetLayout, ALongSiteIsInStrips) {
  for (const bool in_x : {true, false}) {
    const Box site = in_x ? box(100, 6) : box(6, 100);
    const auto spots = in_x ? grid(100, 6, 6) : grid(6, 100, 6);
    const SheetLayout tunnel = lay_out(site, spots, 200, 196);
    EXPECT_TRUE(tunnel.strips);
    EXPECT_EQ(tunnel.sheets(), 1u);
    EXPECT_LE(tunnel.ratio, 200);
    ASSERT_GE(tunnel.tiles.size(), 2u);
    double drawn = 0;
    for (std::size_t k = 0; k < tunnel.tiles.size(); ++k) {
      const MapTile& tile = tunnel.tiles[k];
      EXPECT_EQ(tile.name, std::to_string(k + 1));
      drawn += tile.map.width * tile.map.height;
      for (std::size_t other = 0; other < k; ++other) EXPECT_FALSE(tile.map.overlaps(tunnel.tiles[other].map));
    }
    EXPECT_GT(drawn, 0.5 * tunnel.map.width * tunnel.map.height) << "of what is left for maps";
    for (const Vec3& spot : spots)
      EXPECT_TRUE(std::ranges::any_of(tunnel.tiles,
                                      [&](const MapTile& tile) {
                                        return spot.x >= tile.window.min.x && spot.x <= tile.window.max.x &&
                                               spot.y >= tile.window.min.y && spot.y <= tile.window.max.y;
                                      }))
          << spot.x << ' ' << spot.y;
  }
  const SheetLayout long_one = lay_out(box(1500, 8), grid(1500, 8, 8), 200, 196);
  EXPECT_TRUE(long_one.strips);
  EXPECT_LT(long_one.sheets(), long_one.tiles.size() / 2);
  EXPECT_FALSE(lay_out(box(60, 40), grid(60, 40, 6), 200, 196).strips);
}

TEST(SheetLayout, NoTwoSheetsShowTheSame) {
  for (const double width : {67.0, 70.0, 90.0, 130.0, 150.0, 201.0})
    for (const double depth : {55.0, 57.0, 80.0, 120.0}) {
      const SheetLayout layout = lay_out(box(width, depth), grid(width, depth, 9), 200, 196);
      for (const MapTile& a : layout.tiles)
        for (const MapTile& b : layout.tiles) {
          if (&a == &b) continue;
          const double dx = std::min(a.window.max.x, b.window.max.x) - std::max(a.window.min.x, b.window.min.x);
          const double dy = std::min(a.window.max.y, b.window.max.y) - std::max(a.window.min.y, b.window.min.y);
          const double both = std::max(0.0, dx) * std::max(0.0, dy);
          EXPECT_LT(both, 0.3 * a.window.size().x * a.window.size().y)
              << width << " x " << depth << ": " << a.name << " and " << b.name;
        }
    }
}

TEST(SheetLayout, CrowdedStationsTakeAFinerRatio) {
  EXPECT_LT(lay_out(box(30, 20), grid(30, 20, 0.8), 500, 196).ratio,
            lay_out(box(30, 20), grid(30, 20, 5), 500, 196).ratio);
}

}  // namespace
}  // namespace vantage
