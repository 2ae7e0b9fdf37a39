// SPDX-License-Identifier: Apache-2.0
#include "import/scans.hpp"

#include <cmath>

#include "import_fixture.hpp"
#include "vantage/export.hpp"

namespace vantage::test {
namespace {

using ScansTest = ImportTest;
using importers::taken_scans;

TEST_F(ScansTest, PosesComeBackAsTheyWereWritten) {
  const auto file = folder_ / "a.e57";
  PointCloudWriter writer(file, {}, scan_position | scan_reflectivity);
  ScanChunk chunk;
  chunk.ray_count = 1;
  chunk.position = {{1, 2, 3}};
  chunk.reflectivity = {0.5};
  struct Pose {
    Vec3 head;
    double heading, tilt;
  };
  const Pose poses[] = {
      {{500'000, 5'000'000, 2}, 0, 0}, {{1, 2, 3}, -120, 0}, {{3, 2, 1}, 75, 90}, {{4, 4, 4}, -30, 20}};
  for (const Pose& pose : poses) {
    StationScan scan{.name = "at " + std::to_string(pose.heading), .head = pose.head, .scanner = {}};
    scan.setup.heading = Angle::degrees(pose.heading), scan.setup.tilt = Angle::degrees(pose.tilt);
    writer.begin_station(scan);
    writer.write(chunk, 1);
  }
  writer.close();
  const auto scans = taken_scans(file);
  ASSERT_EQ(scans.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(scans[k].name, "at " + std::to_string(poses[k].heading));
    EXPECT_EQ(scans[k].head, poses[k].head);
    EXPECT_NEAR(scans[k].setup.heading.in_degrees(), poses[k].heading, 1e-9);
    EXPECT_NEAR(scans[k].setup.tilt.in_degrees(), poses[k].tilt, 1e-9);
  }
}

TEST_F(ScansTest, SettingsAreThoseOfThePoints) {
  const auto file = folder_ / "a.e57";
  PointCloudWriter writer(file, {}, scan_position | scan_reflectivity);
  Scanner scanner;
  scanner.name = "Leica RTC360";
  scanner.horizontal_angle = Angle::degrees(120), scanner.heading = Angle::degrees(30);
  scanner.azimuth_step = Angle::degrees(0.5), scanner.zenith_step = Angle::degrees(0.4);
  scanner.zenith_start = Angle::degrees(60), scanner.vertical_angle = Angle::degrees(120);
  writer.begin_station({.name = "P1", .head = {1, 2, 3}, .scanner = scanner});
  ScanChunk chunk;
  chunk.ray_count = scanner.rays();
  for (std::uint64_t ray = 0; ray < chunk.ray_count; ++ray) {
    const RayAngles angles = scanner.angles(ray);
    const double z = angles.zenith.in_radians(), a = angles.azimuth.in_radians();
    chunk.position.push_back({static_cast<float>(1 + 6 * std::sin(z) * std::cos(a)),
                              static_cast<float>(2 + 6 * std::sin(z) * std::sin(a)),
                              static_cast<float>(3 + 6 * std::cos(z))});
  }
  chunk.reflectivity.assign(chunk.ray_count, 0.5F);
  writer.write(chunk, 1);
  writer.close();
  const auto scans = taken_scans(file);
  ASSERT_EQ(scans.size(), 1u);
  ASSERT_TRUE(scans[0].settings);
  const auto& settings = *scans[0].settings;
  EXPECT_EQ(scans[0].sensor, "Leica RTC360");
  EXPECT_TRUE(settings.steps_by_grid);
  ASSERT_TRUE(settings.steps);
  EXPECT_NEAR((*settings.steps)[0].in_degrees(), 0.5, 1e-9);
  EXPECT_NEAR((*settings.steps)[1].in_degrees(), 0.4, 1e-9);
  EXPECT_NEAR(settings.sweep.in_degrees(), 120, 1e-9);
  EXPECT_NEAR(scans[0].setup.heading.in_degrees() + settings.sweep_middle.in_degrees(), 30, 1e-9);
  EXPECT_NEAR(settings.zeniths[0].in_degrees(), 60, 1e-9);
  EXPECT_NEAR(settings.zeniths[1].in_degrees(), 120, 1e-9);
}

TEST_F(ScansTest, ALevelledScannerHasNoTilt) {
  const double half = 0.5 * 0.01;  // of 0.6°, about y
  EXPECT_EQ(importers::setup_of({std::cos(half), 0, std::sin(half), 0}).tilt.in_degrees(), 0);
}

TEST_F(ScansTest, OtherFilesAreRefused) {
  expect_error(Errc::malformed_file, "are read from E57; this is none",
               [&] { taken_scans(write("a.xyz", "1 2 3\n4 5 6\n")); });
  expect_error(Errc::malformed_file, "none of E57's",
               [&] { taken_scans(write("a.e57", "ASTM-E57" + std::string(60, '\x7F'))); });
}

}  // namespace
}  // namespace vantage::test
