// SPDX-License-Identifier: Apache-2.0
#include "scan/limit_model.hpp"

#include <gtest/gtest.h>

#include <array>
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
    EXPECT_EQ(counts.dropped[0], (DroppedPoints{all - within, all - within, 0, 0, 0})) << degrees;
  }
  const NetworkCounts any = count(scene, scanner, {.max_incidence = Angle::degrees(90)});
  EXPECT_EQ(any.points_on_surveyed[0], all);
}

TEST(LimitModel, AFootprintGrowsWithRangeAndSlant) {
  const Scanner scanner = rtc360_scanner();
  for (const double detail : {0.0068, 0.0083, 0.0121}) {
    const NetworkCounts counts = count(wall(detail, 0), scanner, {.max_incidence = Angle::degrees(90)});
    EXPECT_EQ(counts.points_on_surveyed[0], expected(scanner, [&](double cosine) {
                return std::hypot(0.006, 5e-4 * 5 / cosine) / cosine <= detail;
              }));
  }
  // 60° by default: the beam at 5 m is 6.5 mm wide.
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

// P ∝ ρ cos α / R²: a wall at 5 m is met at 5 / cos α, so cos³ α decides.
TEST(LimitModel, AWeakEchoIsNoPoint) {
  Scanner scanner = rtc360_scanner();
  scanner.detection_reflectivity = 0.4;  // the wall has 0.8
  for (const double range : {3.6, 4.1, 5.5, 9.0}) {
    scanner.detection_range_m = range;
    const double reach = range * std::sqrt(2.0);
    const auto detected = [&](double cosine) { return 5 / cosine <= reach * std::sqrt(cosine); };
    const std::uint64_t all = expected(scanner, [](double) { return true; }), strong = expected(scanner, detected);
    const NetworkCounts counts = count(wall(0, 0), scanner, {});
    EXPECT_EQ(counts.points_on_surveyed[0], strong) << range;
    EXPECT_EQ(counts.dropped[0], (DroppedPoints{all - strong, 0, 0, 0, all - strong})) << range;
    // Nor is it one in a cloud.
    Simulator simulator(wall(0, 0).scene(), scanner, {.engine = Engine::embree, .user_size_m = 0.5, .noise = false});
    EXPECT_EQ(simulator.scan_points({Vec3{0, 0, 0}}).position.size(), strong);
  }
}

// Rays are lost by their numbers and the station's place alone: the same ones however they are counted, whatever else
// is asked of the points, and with or without noise.
TEST(LimitModel, EchoesAreLostAtRandom) {
  Scanner scanner = rtc360_scanner();
  const auto simulator = [&](double dropout, bool noise) {
    scanner.dropout = dropout;
    return Simulator(wall(0, 0).scene(), scanner, {.engine = Engine::embree, .user_size_m = 0.5, .noise = noise});
  };
  Simulator every = simulator(0, false), some = simulator(0.2, false), noisy = simulator(0.2, true),
            noisy_every = simulator(0, true);
  const Station station{Vec3{0, 0, 0}};
  const auto ranges = [&](Simulator& of) {
    std::vector<float> all;
    of.scan(station, {.outputs = scan_range},
            [&](const ScanChunk& chunk) { all.insert(all.end(), chunk.range_m.begin(), chunk.range_m.end()); });
    return all;
  };
  const std::vector<float> whole = ranges(every), part = ranges(some);
  std::uint64_t met = 0, left = 0;
  for (std::size_t k = 0; k < whole.size(); ++k) {
    met += std::isfinite(whole[k]);
    if (!std::isfinite(part[k])) continue;
    ++left;
    EXPECT_EQ(part[k], whole[k]);
  }
  const auto rays = static_cast<double>(met);
  EXPECT_NEAR(static_cast<double>(left), 0.8 * rays, 5 * std::sqrt(0.2 * 0.8 * rays));

  // The same station twice: another place has other rays.
  const NetworkCounts counts = some.evaluate({station, station}, {});
  EXPECT_EQ(counts.points_on_surveyed[0], left);
  EXPECT_EQ(counts.dropped[0], (DroppedPoints{met - left, 0, 0, 0, met - left}));
  EXPECT_NE(counts.points_on_surveyed[1], left);
  const NetworkCounts moved = noisy.evaluate({station}, {});
  EXPECT_EQ(moved.points_on_surveyed[0] + moved.dropped[0].points,
            noisy_every.evaluate({station}, {}).points_on_surveyed[0]);
}

// The ranges that a maker states for some reflectivity, at normal incidence, are those at which a surface vanishes.
TEST(LimitModel, StatedRangesAreReproduced) {
  for (const char* key : {"focus-x330", "vz-400i", "x7", "zf5016", "rtc360"}) {
    Scanner scanner = load_scanner(key);
    scanner.max_range_m = 2000;
    const double stated = scanner.detection_range_m, on = scanner.detection_reflectivity;
    for (const double reflectivity : {0.05, 0.18, 0.9}) {
      const double reach = stated * std::sqrt(reflectivity / on);
      for (const double share : {0.999, 1.001}) {
        test::QuadScene scene;
        // Small, so that it is met squarely, and wide enough for many rays.
        const float x = static_cast<float>(reach * share);
        scene.quad({x, -0.004f * x, -0.004f * x}, {0, 0.008f * x, 0}, {0, 0, 0.008f * x}, Role::surveyed, reflectivity);
        Scanner narrow = scanner;
        narrow.horizontal_angle = Angle::degrees(1), narrow.zenith_start = Angle::degrees(89.5);
        narrow.vertical_angle = Angle::degrees(2);
        SimulatorConfig config{.engine = Engine::embree, .noise = false};
        config.user_size_m = 0.5, config.point_spacing_m = 0.1;
        const NetworkCounts counts = Simulator(scene.scene(), narrow, config).evaluate({{Vec3{0, 0, 0}}});
        EXPECT_GT(counts.points_on_surveyed[0] + counts.dropped[0].points, 50u) << key;
        EXPECT_EQ(share < 1 ? counts.dropped[0].points : counts.points_on_surveyed[0], 0u) << key << reflectivity;
      }
    }
  }
}

TEST(LimitModel, BlackIsNeverDetectedAndOtherScannersKeepTheirEchoes) {
  test::QuadScene scene = wall(0, 0);
  scene.data().meshes[0].diffuse = 0;
  Scanner scanner = rtc360_scanner(), any = scanner;
  scanner.detection_range_m = 100;
  EXPECT_EQ(count(scene, scanner, {}).points_on_surveyed[0], 0u);
  SimulatorConfig config{.engine = Engine::embree, .user_size_m = 0.5, .noise = false};
  for (const bool first : {false, true}) {
    const std::array<Scanner, 2> both{first ? scanner : any, first ? any : scanner};
    Simulator simulator(scene.scene(), both, config);
    Network network{{Vec3{0, 0, 0}}, {Vec3{0, 0, 0}}};
    network[1].setup.scanner = 1;
    const NetworkCounts counts = simulator.evaluate(network);
    const std::uint64_t all = expected(any, [](double) { return true; });
    EXPECT_EQ(counts.points_on_surveyed, (std::vector<std::uint64_t>{first ? 0 : all, first ? all : 0}));
    EXPECT_EQ(simulator.max_incidence(), std::nullopt);
  }
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
