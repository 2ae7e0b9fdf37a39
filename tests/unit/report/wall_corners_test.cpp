// SPDX-License-Identifier: Apache-2.0
#include "report/wall_corners.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace vantage {
namespace {

using Lines = std::vector<std::array<Vec3, 2>>;

// A box's outline, each side in `pieces`, turned around its middle.
void add_box(Lines& lines, double x, double y, double width, double depth, double turn = 0, int pieces = 2) {
  const auto at = [&](double a, double b) {
    const double dx = (a - 0.5) * width, dy = (b - 0.5) * depth;
    return Vec3{x + dx * std::cos(turn) - dy * std::sin(turn), y + dx * std::sin(turn) + dy * std::cos(turn), 1.2};
  };
  const Vec3 corners[] = {at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
  for (int side = 0; side < 4; ++side) {
    const Vec3 &a = corners[side], &b = corners[(side + 1) % 4];
    for (int p = 0; p < pieces; ++p)
      lines.push_back({a + (b - a) * (static_cast<double>(p) / pieces), a + (b - a) * ((p + 1.0) / pieces)});
  }
}

TEST(WallCorners, OfARoomAreItsFour) {
  Lines room;
  add_box(room, 2.5, 2, 5, 4);
  const WallCorners corners(room);
  EXPECT_EQ(corners.corners().size(), 4u);
  const auto two = corners.nearest(1, 1.5);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_NEAR(two[0].distance_m, std::hypot(1, 1.5), 5e-3);
  EXPECT_NEAR(two[1].distance_m, std::hypot(1, 2.5), 5e-3);
  EXPECT_NEAR(two[1].x, 0, 1e-9);
  EXPECT_NEAR(two[1].y, 4, 1e-9);
  EXPECT_TRUE(corners.nearest(100, 100).empty()) << "out of a tape's reach";
}

TEST(WallCorners, AreWhereWallsMeetWithoutACommonPoint) {
  const Lines walls{{Vec3{0, 0, 0}, Vec3{6, 0, 0}}, {Vec3{3, 0, 0}, Vec3{3, 4, 0}}, {Vec3{5, -1, 0}, Vec3{5, 4, 0}}};
  const WallCorners corners(walls);
  const std::vector<std::array<double, 2>> wanted{{3, 0}, {5, 0}};
  ASSERT_EQ(corners.corners().size(), 2u);
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t c = 0; c < 2; ++c) EXPECT_NEAR(corners.corners()[k][c], wanted[k][c], 1e-9);
  EXPECT_TRUE(corners.sees(4, 2, 5, 0));
  EXPECT_FALSE(corners.sees(2, 2, 5, 0)) << "a wall is between";
}

TEST(WallCorners, BesideALongWallAreACornerAndTheWall) {
  const Lines walls{
      {Vec3{0, 0, 0}, Vec3{20, 0, 0}}, {Vec3{0, 0, 0}, Vec3{0, -1, 0}}, {Vec3{20, 0, 0}, Vec3{20, -1, 0}}};
  const auto two = WallCorners(walls).nearest(8, 0.5);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_FALSE(two[0].wall);
  EXPECT_NEAR(two[0].distance_m, std::hypot(8, 0.5), 1e-9);
  EXPECT_TRUE(two[1].wall) << "both corners lie in one line with the spot";
  EXPECT_NEAR(two[1].distance_m, 0.5, 1e-9);
}

TEST(WallCorners, OfWhatDoesNotReachOverHeadsAreNone) {
  Lines low, high;
  add_box(low, 0, 0, 20, 12), add_box(high, 0, 0, 20, 12);  // a yard with walls
  add_box(low, 3, 2, 4.4, 1.8);                             // a car in it
  EXPECT_EQ(WallCorners(low).corners().size(), 8u);
  const WallCorners fixed(low, high);
  EXPECT_EQ(fixed.corners().size(), 4u);
  for (const WallCorner& corner : fixed.nearest(3, 0)) {
    EXPECT_NEAR(std::abs(corner.x), 10, 1e-9);
    EXPECT_NEAR(corner.y, -6, 1e-9) << "the car hides the others";
  }
  EXPECT_TRUE(WallCorners(low, Lines{}).nearest(3, 0).empty()) << "nothing stays";
}

// The wall goes on over a door, whose jambs are as good as corners.
TEST(WallCorners, JambsOfADoorStay) {
  const Lines low{{Vec3{0, 0, 0}, Vec3{4, 0, 0}},
                  {Vec3{4, 0, 0}, Vec3{4, 0.3, 0}},
                  {Vec3{5, 0.3, 0}, Vec3{5, 0, 0}},
                  {Vec3{5, 0, 0}, Vec3{9, 0, 0}}};
  const Lines high{{Vec3{0, 0, 0}, Vec3{9, 0, 0}}};
  const WallCorners corners(low, high);
  EXPECT_EQ(corners.corners().size(), 2u);
}

TEST(WallCorners, RoundColumnsAndRailsHaveNone) {
  Lines column;
  for (int k = 0; k < 40; ++k) {
    const auto at = [](int n) { return Vec3{std::cos(n * 0.15708), std::sin(n * 0.15708), 0} * 0.3; };
    column.push_back({at(k), at(k + 1)});
  }
  add_box(column, 3, 0, 0.05, 0.05);
  EXPECT_TRUE(WallCorners(column).corners().empty());
}

// The results of the class, without its cells.
struct BruteForce {
  Lines lines;
  std::vector<std::array<double, 2>> corners;

