// SPDX-License-Identifier: Apache-2.0
#include "placement/in_the_way.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "placement_scenes.hpp"

namespace vantage {
namespace {

using test::origin;

// A wall along x with an opening of so much in its middle.
ClashChecker wall_with_opening(double wide_m, double thick_m) {
  const double half = wide_m / 2, y = thick_m / 2;
  return ClashChecker(test::Builder()
                          .floor(-6, -6, 6, 6, 0)
                          .box({-6, -y, 0}, {-half, y, 2.5})
                          .box({half, -y, 0}, {6, y, 2.5})
                          .box({-half, -y, 2.1}, {half, y, 2.5})
                          .scene());
}

TEST(InTheWay, ADoorwayAndWhereItsLeafSwings) {
  for (const double thick : {0.1, 0.3}) {
    const ClashChecker door = wall_with_opening(0.9, thick);
    EXPECT_TRUE(in_passage(door, origin + Vec3{0, 0, 1.5}));
    EXPECT_FALSE(in_passage(door, origin + Vec3{0, 0.9, 1.5}));
    EXPECT_TRUE(in_the_way(door, origin + Vec3{0, 0, 0}));
    EXPECT_TRUE(in_the_way(door, origin + Vec3{0.2, 0.8, 0})) << thick;
    EXPECT_TRUE(in_the_way(door, origin + Vec3{-0.2, -0.8, 0})) << thick;
    EXPECT_FALSE(in_the_way(door, origin + Vec3{0, 1.4, 0})) << thick;
    EXPECT_FALSE(in_the_way(door, origin + Vec3{3, 0.7, 0})) << "beside a wall";
    EXPECT_FALSE(in_the_way(wall_with_opening(2.4, thick), origin + Vec3{0, 0.8, 0})) << "too wide for a leaf";
  }
}

// Eight treads of 0.28 m that fall by 0.18 m each along x from a landing.
TEST(InTheWay, AStairAndItsTopStep) {
  test::Builder builder;
  builder.floor(-6, -3, 0, 3, 0);
  for (int k = 0; k < 8; ++k) builder.floor(0.28 * k, -0.6, 0.28 * (k + 1), 0.6, -0.18 * (k + 1));
  builder.floor(0.28 * 8, -3, 9, 3, -0.18 * 9);
  const ClashChecker stair(builder.scene());
  EXPECT_TRUE(on_steps(stair, origin + Vec3{-0.2, 0, 0})) << "by the top step";
  EXPECT_TRUE(on_steps(stair, origin + Vec3{0.7, 0.1, -0.54})) << "on the stair";
  EXPECT_FALSE(on_steps(stair, origin + Vec3{-1.2, 0, 0}));
  EXPECT_FALSE(on_steps(stair, origin + Vec3{-0.2, 2, 0})) << "by an edge of the landing";
  EXPECT_FALSE(on_steps(stair, origin + Vec3{3, 0, -0.18 * 9})) << "at its foot";
  EXPECT_TRUE(in_the_way(stair, origin + Vec3{-0.2, 0, 0}));
}

// A loft 3 m over a floor, with a rail along half of its edge at x = 0.
TEST(InTheWay, TheEdgeOfALoftUnlessARailIsThere) {
  const ClashChecker loft(
      test::Builder().floor(-6, -6, 6, 6, 0).box({-6, -6, 2.8}, {0, 6, 3}).box({-0.05, 0, 3}, {0, 6, 4}).scene());
  EXPECT_TRUE(at_brink(loft, origin + Vec3{-0.3, -3, 3}));
  EXPECT_TRUE(better_aside(loft, origin + Vec3{-0.3, -3, 3}));
  EXPECT_FALSE(in_the_way(loft, origin + Vec3{-0.3, -3, 3}));
  EXPECT_FALSE(at_brink(loft, origin + Vec3{-0.5, -3, 3}));
  EXPECT_FALSE(at_brink(loft, origin + Vec3{-0.3, 3, 3})) << "a rail";
  EXPECT_FALSE(at_brink(loft, origin + Vec3{1, -3, 0})) << "below it";
  EXPECT_FALSE(at_brink(loft, origin + Vec3{5.8, 3, 0})) << "the model ends";
  EXPECT_FALSE(at_brink(loft, origin + Vec3{3, -3, 2})) << "ground that is none of the model's";
}

TEST(InTheWay, AGapInTheFloorAndAHighStepAreNoDrop) {
  for (const double gap : {0.1, 0.7}) {
    const ClashChecker floors(
        test::Builder().floor(-6, -6, 0, 6, 0).floor(gap, -6, 6, 6, 0).floor(-6, -6, 6, 6, -2).scene());
    EXPECT_EQ(at_brink(floors, origin + Vec3{-0.4, 0, 0}), gap > 0.5) << gap;
  }
  const ClashChecker step(test::Builder().floor(-6, -6, 0, 6, 0.4).floor(0, -6, 6, 6, 0).scene());
  EXPECT_FALSE(at_brink(step, origin + Vec3{-0.2, 0, 0.4}));
}

TEST(InTheWay, KerbsAndRampsBarNothing) {
  const ClashChecker ramp(test::Builder().quad({0, -3, 0}, {20, -3, 3}, {20, 3, 3}, {0, 3, 0}).scene());
  EXPECT_FALSE(on_steps(ramp, origin + Vec3{10, 0, 1.5})) << "15 %";
  for (const double fall : {0.35, 0.45, 1.4}) {  // a hillside, and a bank beside its edge
    test::Builder hill;
    hill.floor(-6, -3, 0, 3, 0).quad({0, -3, 0}, {4, -3, -4 * fall}, {4, 3, -4 * fall}, {0, 3, 0});
    const ClashChecker slope(hill.scene());
    for (const double x : {-0.4, -0.3, -0.2, 0.3, 1.0})
      EXPECT_FALSE(on_steps(slope, origin + Vec3{x, 0, -fall * std::max(x, 0.0)})) << fall << " at " << x;
  }
  const ClashChecker kerb(test::Builder().floor(-5, -5, 0, 5, 0.15).floor(0, -5, 5, 5, 0).scene());
  EXPECT_FALSE(on_steps(kerb, origin + Vec3{-0.2, 0, 0.15}));
}

}  // namespace
}  // namespace vantage
