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
      EXPECT_NEAR(tile.window.size().x * layout.points_per_metre(), layout.map.width, 1e-6);
      EXPECT_NEAR(tile.window.size().y * layout.points_per_metre(), layout.map.height, 1e-6);
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

TEST(SheetLayout, CrowdedStationsTakeAFinerRatio) {
  EXPECT_LT(lay_out(box(30, 20), grid(30, 20, 0.8), 500, 196).ratio,
            lay_out(box(30, 20), grid(30, 20, 5), 500, 196).ratio);
}

}  // namespace
}  // namespace vantage
