// SPDX-License-Identifier: Apache-2.0
#include "evaluate/steep_checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <optional>
#include <tuple>

#include "evaluate/known_points.hpp"
#include "support/quad_scene.hpp"
#include "support/site_of.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/export.hpp"
#include "vantage/summary.hpp"

namespace vantage {
namespace {

Scanner instrument(const std::string& name) {
  Scanner scanner;
  scanner.name = name;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(1);
  scanner.angle_accuracy = Angle::degrees(18.0 / 3600);
  return scanner;
}

// A network whose registration error is mostly of the instrument.
Evaluation checked(const std::vector<Vec3>& heads) {
  Evaluation network{.values = {{"coverage", {0.5, 0}}}, .registration = RegistrationError{}};
  network.registration->rms_m = 1e-3, network.registration->random_m = 1e-4;
  for (const Vec3& head : heads)
    network.stations.push_back({.uv = {}, .position = head, .ground = head - Vec3{0, 0, 1.6}});
  return network;
}

// A hall of 12 × 12 × 5 m whose walls and ceiling are surveyed, with a sheet that hides a part from the second station.
Site hall(const std::vector<Scanner>& scanners) {
  test::QuadScene scene;
  scene.quad({0, 0, 0}, {12, 0, 0}, {0, 12, 0}, Role::blocking);
  scene.quad({0, 0, 5}, {0, 12, 0}, {12, 0, 0});
  scene.quad({0, 0, 0}, {0, 12, 0}, {0, 0, 5});
  scene.quad({12, 0, 0}, {0, 0, 5}, {0, 12, 0});
  scene.quad({0, 12, 0}, {12, 0, 0}, {0, 0, 5});
  scene.quad({5.9f, 4, 2}, {0, 4, 0}, {0, 0, 3}, Role::blocking);
  return test::site_of(Simulator(scene.scene(), scanners, {.engine = Engine::embree, .user_size_m = 0.5}));
}

TEST(SteepChecks, AreThePlacesThatNoOtherBeats) {
  Site site = hall({instrument("A @1"), instrument("A @2"), instrument("B @1")});
  Evaluation network = checked({{3, 6, 1.6}, {9, 6, 1.6}, {2, 2, 1.6}, {10, 10, 1.6}, {6, 11, 1.6}});
  network.stations[1].setup.scanner = 1;
  network.stations[3].setup.scanner = network.stations[4].setup.scanner = 2;
  network.targets = {{.name = "C1", .centre = {1, 1, 1}, .control_m = 0.001}};
  add_steep_checks(network, site.simulator(), site.clash());
  EXPECT_TRUE(network.no_steep_check.empty());
  ASSERT_EQ(network.targets.size(), 3u);
  EXPECT_EQ(network.targets[1].name, "C2") << "names stay unique";
  EXPECT_EQ(network.targets[2].name, "C3");
  const std::vector<std::vector<std::size_t>> own{{0, 1, 2}, {3, 4}};
  std::vector<std::uint32_t> voxels(site.simulator().voxel_count());
  std::iota(voxels.begin(), voxels.end(), 0u);
  for (std::size_t c = 0; c < own.size(); ++c) {
    // Second largest height above or below the head, in decimetres, and its range, of the stations that see a surface
    // from its front or back.
    const auto rank_of = [&](const Vec3& p, const Vec3& normal) -> std::optional<std::tuple<double, double>> {
      std::optional<std::tuple<double, double>> best;
      for (const double side : {-1.0, 1.0}) {
        std::vector<std::tuple<double, double>> sights;
        for (const std::size_t k : own[c]) {
          const Vec3 line = p - network.stations[k].position;
          const double range = std::sqrt(dot(line, line)), steep = std::asin(std::abs(line.z) / range);
          const bool facing = -side * dot(line, normal) >= 0.5 * range;
          if (steep * 180 / std::numbers::pi > 30 && range < 30 && facing &&
              site.clash().sees(network.stations[k].position, p + normal * (0.02 * side)))
            sights.emplace_back(-std::round(10 * std::abs(line.z)), range);
        }
        std::ranges::sort(sights);
        if (sights.size() > 1 && (!best || sights[1] < *best)) best = sights[1];
      }
      return best;
    };
    std::optional<std::tuple<double, double>> least;
    for (const VoxelPatch& patch : site.simulator().voxel_patches(voxels)) {
      if (!(patch.area_m2 > 0)) continue;
      const auto rank = rank_of(patch.point, patch.normal);
      if (rank && (!least || *rank < *least)) least = rank;
    }
    ASSERT_TRUE(least) << c;
    const Target& found = network.targets[c + 1];
    EXPECT_TRUE(found.check && found.proposed);
    std::optional<std::tuple<double, double>> rank;
    for (const VoxelPatch& patch : site.simulator().voxel_patches(voxels))
      if (patch.point == found.centre) rank = rank_of(patch.point, patch.normal);
    ASSERT_TRUE(rank) << "on a surveyed surface";
    constexpr double kSame = 1e-6;
    EXPECT_NEAR(std::get<0>(*rank), std::get<0>(*least), kSame);
    if (std::get<0>(*rank) == std::get<0>(*least)) {
      EXPECT_NEAR(std::get<1>(*rank), std::get<1>(*least), kSame);
    }
    ASSERT_GE(found.stations.size(), 2u);
    EXPECT_TRUE(std::ranges::is_sorted(found.stations));
    for (const std::size_t k : found.stations) {
      EXPECT_NE(std::ranges::find(own[c], k), own[c].end()) << "of that instrument";
      const Vec3 line = found.centre - network.stations[k].position;
      EXPECT_GT(std::abs(line.z) / std::sqrt(dot(line, line)), 0.5) << "more than 30°";
      EXPECT_LT(dot(line, line), 30 * 30);
    }
  }
  // Made anew, it is the same.
  const std::vector<Target> before = network.targets;
  add_steep_checks(network, site.simulator(), site.clash());
  ASSERT_EQ(network.targets.size(), before.size());
  for (std::size_t k = 0; k < before.size(); ++k) EXPECT_EQ(network.targets[k].centre, before[k].centre);

  // It is told, written and left out where targets are read that tie scans.
  std::size_t told = 0;
  for (const SummaryLine& line : summary_lines(network))
    told += line.heading == "to check" && line.text.starts_with("a target or a sharp corner at C");
  EXPECT_EQ(told, 2u);
  EXPECT_FALSE(any_ties({network.targets.data() + 1, 2}));
  const test::TemporaryFolder folder;
  write_targets_csv(folder / "t.csv", network.targets, station_names(network.stations));
  const std::vector<Target> read = read_targets_csv(folder / "t.csv");
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(read[0].name, "C1");
}

TEST(SteepChecks, AreToldWhereNoneIsPossibleAndAskedForNowhereElse) {
  Site site = test::site_of(
      Simulator(test::wall_and_floor().scene(), instrument("A @1"), {.engine = Engine::embree, .user_size_m = 0.5}));
  Evaluation far = checked({{-2, 0, 0.5}, {-3, 2, 0.5}});  // 7 m from a wall that is 2 m higher than the heads
  add_steep_checks(far, site.simulator(), site.clash());
  EXPECT_TRUE(far.targets.empty());
  EXPECT_EQ(far.no_steep_check, (std::vector<std::string>{"A"}));
  std::string told;
  for (const SummaryLine& line : summary_lines(far))
    if (line.heading == "to check") told = line.text;
  EXPECT_NE(told.find("no surveyed surface is so steep for two of them within 30 m"), std::string::npos) << told;

  Evaluation by_chance = checked({{3, 0, 0.5}, {3, 1, 0.5}});
  by_chance.registration->random_m = by_chance.registration->rms_m;
  add_steep_checks(by_chance, site.simulator(), site.clash());
  EXPECT_TRUE(by_chance.targets.empty() && by_chance.no_steep_check.empty());
}

TEST(KnownPoints, SetStationsUpWhereEnoughAreSeen) {
  Evaluation network = checked({{0, 0, 1.6}, {5, 0, 1.6}, {10, 0, 1.6}, {15, 0, 1.6}, {20, 0, 1.6}});
  EXPECT_TRUE(known_points(network).empty());
  EXPECT_TRUE(set_ups_of(network).empty());
  network.targets = {{.name = "P1", .centre = {0.04, 0, 0}, .control_m = 0.002, .stations = {1}},
                     {.name = "P2", .centre = {2, 3, 1}, .control_m = 0.002, .stations = {0, 1, 2}},
                     {.name = "P3", .centre = {9, 3, 1}, .control_m = 0.002, .stations = {1, 2, 3}},
                     {.name = "T1", .centre = {9, 4, 1}, .stations = {3, 4}}};
  EXPECT_EQ(set_ups_of(network),
            (std::vector<std::string>{"over P1, sights 1", "resection from 3", "resection from 2, unchecked",
                                      "1 seen, too few", "none seen"}));
  const auto known = known_points(network);
  std::vector<bool> may;
  for (const KnownPoints& one : known) may.push_back(may_be_set_up(one));
  EXPECT_EQ(may, (std::vector<bool>{true, true, true, false, false}));
  std::string told;
  for (const SummaryLine& line : summary_lines(network))
    if (line.heading == "control") told = line.text;
  EXPECT_EQ(told,
            "3 of 5 stations may be set up by known points: S1 (over P1, sights 1), S2 (resection from 3), S3 "
            "(resection from 2, unchecked)");
  const std::string table =
      station_table(network.stations, station_names(network.stations), {}, {}, set_ups_of(network));
  EXPECT_NE(table.find("known points"), std::string::npos);
  EXPECT_NE(table.find("resection from 3\n"), std::string::npos) << table;
  network.targets.resize(1);
  for (const SummaryLine& line : summary_lines(network))
    if (line.heading == "control") told = line.text;
  EXPECT_EQ(told,
            "none of 5 stations may be set up by known points, of which two in range are needed, three for a check");
}

}  // namespace
}  // namespace vantage
