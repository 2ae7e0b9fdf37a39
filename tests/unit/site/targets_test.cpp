// SPDX-License-Identifier: Apache-2.0
// Targets in a smooth tunnel, where surfaces leave scans free to slide along it.
#include "vantage/targets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "evaluate/sight_targets.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/candidates.hpp"
#include "vantage/error.hpp"
#include "vantage/site.hpp"

namespace vantage {
namespace {

constexpr double kLength_m = 60, kRadius_m = 3;

Site tunnel() {
  std::vector<Vec3> corners;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  constexpr std::uint32_t sides = 16, rings = 30;
  for (std::uint32_t i = 0; i <= rings; ++i)
    for (std::uint32_t k = 0; k <= sides; ++k) {
      const double angle = std::numbers::pi * k / sides;
      corners.push_back({kLength_m * i / rings, kRadius_m * std::cos(angle), kRadius_m * std::sin(angle)});
    }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    triangles.push_back({a, b, c});
    triangles.push_back({b, d, c});
  };
  for (std::uint32_t i = 0; i < rings; ++i) {
    const std::uint32_t a = i * (sides + 1), c = a + sides + 1;
    for (std::uint32_t k = 0; k < sides; ++k) quad(a + k, a + k + 1, c + k, c + k + 1);
    quad(a, a + sides, c, c + sides);
  }
  SiteOptions options;
  options.engine = Engine::embree;
  options.user_size_m = 0.3, options.spacing_m = 0.05;
  options.steps = std::array{Angle::degrees(0.1), Angle::degrees(0.1)};
  return Site(Scene::from_triangles(corners, triangles), options);
}

std::vector<PlacedStation> stations_of(Site& site) {
  std::vector<PlacedStation> stations;
  for (const double x : {10.0, 25.0, 40.0, 52.0})
    stations.push_back(site.place_head({x, 0.3, site.scanner().height_m}).station);
  return stations;
}

TEST(Targets, HoldScansTogetherWhereSurfacesDoNot) {
  Site site = tunnel();
  const auto stations = stations_of(site);
  const auto proposal = propose_targets(site, stations);
  ASSERT_TRUE(proposal);
  EXPECT_GT(proposal->without.rms_m, 0.02) << "nothing but the prior holds what slides along the tunnel";
  ASSERT_FALSE(proposal->targets.empty());
  EXPECT_LE(error_at_95_percent(proposal->with.rms_m), largest_error_m(AccuracyClass::loa30));
  EXPECT_LT(proposal->targets.size(), 8u);
  for (const Target& target : proposal->targets) {
    EXPECT_TRUE(target.proposed);
    EXPECT_GE(target.stations.size(), 2u) << target.name;
    EXPECT_NEAR(target.centre.z, TargetOptions().height_m, 0.01);
    EXPECT_LT(std::abs(target.centre.y), kRadius_m);
    for (const PlacedStation& station : stations)
      EXPECT_GE(std::hypot(station.ground.x - target.centre.x, station.ground.y - target.centre.y), 1.0);
  }
  // An evaluation with them predicts the same, but for what a sample of the voxels is off.
  const Evaluation found =
      site.evaluate(stations, {.registration = RegistrationOptions(), .targets = proposal->targets});
  EXPECT_NEAR(found.registration->rms_m, proposal->with.rms_m, 0.1 * proposal->with.rms_m);
  EXPECT_EQ(found.targets.front().stations, proposal->targets.front().stations);
}

TEST(Targets, AreProposedWhereTheyHelpMost) {
  Site site = tunnel();
  const auto stations = stations_of(site);
  const auto best = propose_targets(site, stations, {}, {.most = 1});
  ASSERT_TRUE(best);
  ASSERT_EQ(best->targets.size(), 1u);
  const auto all = candidate_positions(site, 400);
  int tried = 0;
  for (std::size_t k = 0; k < all.size(); k += 40) {
    Target other{.name = "other", .centre = all[k].ground + Vec3{0, 0, TargetOptions().height_m}};
    const bool near = std::ranges::any_of(stations, [&](const PlacedStation& station) {
      return std::hypot(station.ground.x - other.centre.x, station.ground.y - other.centre.y) < 1;
    });
    if (near || site.clash().distance(other.centre, 0.15) < 0.15) continue;
    ++tried;
    const auto given = propose_targets(site, stations, {}, {.most = 0}, {other});
    EXPECT_GE(given->with.rms_m, best->with.rms_m * (1 - 1e-6)) << other.centre.x << " " << other.centre.y;
  }
  EXPECT_GT(tried, 5);
}

TEST(Targets, AreMeasuredNearEnoughInFieldAndInFreeView) {
  Site site = tunnel();
  const auto stations = stations_of(site);
  std::vector<Target> targets{{.name = "near", .centre = {17, 1, 1.5}},
                              {.name = "outside", .centre = {17, 5, 1.5}},
                              {.name = "far", .centre = {300, 0, 1.5}},
                              {.name = "under the tripod", .centre = {10, 0.3, 0.1}}};
  const auto sighted = sight_targets(site.simulator(), site.clash(), stations, targets);
  EXPECT_EQ(targets[0].stations, (std::vector<std::size_t>{0, 1}));
  EXPECT_TRUE(targets[1].stations.empty());
  EXPECT_TRUE(targets[2].stations.empty());
  EXPECT_EQ(std::ranges::count(targets[3].stations, 0u), 0) << "straight below no scanner of 300° sees";
  ASSERT_EQ(sighted.size(), 4u);
  EXPECT_NEAR(sighted[0].seen_by[0].sigma_m, TargetOptions().sigma_m, 1e-12) << "ranges are exact here";
  EXPECT_THROW(sight_targets(site.simulator(), site.clash(), stations, targets, {.diameter_m = 0}), Error);
}

TEST(Targets, AreWrittenAndReadAsTables) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "targets.csv";
  const std::vector<Target> targets{{.name = "T1", .centre = {1.5, 2.25, 0.125}, .proposed = true, .stations = {0, 1}},
                                    {.name = "=C,1", .centre = {-1, 0, 2}, .control_m = 0.002}};
  write_targets_csv(file, targets, std::vector<std::string>{"S1", "S2"});
  const auto read = read_targets_csv(file);
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].name, "T1");
  EXPECT_EQ(read[0].centre.x, 1.5);
  EXPECT_EQ(read[0].control_m, 0);
  EXPECT_EQ(read[1].name, "=C,1");
  EXPECT_EQ(read[1].control_m, 0.002);
  const auto refused = [&](const std::string& text) {
    std::ofstream(file) << text;
    try {
      read_targets_csv(file);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("read");
  };
  EXPECT_NE(refused("name,x,y\nA,1,2\n").find("A has no x, y and z"), std::string::npos);
  EXPECT_NE(refused("name,x,y,z,sigma\nA,1,2,3,5\n").find("sigma"), std::string::npos);
}

TEST(AccuracyClass, HasItsBounds) {
  EXPECT_EQ(accuracy_class_from_string("loa40"), AccuracyClass::loa40);
  EXPECT_EQ(to_string(AccuracyClass::loa20), "LOA20");
  EXPECT_EQ(largest_error_m(AccuracyClass::loa50), 0.001);
  EXPECT_THROW(accuracy_class_from_string("LOA60"), Error);
}

}  // namespace
}  // namespace vantage
