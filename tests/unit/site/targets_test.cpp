// SPDX-License-Identifier: Apache-2.0
// Targets in a smooth tunnel, where surfaces leave scans free to slide along it.
#include "vantage/targets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "evaluate/sight_targets.hpp"
#include "support/quad_scene.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/candidates.hpp"
#include "vantage/error.hpp"
#include "vantage/question.hpp"
#include "vantage/site.hpp"

namespace vantage {
namespace {

constexpr double kLength_m = 60, kRadius_m = 3;

Site tunnel(double step_deg = 0.1, double user_size_m = 0.3, double spacing_m = 0.05,
            std::optional<std::array<double, 3>> calibration = {}) {
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
  options.user_size_m = user_size_m, options.spacing_m = spacing_m;
  options.steps = std::array{Angle::degrees(step_deg), Angle::degrees(step_deg)};
  options.calibration = calibration;
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

TEST(Targets, TheClassIsThatOfWhatTheScansAreFor) {
  EXPECT_EQ(with_class_of({}, {}).accuracy_class, std::nullopt);
  EXPECT_EQ(with_class_of({.deliverable = "1:50"}, {}).accuracy_class, std::nullopt);
  EXPECT_EQ(with_class_of({.deliverable = "loa40"}, {}).accuracy_class, AccuracyClass::loa40);
  EXPECT_EQ(with_class_of({.deliverable = "LOA40"}, {.accuracy_class = AccuracyClass::loa20}).accuracy_class,
            AccuracyClass::loa20);
  EXPECT_EQ(wanted_class({}), AccuracyClass::loa30);
}

TEST(Targets, AreAsFewAsTheClassTakes) {
  Site site = tunnel();
  const auto stations = stations_of(site);
  for (const AccuracyClass wanted : {AccuracyClass::loa20, AccuracyClass::loa30, AccuracyClass::loa40}) {
    const TargetOptions options{.accuracy_class = wanted, .exact = true};
    const auto proposal = propose_targets(site, stations, {}, options);
    ASSERT_TRUE(proposal);
    ASSERT_LE(proposal->with.rms_m, allowed_rms_m(options)) << to_string(wanted);
    for (std::size_t k = 0; k < proposal->targets.size(); ++k) {
      std::vector<Target> others = proposal->targets;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
      const auto fewer = propose_targets(site, stations, {}, {.most = 0, .exact = true}, others);
      EXPECT_GT(fewer->with.rms_m, allowed_rms_m(options)) << proposal->targets[k].name << " is needless";
      EXPECT_DOUBLE_EQ(fewer->without.rms_m, proposal->without.rms_m);
    }
  }
  const auto seven = propose_targets(site, stations, {}, {.least = 7, .most = 7});
  EXPECT_EQ(seven->targets.size(), 7u);
  const auto strict = propose_targets(site, stations, {}, {.largest_rms_m = 0.002});
  EXPECT_LE(strict->with.rms_m, 0.0021);
}

// Height of a triangle over its longest side, as a share of that.
double flatness(const Target& a, const Target& b, const Target& c) {
  const auto length = [](const Vec3& v) { return std::sqrt(dot(v, v)); };
  const double x = length(b.centre - a.centre), y = length(c.centre - a.centre), z = length(c.centre - b.centre);
  const double longest = std::max({x, y, z}), half = (x + y + z) / 2;
  return 2 * std::sqrt(std::max(half * (half - x) * (half - y) * (half - z), 0.0)) / (longest * longest);
}

TEST(Targets, OfAScanDoNotLieOnALine) {
  Site site = tunnel();
  const auto stations = stations_of(site);
  const auto proposal = propose_targets(site, stations, {}, {.least = 12, .most = 12});
  ASSERT_GT(proposal->targets.size(), 6u);
  int together = 0;
  for (const Target& a : proposal->targets)
    for (const Target& b : proposal->targets)
      for (const Target& c : proposal->targets) {
        if (&a >= &b || &b >= &c) continue;
        const bool of_one_scan = std::ranges::any_of(a.stations, [&](std::size_t k) {
          return std::ranges::count(b.stations, k) > 0 && std::ranges::count(c.stations, k) > 0;
        });
        if (!of_one_scan) continue;
        ++together;
        EXPECT_GE(flatness(a, b, c), 0.05) << a.name << " " << b.name << " " << c.name;
      }
  EXPECT_GT(together, 5);
  // A target that is there counts too.
  const Vec3 first = proposal->targets[0].centre, second = proposal->targets[1].centre;
  EXPECT_NE(first.y, second.y);
}

// Two rooms of 3 m with a door of 0.9 m in the wall of 0.1 m between them; `glass`: the floor of the second is a pane.
constexpr double kRoom_m = 3, kDoor_m = 0.9;
Site two_rooms(bool glass) {
  test::QuadScene scene;
  const auto f = [](double v) { return static_cast<float>(v); };
  const float height = 2.6F, side = f(kRoom_m), end = f(2 * kRoom_m + 0.1);
  const float wall = f(kRoom_m), low = f((kRoom_m - kDoor_m) / 2), high = f((kRoom_m + kDoor_m) / 2);
  scene.quad({0, 0, 0}, {wall + 0.1F, 0, 0}, {0, side, 0});
  scene.quad({0, 0, height}, {0, side, 0}, {end, 0, 0});
  scene.quad({0, 0, 0}, {0, 0, height}, {end, 0, 0}).quad({0, side, 0}, {end, 0, 0}, {0, 0, height});
  scene.quad({0, 0, 0}, {0, side, 0}, {0, 0, height}).quad({end, 0, 0}, {0, 0, height}, {0, side, 0});
  for (const float x : {wall, wall + 0.1F}) {
    scene.quad({x, 0, 0}, {0, low, 0}, {0, 0, height}).quad({x, high, 0}, {0, side - high, 0}, {0, 0, height});
    scene.quad({x, low, 2.1F}, {0, high - low, 0}, {0, 0, height - 2.1F});
  }
  for (const float y : {low, high}) scene.quad({wall, y, 0}, {0.1F, 0, 0}, {0, 0, 2.1F});
  // Meshes of glass come last.
  scene.quad({wall + 0.1F, 0, 0}, {side, 0, 0}, {0, side, 0}, glass ? Role::blocking : Role::surveyed);
  scene.data().meshes.back().glass = glass;
  SiteOptions options;
  options.engine = Engine::embree;
  options.user_size_m = 0.2, options.spacing_m = 0.05;
  options.steps = std::array{Angle::degrees(0.2), Angle::degrees(0.2)};
  return Site(scene.scene(), options);
}

std::vector<PlacedStation> stations_in_rooms(Site& site) {
  std::vector<PlacedStation> stations;
  for (const double x : {0.5, 2 * kRoom_m - 0.4})
    for (const double y : {0.5, 2.5}) stations.push_back(site.place_head({x, y, site.scanner().height_m}).station);
  return stations;
}

TEST(Targets, StandInNoDoorwayAndWhereNoLeafSwings) {
  Site site = two_rooms(false);
  const auto stations = stations_in_rooms(site);
  const auto to_door = [](const Vec3& p) { return std::hypot(p.x - kRoom_m - 0.05, p.y - kRoom_m / 2); };
  const auto all = candidate_positions(site, 400);
  EXPECT_GT(std::ranges::count_if(all, [&](const PlacedStation& s) { return to_door(s.ground) < kDoor_m; }), 10);
  const auto proposal = propose_targets(site, stations, {}, {.least = 40, .most = 40});
  ASSERT_GT(proposal->targets.size(), 3u);
  for (const Target& target : proposal->targets)
    EXPECT_GE(to_door(target.centre), kDoor_m) << target.centre.x << " " << target.centre.y;
}

TEST(Targets, StandOnNoGlass) {
  for (const bool glass : {false, true}) {
    Site site = two_rooms(glass);
    const auto stations = stations_in_rooms(site);
    const auto beyond = [](const Vec3& p) { return p.x > kRoom_m + 0.1; };
    const auto all = candidate_positions(site, 400);
    EXPECT_GT(std::ranges::count_if(all, [&](const PlacedStation& s) { return beyond(s.ground); }), 10);
    const auto proposal = propose_targets(site, stations, {}, {.least = 40, .most = 40});
    const auto there = std::ranges::count_if(proposal->targets, [&](const Target& t) { return beyond(t.centre); });
    EXPECT_EQ(there == 0, glass) << there;
    EXPECT_GT(proposal->targets.size(), 1u);
  }
}

// The question of a surveyor, in the tunnel, with targets that a coarse scan measures as far as a fine one its own.
constexpr double kCoarse_deg = 0.4;
SurveyQuestion short_question() {
  SurveyQuestion question;
  question.stations = {4, 4};
  question.target.diameter_m = 8 * TargetOptions().diameter_m;
  return question;
}
const PlanConfig kShort{.population = 6, .iterations = 2, .sample_voxels = 1000};

TEST(Targets, ArePartOfAPlanWhereSurfacesDoNotHoldItsScans) {
  Site site = tunnel(kCoarse_deg, 0.5, 0.2);
  const PlanResult plain = [&] {
    SurveyQuestion question = short_question();
    question.targets = 0;
    return plan(site, question, kShort);
  }();
  const PlanEntry& bare = plain.front[answer(plain)];
  EXPECT_TRUE(bare.targets.empty());
  EXPECT_FALSE(bare.without_targets_m);
  ASSERT_GT(bare.value("registration"), 1000 * allowed_rms_m({})) << "the tunnel holds no scan";

  const PlanResult found = plan(site, short_question(), kShort);
  const PlanEntry& entry = found.front[answer(found)];
  ASSERT_EQ(entry.stations.size(), bare.stations.size());
  for (std::size_t k = 0; k < entry.stations.size(); ++k)
    EXPECT_EQ(entry.stations[k].position, bare.stations[k].position);
  ASSERT_FALSE(entry.targets.empty());
  EXPECT_NEAR(1000 * *entry.without_targets_m, bare.value("registration"), 1e-9);
  EXPECT_LE(entry.value("registration"), 1000 * allowed_rms_m({}));
  EXPECT_NEAR(entry.value("registration"), 1000 * entry.registration->rms_m, 1e-12);
  const Evaluation same = site.evaluate(
      entry.stations,
      {.registration = RegistrationOptions(), .targets = entry.targets, .target = short_question().target});
  EXPECT_NEAR(same.value("registration"), entry.value("registration"), 1e-9);

  SurveyQuestion three = short_question();
  three.targets = 3;
  const PlanResult with_three = plan(site, three, kShort);
  EXPECT_EQ(with_three.front[answer(with_three)].targets.size(), 3u);
}

TEST(Targets, OfARequirementMeetIt) {
  Site site = tunnel(kCoarse_deg, 0.5, 0.2);
  SurveyQuestion question = short_question();
  question.requirements = {"registration<=2"};
  const PlanResult found = plan(site, question, kShort);
  const PlanEntry& entry = found.front[answer(found)];
  EXPECT_LE(entry.value("registration"), 2);
  EXPECT_EQ(entry.violation, violation_of(entry, found.problem.requirements));
}

TEST(Targets, ThatAreThereCountInAPlan) {
  Site site = tunnel(kCoarse_deg, 0.5, 0.2);
  SurveyQuestion question = short_question();
  question.targets = 0;
  const PlanResult bare = plan(site, question, kShort);
  for (const PlacedStation& station : bare.front[answer(bare)].stations)
    for (const double aside : {-1.2, 1.2})
      question.existing_targets.push_back({.name = "C" + std::to_string(question.existing_targets.size()),
                                           .centre = {station.ground.x + 1.5, aside, 1.2},
                                           .control_m = 0.002});
  const PlanResult found = plan(site, question, kShort);
  const PlanEntry& entry = found.front[answer(found)];
  EXPECT_EQ(entry.targets.size(), question.existing_targets.size());
  EXPECT_LT(entry.value("registration"), bare.front[answer(bare)].value("registration"));
  EXPECT_TRUE(entry.registration->absolute_rms_m);
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
  // Ranges are exact here, and nothing is stated.
  EXPECT_NEAR(sighted[0].seen_by[0].across_m, 0.001, 1e-12);
  EXPECT_NEAR(sighted[0].seen_by[0].along_m, 0.001, 1e-12);
  EXPECT_THROW(sight_targets(site.simulator(), site.clash(), stations, targets, {.diameter_m = 0}), Error);
}

// The scanner states what its calibration leaves: angles across the line, ranges along it.
TEST(Targets, AreMeasuredAsWellAsTheScannerIsCalibrated) {
  const auto sighted = [](std::optional<double> sigma_m) {
    Site site = tunnel(0.1, 0.3, 0.05, std::array{14.4, 1.0, 10.0});
    const auto stations = stations_of(site);
    std::vector<Target> targets{{.name = "near", .centre = {17, 1, 1.5}}};
    return std::pair(sight_targets(site.simulator(), site.clash(), stations, targets, {.sigma_m = sigma_m}).at(0),
                     stations);
  };
  for (const double fitted_mm : {0.2, 0.7}) {
    const auto [target, stations] = sighted(fitted_mm == 0.2 ? std::nullopt : std::optional(1e-3 * fitted_mm));
    ASSERT_EQ(target.seen_by.size(), 2u);
    for (const RegistrationTarget::Sighting& seen : target.seen_by) {
      const Vec3 line = Vec3{17, 1, 1.5} - stations[seen.station].position;
      const double range = std::sqrt(dot(line, line)), angle = 14.4 / 3600 * std::numbers::pi / 180;
      EXPECT_NEAR(seen.across_m, std::hypot(1e-3 * fitted_mm, angle * range), 1e-9);
      EXPECT_NEAR(seen.along_m, std::hypot(1e-3 * fitted_mm, 0.001, 1e-5 * range), 1e-9);
    }
  }
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
