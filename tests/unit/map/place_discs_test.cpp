// SPDX-License-Identifier: Apache-2.0
#include "map/place_discs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vantage {
namespace {

constexpr Rect kPage{0, 0, 700, 600};
constexpr double kRadius = 10;

double distance(Point a, Point b) { return std::hypot(a.x - b.x, a.y - b.y); }

void expect_readable(const std::vector<Point>& anchors, const std::vector<Point>& discs) {
  ASSERT_EQ(discs.size(), anchors.size());
  for (std::size_t i = 0; i < discs.size(); ++i) {
    EXPECT_GE(discs[i].x, kRadius);
    EXPECT_LE(discs[i].x, kPage.right() - kRadius);
    EXPECT_GE(discs[i].y, kRadius);
    EXPECT_LE(discs[i].y, kPage.bottom() - kRadius);
    for (std::size_t j = 0; j < discs.size(); ++j) {
      EXPECT_TRUE(j == i || distance(discs[i], discs[j]) >= 2 * kRadius) << i << " on " << j;
      const bool own_place = i == j && distance(discs[i], anchors[i]) < 1e-9;
      EXPECT_TRUE(own_place || distance(discs[i], anchors[j]) > kRadius) << i << " hides the spot of " << j;
    }
  }
}

TEST(PlaceDiscs, StayWhereThereIsRoom) {
  const std::vector<Point> anchors{{100, 100}, {200, 100}, {300, 250}};
  const auto discs = place_discs(anchors, kRadius, kPage);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(distance(discs[k], anchors[k]), 0);
}

TEST(PlaceDiscs, OfStationsOnOneSpotEachIsSeenAndTheSpotToo) {
  std::vector<Point> anchors(9, Point{50, 50});
  anchors.push_back({200, 200});
  const auto discs = place_discs(anchors, kRadius, kPage);
  expect_readable(anchors, discs);
  EXPECT_EQ(distance(discs[9], anchors[9]), 0);
  for (std::size_t k = 0; k < 9; ++k) EXPECT_LT(distance(discs[k], anchors[k]), 80);
}

TEST(PlaceDiscs, CrowdsAreReadable) {
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    std::vector<Point> anchors;
    for (int k = 0; k < 40; ++k)
      anchors.push_back({15 + static_cast<double>(random() % 330), 15 + static_cast<double>(random() % 280)});
    expect_readable(anchors, place_discs(anchors, kRadius, kPage));
  }
}

TEST(PlaceDiscs, AtTheBorderTheyComeInside) {
  const std::vector<Point> anchors{{2, 2}, {698, 300}, {350, 599}};
  expect_readable(anchors, place_discs(anchors, kRadius, kPage));
}

}  // namespace
}  // namespace vantage
