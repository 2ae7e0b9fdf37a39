// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <numbers>

#include "support/quad_scene.hpp"
#include "vantage/error.hpp"
#include "vantage/simulator.hpp"

namespace vantage {
namespace {

using Vector5d = Eigen::Matrix<double, 5, 1>;

constexpr double kArcsecond = std::numbers::pi / 180 / 3600;

// Walls, floor and ceiling around the origin, all at other distances.
constexpr std::array<float, 6> kFaces{-7, 9, -5, 6, -1.8f, 3.5f};
test::QuadScene box() {
  test::QuadScene scene;
  const auto& [x0, x1, y0, y1, z0, z1] = kFaces;
  const float x = x1 - x0, y = y1 - y0, z = z1 - z0;
  for (const float at : {x0, x1}) scene.quad({at, y0, z0}, {0, y, 0}, {0, 0, z});
  for (const float at : {y0, y1}) scene.quad({x0, at, z0}, {x, 0, 0}, {0, 0, z});
  for (const float at : {z0, z1}) scene.quad({x0, y0, at}, {x, 0, 0}, {0, y, 0});
  return scene;
}

Scanner calibrated() {
  Scanner scanner = test::coarse_scanner(0.5);
  scanner.heading = Angle::degrees(25);
  scanner.angle_accuracy = Angle::degrees(18.0 / 3600);
  scanner.range_accuracy_m = 0.001;
  scanner.range_accuracy_ppm = 10;
  return scanner;
}

// Angles in radians, offset in metres and scale, as the points of a scan in the box tell them: by an adjustment of how
// far each lies off its face. A textbook's corrections of angles and ranges, differentiated by numbers.
Vector5d read_back(const Scanner& scanner, const StationSetup& setup, const ScanOptions& options) {
  Simulator simulator(box().scene(), scanner, {.engine = Engine::embree, .user_size_m = 0.5});
  const ScanPoints scan = simulator.scan_points({.position = {0, 0, 0}, .setup = setup}, options);
  const std::array<Vec3, 3> turn = setup.survey_from_scanner();
  Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
  Vector5d right = Vector5d::Zero();
  for (std::size_t k = 0; k < scan.position.size(); ++k) {
    const RayAngles angles = scanner.angles(scan.ray[k]);
    const double zenith = angles.zenith.in_radians(), azimuth = angles.azimuth.in_radians();
    if (std::sin(zenith) < 0.05) continue;  // an azimuth says nothing there
    const auto face = static_cast<std::size_t>(scan.mesh[k]);
    const std::size_t axis = face / 2;
    const auto part = [&](const Vec3& p) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; };
    const double side = azimuth < scanner.heading.in_radians() ? 1 : -1;
    const double reach = std::sqrt(dot(scan.position[k], scan.position[k]));
    const auto measured = [&](double index, double collimation, double trunnion, double offset, double scale) {
      const double phi = azimuth + side * (collimation / std::sin(zenith) + trunnion / std::tan(zenith)),
                   theta = zenith + side * index, r = reach * (1 + scale) + offset;
      const Vec3 own{r * std::sin(theta) * std::cos(phi), r * std::sin(theta) * std::sin(phi), r * std::cos(theta)};
      return dot(turn[axis], own);
    };
    constexpr double step = 1e-6;
    const double still = measured(0, 0, 0, 0, 0);
    Vector5d row;
    row << measured(step, 0, 0, 0, 0) - still, measured(0, step, 0, 0, 0) - still, measured(0, 0, step, 0, 0) - still,
        measured(0, 0, 0, step, 0) - still, measured(0, 0, 0, 0, step) - still;
    row /= step;
    normal += row * row.transpose();
    right += row * (part(scan.position[k]) - static_cast<double>(kFaces[face]));
  }
  return normal.llt().solve(right);
}

Vector5d vector_of(const InstrumentErrors& errors) {
  Vector5d v;
  v << errors.vertical_index.in_radians(), errors.collimation.in_radians(), errors.trunnion.in_radians(),
      errors.range_offset_m, errors.range_scale_ppm * 1e-6;
  return v;
}

// Each error alone, then all together; upright, turned, and by a beam with a width.
TEST(InstrumentErrors, AreReadBackFromPointsOfABox) {
  const Angle much = Angle::radians(200 * kArcsecond);
  for (const InstrumentErrors& errors :
       {InstrumentErrors{.vertical_index = much}, InstrumentErrors{.collimation = much},
        InstrumentErrors{.trunnion = much}, InstrumentErrors{.range_offset_m = 0.004},
        InstrumentErrors{.range_scale_ppm = 300}, draw_instrument_errors(calibrated(), 7)}) {
    for (const bool turned : {false, true}) {
      const StationSetup setup =
          turned ? StationSetup{.heading = Angle::degrees(50), .tilt = Angle::degrees(20)} : StationSetup{};
      const Vector5d found =
                         read_back(calibrated(), setup, {.outputs = scan_position | scan_ids, .instrument = errors}),
                     drawn = vector_of(errors);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(found[k], drawn[k], 0.1 * kArcsecond) << k << turned;
      EXPECT_NEAR(found[3], drawn[3], 5e-6) << turned;
      EXPECT_NEAR(found[4], drawn[4], 1e-6) << turned;
    }
  }
}

TEST(InstrumentErrors, MoveRangesAndNothingElse) {
  Scanner scanner = calibrated();
  scanner.noise = rtc360_noise();
  Simulator simulator(box().scene(), scanner, {.engine = Engine::embree, .user_size_m = 0.5});
  const std::uint32_t outputs =
      scan_range | scan_position | scan_normal | scan_reflectivity | scan_ids | scan_colour | scan_voxel;
  const InstrumentErrors errors{.collimation = Angle::degrees(0.01), .range_offset_m = 0.25, .range_scale_ppm = 1000};
  const ScanPoints right = simulator.scan_points({{0, 0, 0}}, {.outputs = outputs}),
                   wrong = simulator.scan_points({{0, 0, 0}}, {.outputs = outputs, .instrument = errors}),
                   none = simulator.scan_points({{0, 0, 0}}, {.outputs = outputs, .instrument = InstrumentErrors{}});
  EXPECT_EQ(none.range_m, right.range_m);
  ASSERT_EQ(wrong.ray, right.ray);
  EXPECT_EQ(wrong.normal, right.normal);
  EXPECT_EQ(wrong.reflectivity, right.reflectivity);
  EXPECT_EQ(wrong.voxel, right.voxel);
  EXPECT_EQ(wrong.colour, right.colour);
  for (std::size_t k = 0; k < right.ray.size(); ++k) {
    const double range = static_cast<double>(right.range_m[k]);
    EXPECT_NEAR(static_cast<double>(wrong.range_m[k]), range * 1.001 + 0.25, 1e-5);
    EXPECT_NEAR(std::sqrt(dot(wrong.position[k], wrong.position[k])), range * 1.001 + 0.25, 1e-5);
  }
}

TEST(InstrumentErrors, OfABeamWithAWidthAreTheSame) {
  Scanner scanner = calibrated();
  scanner.beam_divergence = Angle::radians(1e-4), scanner.exit_diameter_m = 0.001;
  const InstrumentErrors errors = draw_instrument_errors(scanner, 3);
  const Vector5d found =
      read_back(scanner, {}, {.outputs = scan_position | scan_ids, .beam = BeamOptions{}, .instrument = errors});
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(found[k], vector_of(errors)[k], 0.5 * kArcsecond) << k;
  EXPECT_NEAR(found[3], vector_of(errors)[3], 2e-5);
}

// The mean of many draws is 0, and their spread is what the scanner states.
TEST(InstrumentErrors, AreDrawnAsTheScannerStates) {
  const Scanner scanner = calibrated();
  constexpr int draws = 4000;
  Vector5d sum = Vector5d::Zero(), squares = Vector5d::Zero();
  for (int seed = 0; seed < draws; ++seed) {
    const Vector5d one = vector_of(draw_instrument_errors(scanner, static_cast<std::uint64_t>(seed)));
    sum += one, squares += one.cwiseProduct(one);
  }
  Vector5d stated;
  stated << 18 * kArcsecond, 18 * kArcsecond, 18 * kArcsecond, 0.001, 1e-5;
  for (int k = 0; k < 5; ++k) {
    EXPECT_NEAR(sum[k] / draws / stated[k], 0, 4 / std::sqrt(draws)) << k;
    EXPECT_NEAR(std::sqrt(squares[k] / draws) / stated[k], 1, 4 / std::sqrt(2.0 * draws)) << k;
  }
  Scanner worse = scanner;
  worse.angle_accuracy = Angle::radians(2 * scanner.angle_accuracy.in_radians());
  EXPECT_DOUBLE_EQ(draw_instrument_errors(worse, 5).trunnion.in_radians(),
                   2 * draw_instrument_errors(scanner, 5).trunnion.in_radians())
      << "settings of one instrument err alike";
  EXPECT_THROW(draw_instrument_errors(Scanner{}, 1), Error);
}

}  // namespace
}  // namespace vantage
