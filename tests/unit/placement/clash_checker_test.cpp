// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "placement_scenes.hpp"
#include "vantage/error.hpp"
#include "vantage/placement.hpp"

namespace vantage {
namespace {

using test::origin;

Scene wall_and_ground() {
  return test::Builder().floor(-10, -10, 10, 10, 0).quad({2, -5, 0}, {2, 5, 0}, {2, 5, 3}, {2, -5, 3}).scene();
}

TEST(ClashChecker, KeepsTheRadiusFromAWall) {
  const ClashChecker checker(wall_and_ground());
  EXPECT_FALSE(checker.clashes(origin + Vec3{0, 0, 0}));
  EXPECT_FALSE(checker.clashes(origin + Vec3{1.4999, 0, 0}));
  EXPECT_TRUE(checker.clashes(origin + Vec3{1.5001, 0, 0}));
  EXPECT_TRUE(checker.clashes(origin + Vec3{2.4999, 0, 0}));
  EXPECT_FALSE(checker.clashes(origin + Vec3{2.5001, 0, 0}));
}

TEST(ClashChecker, GlassIsKeptClearOfToo) {
  SceneData data = wall_and_ground().data();
  data.meshes = {{.name = "ground", .triangle_count = 2},
                 {.name = "pane", .role = Role::blocking, .triangle_count = 2, .glass = true}};
  data.ranges = {{0, 2, 0}, {2, 2, 0}};
  const ClashChecker checker(Scene(std::make_shared<const SceneData>(data)));
  EXPECT_FALSE(checker.clashes(origin + Vec3{1.4999, 0, 0}));
  EXPECT_TRUE(checker.clashes(origin + Vec3{1.5001, 0, 0}));
  const Vec3 before = origin + Vec3{1, 0, 1}, behind = origin + Vec3{3, 0, 1}, below = origin + Vec3{3, 0, -1};
  EXPECT_FALSE(checker.sees(before, behind));
  EXPECT_TRUE(checker.ray_passes(before, behind));
  EXPECT_FALSE(checker.ray_passes(before, below));
}

TEST(ClashChecker, SightsOfArraysAreThoseOfTheirRows) {
  const ClashChecker checker(wall_and_ground());
  std::vector<Vec3> from, to;
  for (int k = 0; k < 2000; ++k) {
    from.push_back(origin + Vec3{-2 + 0.003 * k, 0.1, 1});
    to.push_back(origin + Vec3{4, 0.2, 1.5 + 0.005 * k});
  }
  const auto sees = checker.sees(from, to), of_one = checker.sees({from.data(), 1}, to),
             to_one = checker.sees(from, {to.data(), 1});
  ASSERT_EQ(sees.size(), from.size());
  ASSERT_EQ(of_one.size(), from.size());
  ASSERT_EQ(to_one.size(), from.size());
  for (std::size_t k = 0; k < from.size(); ++k) {
    ASSERT_EQ(sees[k] != 0, checker.sees(from[k], to[k])) << k;
    ASSERT_EQ(of_one[k] != 0, checker.sees(from[0], to[k])) << k;
    ASSERT_EQ(to_one[k] != 0, checker.sees(from[k], to[0])) << k;
  }
  EXPECT_GT(std::ranges::count(sees, 1), 100);
  EXPECT_GT(std::ranges::count(sees, 0), 100);
  EXPECT_TRUE(checker.sees(std::span<const Vec3>(), std::span<const Vec3>()).empty());
  const auto refusal = [&] {
    try {
      checker.sees(from, to);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  to[7].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal().find("row 7, counted from 0, of b"), std::string::npos) << refusal();
  to.resize(5);
  EXPECT_NE(refusal().find("2000 points and 5"), std::string::npos) << refusal();
}

TEST(ClashChecker, EitherSphereCounts) {
  const SecurityVolume volume{.lower_m = 0.6, .upper_m = 1.5, .radius_m = 0.4};
  const Scene beam = test::Builder().box({0, -1, 1.9}, {0.1, 1, 2.5}).scene(),
              kerb = test::Builder().box({0, -1, 0}, {0.1, 1, 0.21}).scene();
  EXPECT_FALSE(ClashChecker(beam, volume).clashes(origin + Vec3{0.05, 0, -0.0001}));
  EXPECT_TRUE(ClashChecker(beam, volume).clashes(origin + Vec3{0.05, 0, 0.0001}));
  EXPECT_FALSE(ClashChecker(kerb, volume).clashes(origin + Vec3{0.05, 0, 0.0101}));
  EXPECT_TRUE(ClashChecker(kerb, volume).clashes(origin + Vec3{0.05, 0, 0.0099}));
}

// The head stands above the spheres; obstacles there count, too, and so does the mast.
TEST(ClashChecker, HeadAndMastKeepClear) {
  const ClashChecker shelf(test::Builder().floor(-5, -5, 5, 5, 0).box({0, -1, 2.5}, {3, 1, 2.6}).scene());
  const double out = -0.06;  // outside the shelf: beyond the mast's 0.05 m, within the head's 0.1 m
  const auto at = [&](double x, double height) { return shelf.clashes(origin + Vec3{x, 0, 0}, height); };
  EXPECT_FALSE(shelf.clashes(origin + Vec3{1, 0, 0}));
  EXPECT_FALSE(at(1, 2.3999));
  EXPECT_TRUE(at(1, 2.4001));
  EXPECT_TRUE(at(1, 2.55)) << "the head is in it";
  EXPECT_TRUE(at(1, 3)) << "the mast goes through it";
  EXPECT_TRUE(at(-0.0499, 3));
  EXPECT_FALSE(at(-0.0501, 3));
  EXPECT_TRUE(at(out, 2.55));
  EXPECT_FALSE(at(out, 3));
  EXPECT_FALSE(at(out - 0.05, 2.55));
  EXPECT_FALSE(at(-3, 1.85)) << "the ground itself is no obstacle to the mast";
}

TEST(ClashChecker, TheMastCountsBetweenSpheresThatLieApart) {
  const SecurityVolume volume{.lower_m = 0.6, .upper_m = 3, .radius_m = 0.4};
  const ClashChecker plate(test::Builder().box({0, -1, 1.5}, {1, 1, 1.6}).scene(), volume);
  EXPECT_FALSE(plate.clashes(origin + Vec3{0.5, 0, 0}));
  EXPECT_TRUE(plate.clashes(origin + Vec3{0.5, 0, 0}, 3.4));
  EXPECT_TRUE(plate.clashes(origin + Vec3{-0.039, 0, 0}, 3.4)) << "a tenth of the radius";
  EXPECT_FALSE(plate.clashes(origin + Vec3{-0.041, 0, 0}, 3.4));
  EXPECT_FALSE(plate.clashes(origin + Vec3{0.5, 0, 0}, 1.4)) << "the head is below it";
}

TEST(ClashChecker, FindsTheGroundBelow) {
  const ClashChecker checker(wall_and_ground());
  EXPECT_NEAR(checker.ground_below(origin + Vec3{1, 1, 1.8}, 2).value().z, 30, 1e-9);
  EXPECT_FALSE(checker.ground_below(origin + Vec3{1, 1, 2.2}, 2));
  EXPECT_FALSE(checker.ground_below(origin + Vec3{1, 1, -1}, 100));
}

TEST(ClashChecker, BlockingMeshesClashToo) {
  SceneData data = test::Builder().box({0, -1, 0}, {0.1, 1, 3}).data();
  data.meshes[0].role = Role::blocking;
  EXPECT_TRUE(ClashChecker(Scene(std::make_shared<const SceneData>(data))).clashes(origin + Vec3{0.3, 0, 0}));
}

TEST(ClashChecker, RadiusZeroSwitchesItOff) {
  const ClashChecker off(wall_and_ground(), {.lower_m = 0, .upper_m = 0, .radius_m = 0});
  EXPECT_FALSE(off.clashes(origin + Vec3{2, 0, 0}));
}

TEST(ClashChecker, MeasuresDistancesInTheSurveyFrame) {
  const ClashChecker checker(wall_and_ground());
  EXPECT_NEAR(checker.distance(origin + Vec3{1, 0, 1.5}, 10), 1, 1e-12);
  EXPECT_NEAR(checker.distance(origin + Vec3{1, 0, 0.25}, 10), 0.25, 1e-12);
  EXPECT_NEAR(checker.distance(origin + Vec3{1, 0, 0.25}, 0.1), 0.1, 1e-12);
  EXPECT_NEAR(checker.distance(origin + Vec3{5, 6, 4}, 100), std::sqrt(9 + 1 + 1), 1e-12);
}

TEST(ClashChecker, SeesWhatNothingHides) {
  const ClashChecker checker(wall_and_ground());  // the wall begins at x = 2
  EXPECT_TRUE(checker.sees(origin + Vec3{-1, 0, 1}, origin + Vec3{1.99, 0, 1}));
  EXPECT_FALSE(checker.sees(origin + Vec3{-1, 0, 1}, origin + Vec3{2.5, 0, 1}));
  EXPECT_FALSE(checker.sees(origin + Vec3{2.5, 0, 1}, origin + Vec3{-1, 0, 1}));
  EXPECT_TRUE(checker.sees(origin + Vec3{-1, 0, 1}, origin + Vec3{-1, 0, 1}));
}

TEST(ClashChecker, RefusesVolumesThatMakeNoSense) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  for (const SecurityVolume& volume : {SecurityVolume{0.5, 1.35, 0.5},
                                       {0.6, 1.35, -0.1},
                                       {-1, 1.35, 0.5},
                                       {0.6, nan, 0.5},
                                       {0.6, 1.35, inf},
                                       {0, 1.35, 0.5}}) {
    try {
      ClashChecker(wall_and_ground(), volume);
      FAIL() << volume.lower_m << ' ' << volume.upper_m << ' ' << volume.radius_m;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), Errc::invalid_argument);
      EXPECT_NE(std::string(e.what()).find("security volume"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace vantage
