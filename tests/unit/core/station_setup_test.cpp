// SPDX-License-Identifier: Apache-2.0
#include "vantage/station_setup.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vantage {
namespace {

Vec3 in_survey(const StationSetup& setup, const Vec3& d) {
  const auto rows = setup.survey_from_scanner();
  return {dot(rows[0], d), dot(rows[1], d), dot(rows[2], d)};
}

TEST(StationSetup, StandsUprightUnlessItIsTurned) {
  EXPECT_FALSE(StationSetup().turned());
  EXPECT_FALSE((StationSetup{.scanner = 3}).turned());
  EXPECT_TRUE((StationSetup{.heading = Angle::degrees(1)}).turned());
  EXPECT_TRUE((StationSetup{.tilt = Angle::degrees(1)}).turned());
  EXPECT_EQ(in_survey({}, {1, 2, 3}), (Vec3{1, 2, 3}));
}

TEST(StationSetup, QuarterTurnsAreExact) {
  // The heading turns x towards y.
  EXPECT_EQ(in_survey({.heading = Angle::degrees(90)}, {1, 2, 3}), (Vec3{-2, 1, 3}));
  EXPECT_EQ(in_survey({.heading = Angle::degrees(-180)}, {1, 2, 3}), (Vec3{-1, -2, 3}));
  // A lying head has its axis along the heading; one at 180° hangs.
  EXPECT_EQ(in_survey({.tilt = Angle::degrees(90)}, {0, 0, 1}), (Vec3{1, 0, 0}));
  EXPECT_EQ(in_survey({.heading = Angle::degrees(90), .tilt = Angle::degrees(90)}, {0, 0, 1}), (Vec3{0, 1, 0}));
  EXPECT_EQ(in_survey({.tilt = Angle::degrees(180)}, {0, 0, 1}), (Vec3{0, 0, -1}));
}

TEST(StationSetup, TurnsByRodriguesFormula) {
  std::mt19937 random(3);
  const auto angle = [&] { return 6.2831853 * (random() / 4294967296.0) - 3.14; };
  // Rotation about a unit axis k: d cos a + (k × d) sin a + k (k · d)(1 − cos a).
  const auto about = [](const Vec3& k, double a, const Vec3& d) {
    return d * std::cos(a) + cross(k, d) * std::sin(a) + k * (dot(k, d) * (1 - std::cos(a)));
  };
  for (int trial = 0; trial < 100; ++trial) {
    const double heading = angle(), tilt = angle();
    const Vec3 d{std::cos(angle()), std::sin(angle()), angle()};
    const Vec3 expected = about({0, 0, 1}, heading, about({0, 1, 0}, tilt, d));
    const Vec3 got = in_survey({.heading = Angle::radians(heading), .tilt = Angle::radians(tilt)}, d);
    EXPECT_NEAR(got.x, expected.x, 1e-14);
    EXPECT_NEAR(got.y, expected.y, 1e-14);
    EXPECT_NEAR(got.z, expected.z, 1e-14);
  }
}

}  // namespace
}  // namespace vantage
