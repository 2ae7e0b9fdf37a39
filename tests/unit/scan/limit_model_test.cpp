// SPDX-License-Identifier: Apache-2.0
#include "scan/limit_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "scan/noise_model.hpp"
#include "support/quad_scene.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

constexpr double pi = 3.141592653589793;

// A wall 20 m square at x = 5, facing the head at the origin.
test::QuadScene wall(double detail_m, double accuracy_m) {
  test::QuadScene scene;
  scene.quad({5, -10, -10}, {0, 20, 0}, {0, 0, 20}, Role::surveyed, 0.8);
  scene.data().meshes[0].detail_m = detail_m;
  scene.data().meshes[0].accuracy_m = accuracy_m;
  return scene;
}

Scanner rtc360_scanner() {
  Scanner scanner = test::coarse_scanner(0.5);
  scanner.noise = rtc360_noise();
  scanner.beam_divergence = Angle::radians(5e-4);
  scanner.exit_diameter_m = 0.006;
  return scanner;
}

NetworkCounts count(const test::QuadScene& scene, const Scanner& scanner, SimulatorConfig config) {
  config.engine = Engine::embree;
  config.user_size_m = 0.5;
  config.noise = false;
  return Simulator(scene.scene(), scanner, config).evaluate({{Vec3{0, 0, 0}}});
}

// Number of rays that hit the wall and whose direction's x satisfies `counts`.
template <class Counts>
std::uint64_t expected(const Scanner& scanner, const Counts& counts) {
  std::uint64_t n = 0;
  for (std::uint64_t ray = 0; ray < scanner.rays(); ++ray) {
    const RayAngles angles = scanner.angles(ray);
    const double sine = std::sin(angles.zenith.in_radians());
    const double x = sine * std::cos(angles.azimuth.in_radians()), y = sine * std::sin(angles.azimuth.in_radians()),
                 z = std::cos(angles.zenith.in_radians());
    if (x > 0 && std::abs(5 * y / x) < 10 && std::abs(5 * z / x) < 10) n += counts(x) ? 1 : 0;
  }
  return n;
}

TEST(LimitModel, OfAWallSquareOnAnIncidenceLeavesADisc) {
  const test::QuadScene scene = wall(0, 0);
  const Scanner scanner = rtc360_scanner();
  const std::uint64_t all = expected(scanner, [](double) { return true; });
  EXPECT_TRUE(count(scene, scanner, {}).dropped.empty());
  EXPECT_EQ(count(scene, scanner, {}).points_on_surveyed[0], all);
  for (const double degrees : {20.3, 45.1, 59.9}) {
    const NetworkCounts counts = count(scene, scanner, {.max_incidence = Angle::degrees(degrees)});
    const std::uint64_t within =
        expected(scanner, [&](double cosine) { return std::acos(cosine) <= degrees * pi / 180; });
    EXPECT_EQ(counts.points_on_surveyed[0], within) << degrees;
    EXPECT_EQ(counts.dropped[0], (DroppedPoints{all - within, all - within, 0, 0})) << degrees;
  }
  const NetworkCounts any = count(scene, scanner, {.max_incidence = Angle::degrees(90)});
  EXPECT_EQ(any.points_on_surveyed[0], all);
}

TEST(LimitModel, AFootprintGrowsWithRangeAndSlant) {
  const Scanner scanner = rtc360_scanner();
  for (const double detail : {0.0091, 0.0113, 0.0157}) {
    const NetworkCounts counts = count(wall(detail, 0), scanner, {.max_incidence = Angle::degrees(90)});
    EXPECT_EQ(counts.points_on_surveyed[0],
              expected(scanner, [&](double cosine) { return (0.006 + 5e-4 * 5 / cosine) / cosine <= detail; }));
  }
  // 60° by default: the beam at 5 m is 8.5 mm wide.
  const NetworkCounts usual = count(wall(1, 0), scanner, {});
  EXPECT_EQ(usual.points_on_surveyed[0], expected(scanner, [](double cosine) { return cosine >= 0.5; }));
  EXPECT_EQ(usual.dropped[0].footprint, 0u);
}

TEST(LimitModel, NoiseIsJudgedWhetherItIsAppliedOrNot) {
  const Scanner scanner = rtc360_scanner();
  const NoiseModel model = make_noise_model(scanner, 1);
  const double limit = 0.00041;
  const auto good = [&](double cosine) { return model_sigma(model, 5 / cosine, 0.8 * cosine) <= limit; };
  const NetworkCounts counts = count(wall(0, limit), scanner, {.max_incidence = Angle::degrees(90)});
  EXPECT_EQ(counts.points_on_surveyed[0], expected(scanner, good));
  EXPECT_GT(counts.points_on_surveyed[0], 1000u);
  EXPECT_GT(counts.dropped[0].noise, 1000u);
}

TEST(LimitModel, OnlySurveyedMeshesHaveLimits) {
  test::QuadScene scene = wall(0.02, 0);
  scene.quad({-5, -10, -10}, {0, 20, 0}, {0, 0, 20}, Role::blocking);
  scene.data().meshes[1].accuracy_m = 1e-6;
  Scanner scanner = rtc360_scanner();
  scanner.noise = {};  // a blocking mesh needs none
  const LimitModel model = make_limit_model(scene.data(), scanner, {});
  ASSERT_EQ(model.meshes.size(), 2u);
  EXPECT_EQ(model.meshes[0].least_cosine_square, 0.25f);
  EXPECT_FLOAT_EQ(model.meshes[0].largest_footprint_square, 4e-4f);
  EXPECT_EQ(model.meshes[1].least_cosine_square, 0.0f);
  EXPECT_EQ(model.meshes[1].largest_sigma, 0.0f);
}

TEST(LimitModel, IsOffWhereNothingAsksForIt) {
  EXPECT_FALSE(make_limit_model(wall(0, 0).data(), rtc360_scanner(), {}).enabled());
  EXPECT_EQ(incidence_limit(wall(0, 0).data(), {}), std::nullopt);
  EXPECT_EQ(incidence_limit(wall(0, 0.001).data(), {}), default_max_incidence);
}

TEST(LimitModel, SaysWhatTheScannerLacks) {
  const auto refusal = [](test::QuadScene scene, const Scanner& scanner, const SimulatorConfig& config = {}) {
    try {
      make_limit_model(scene.data(), scanner, config);
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), Errc::invalid_argument);
      return std::string(e.what());
    }
    return std::string();
  };
  Scanner bare = test::coarse_scanner();
  EXPECT_NE(refusal(wall(0.01, 0), bare).find("\"quad 0\", but the beam of the scanner \"custom\""), std::string::npos);
  EXPECT_NE(refusal(wall(0, 0.01), bare).find("has no noise table"), std::string::npos);
  EXPECT_NE(refusal(wall(0, 0), bare, {.max_incidence = Angle::degrees(0)}).find("above 0°"), std::string::npos);
  EXPECT_NE(refusal(wall(0, 0), bare, {.max_incidence = Angle::degrees(91)}).find("at most 90°"), std::string::npos);
  EXPECT_EQ(refusal(wall(0.01, 0.01), rtc360_scanner()), "");
}

}  // namespace
}  // namespace vantage