  static double turn(const Vec3& a, const Vec3& b) { return a.x * b.y - a.y * b.x; }
  explicit BruteForce(const Lines& all) : lines(all) {
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t j = i + 1; j < all.size(); ++j) {
        const Vec3 a = all[i][1] - all[i][0], b = all[j][1] - all[j][0], between = all[j][0] - all[i][0];
        const double la = std::sqrt(dot(a, a)), lb = std::sqrt(dot(b, b));
        if (std::abs(dot(a, b)) > std::cos(30 * 0.017453292519943295) * la * lb) continue;
        const double s = turn(between, b) / turn(a, b), t = turn(between, a) / turn(a, b);
        if (std::min(s * la, t * lb) < -2e-3 || (s - 1) * la > 2e-3 || (t - 1) * lb > 2e-3) continue;
        const Vec3 at = all[i][0] + a * s;
        corners.push_back({at.x, at.y});
      }
  }
  bool sees(const Vec3& from, const Vec3& to) const {
    const Vec3 way = to - from;
    const double length = std::hypot(way.x, way.y), share = 1 - 0.01 / length;
    return std::ranges::none_of(lines, [&](const std::array<Vec3, 2>& line) {
      const Vec3 b = line[1] - line[0], between = line[0] - from, a = way * share;
      if (turn(a, b) == 0) return false;
      const double s = turn(between, b) / turn(a, b), t = turn(between, a) / turn(a, b);
      return s > 0 && s < 1 && t >= 0 && t <= 1;
    });
  }
  double least_sum(const Vec3& from) const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& a : corners)
      for (const auto& b : corners) {
        const Vec3 to_a = Vec3{a[0], a[1], 0} - from, to_b = Vec3{b[0], b[1], 0} - from;
        const double la = std::hypot(to_a.x, to_a.y), lb = std::hypot(to_b.x, to_b.y);
        if (std::max(la, lb) > 30 || la + lb >= least) continue;
        const double angle =
            std::acos(std::clamp((to_a.x * to_b.x + to_a.y * to_b.y) / (la * lb), -1.0, 1.0)) * 57.29577951;
        if (angle < 30 || angle > 150 || !sees(from, from + to_a) || !sees(from, from + to_b)) continue;
        least = la + lb;
      }
    return least;
  }
};

TEST(WallCorners, AreTheBestPairByBruteForce) {
  std::mt19937 random(7);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int found = 0;
  for (int site = 0; site < 12; ++site) {
    Lines lines;
    add_box(lines, 0, 0, 24, 18);
    for (int k = 0; k < 14; ++k)
      add_box(lines, uniform(-10, 10), uniform(-7, 7), uniform(0.4, 5), uniform(0.4, 2), uniform(0, 3));
    const WallCorners corners(lines);
    const BruteForce brute(lines);
    for (int k = 0; k < 20; ++k) {
      const Vec3 spot{uniform(-11, 11), uniform(-8, 8), 0};
      const auto two = corners.nearest(spot.x, spot.y);
      const double least = brute.least_sum(spot);
      if (two.size() < 2 || two[1].wall) {
        EXPECT_FALSE(std::isfinite(least)) << site << ": " << spot.x << ' ' << spot.y;
        continue;
      }
      ++found;
      // one corner stands for all within 5 mm
      EXPECT_NEAR(two[0].distance_m + two[1].distance_m, least, 0.015) << site << ": " << spot.x << ' ' << spot.y;
      EXPECT_LE(two[0].distance_m, two[1].distance_m);
    }
  }
  EXPECT_GT(found, 150);
}

}  // namespace
}  // namespace vantage
