// SPDX-License-Identifier: Apache-2.0
// One evaluation, compared with the functions of its counts, called one by one.
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "support/quad_scene.hpp"
#include "support/site_of.hpp"
#include "vantage/error.hpp"
#include "vantage/evaluate.hpp"
#include "vantage/evaluation.hpp"
#include "vantage/export.hpp"
#include "vantage/registration.hpp"
#include "vantage/summary.hpp"

namespace vantage {
namespace {

struct Bench {
  Site whole = test::site_of(Simulator(test::wall_and_floor().scene(), test::coarse_scanner(2),
                                       {.engine = Engine::embree, .user_size_m = 0.4, .point_spacing_m = 0.1}));
  Simulator &simulator = whole.simulator(), &surroundings = whole.surroundings();
  OnSite on_site = whole.on_site();
  std::vector<PlacedStation> stations{{.position = {-2, 0, 1.5}, .existing = true},
                                      {.position = {1, 1, 1.5}},
                                      {.position = {2, 0, 1.5}},
                                      {.position = {0, 0, 1.5}, .status = StationStatus::clash}};
  Network network = to_network(stations);
  EvaluationSite site{
      .simulator = simulator, .surroundings = &surroundings, .on_site = &on_site, .clash = &whole.clash()};
};

void expect_equal(const PairMatrix& a, const PairMatrix& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < a.size(); ++j) EXPECT_EQ(a(i, j), b(i, j)) << i << ", " << j;
}

TEST(EvaluateStations, HasTheFiguresOfEveryRay) {
  Bench bench;
  const RegistrationOptions registration;
  const AttainableCounts none(bench.simulator, bench.simulator.voxel_count());
  const Evaluation found = evaluate_stations(
      bench.site, bench.stations,
      {.field = true, .registration = registration, .attainable = &none, .names = {"", "P7", "", ""}});
  VoxelField field;
  const NetworkCounts counts =
      bench.simulator.evaluate(bench.network, {.field = &field, .registration = registration.model});
  const NetworkCounts around = bench.surroundings.evaluate(bench.network);
  EXPECT_TRUE(found.exact);
  EXPECT_EQ(found.voxels, bench.simulator.voxel_count());
  const double covered = coverage(counts, bench.simulator.goal_density());
  EXPECT_GT(covered, 0);
  EXPECT_EQ(found.value("coverage"), covered);
  EXPECT_EQ(found.value("capture"), 1) << "of what these stations alone attain";
  AttainableCounts own = none;
  ASSERT_TRUE(raise_attainable(own, bench.simulator, bench.network));
  ASSERT_TRUE(found.attainable);
  EXPECT_EQ(found.attainable->value, own.coverage().value);
  EXPECT_EQ(found.value("overlap"), clustering_coefficient(overlap_matrix(counts)));
  for (const auto& [name, estimate] : found.values) EXPECT_EQ(estimate.standard_error, 0) << name;
  expect_equal(found.overlap_matrix, overlap_matrix(counts));
  expect_equal(found.scan_overlap_matrix, scan_overlap_matrix(around));
  ASSERT_TRUE(found.registration);
  const RegistrationError error = registration_error(counts, found.voxels, registration);
  EXPECT_EQ(found.registration->rms_m, error.rms_m);
  EXPECT_EQ(found.value("registration"), 1000 * error.rms_m);
  EXPECT_EQ(found.field.count, field.count);
  EXPECT_EQ(found.counts.points_on_surveyed, counts.points_on_surveyed);
  ASSERT_TRUE(found.visit);
  EXPECT_EQ(found.visit->minutes, bench.on_site.visit(std::span(bench.stations).subspan(1)).minutes)
      << "the round without the existing station";
  ASSERT_TRUE(found.links());
  EXPECT_EQ(found.links()->measure, LinkMeasure::scan_overlap);
  EXPECT_EQ(station_names(found.stations, found.names), (std::vector<std::string>{"K1", "P7", "S2", "S3"}));
}

// Points of stations that do not exist yet, by every ray, and estimated from coarser scans of the surroundings: on the
// wall and the floor, and into the open.
TEST(EvaluateStations, TellsWhatTheScansHold) {
  Site whole = test::site_of(Simulator(test::wall_and_floor().scene(), test::coarse_scanner(0.1),
                                       {.engine = Engine::embree, .user_size_m = 0.4, .point_spacing_m = 0.1}));
  const std::vector<PlacedStation> stations{{.position = {-2, 0, 1.5}, .existing = true},
                                            {.position = {1, 1, 0.5}},
                                            {.position = {2, 0, 1.5}},
                                            {.position = {0, 0, 1.5}, .status = StationStatus::clash}};
  const EvaluationSite site{.simulator = whole.simulator(), .surroundings = &whole.surroundings()};
  const NetworkCounts counts = whole.simulator().evaluate(to_network(stations), {.skip = false});
  ASSERT_EQ(counts.points.size(), 4u);
  const auto points = static_cast<double>(counts.points[1] + counts.points[2]);
  EXPECT_GT(points, 1e6);
  EXPECT_LT(points, 0.9 * 2 * static_cast<double>(whole.simulator().scanner().rays()));
  const Evaluation counted = evaluate_stations(site, stations, {.skip = false}),
                   shared = evaluate_stations(site, stations);
  ASSERT_TRUE(counted.data && shared.data);
  EXPECT_EQ(counted.data->points, points);
  EXPECT_TRUE(shared.counts.points.empty());
  EXPECT_NEAR(shared.data->points / points, 1, 0.01);
  EXPECT_EQ(counted.data->las_bytes, 36 * points);
  EXPECT_FALSE(evaluate_stations({.simulator = whole.simulator()}, stations).data) << "nobody counted them";
  const auto json = nlohmann::json::parse(evaluation_json(counted));
  EXPECT_EQ(json["data"]["points"], points);
  EXPECT_NE(summary_text(counted).find("\ndata       about "), std::string::npos) << summary_text(counted);
}

TEST(EvaluateStations, TellsTheCalibrationThatTheRegistrationRestsOn) {
  std::vector<Scanner> scanners(4, test::coarse_scanner(0.5));
  scanners[1].angle_accuracy = Angle::degrees(18.0 / 3600), scanners[1].range_accuracy_m = 0.001;
  scanners[1].range_accuracy_ppm = 10;
  scanners[2].range_accuracy_m = 0.0025;
  scanners[3] = scanners[1];
  Site site = test::site_of(Simulator(test::wall_and_floor().scene(), scanners,
                                      {.engine = Engine::embree, .user_size_m = 0.4, .point_spacing_m = 0.1}));
  const auto told = [&](const std::vector<std::uint32_t>& of, bool registered) {
    std::vector<PlacedStation> stations;
    for (const std::uint32_t scanner : of) {
      const double k = static_cast<double>(stations.size());
      stations.push_back({.position = {1 + 0.5 * k, 1 - 0.5 * k, 0.5}, .setup = {.scanner = scanner}});
    }
    EvaluationOptions options;
    if (registered) options.registration.emplace();
    return evaluate_stations({.simulator = site.simulator()}, stations, options).calibration;
  };
  EXPECT_EQ(told({0, 0}, true), "") << "it states none";
  EXPECT_EQ(told({1, 3}, true), "18″, 1 mm and 10 ppm");
  EXPECT_EQ(told({1, 2}, true), "18″, 1 mm and 10 ppm; 2.5 mm");
  EXPECT_EQ(told({1, 1}, false), "") << "nobody asked for it";
}

TEST(EvaluateStations, LevelsScansAsTheirScannerDoesIfAsked) {
  const std::vector<PlacedStation> stations{{.position = {1, 1, 0.5}}, {.position = {2, 0, 1.5}}};
  const auto rms = [&](Angle stated, const RegistrationOptions& registration) {
    Scanner scanner = test::coarse_scanner(0.5);
    scanner.tilt_accuracy = stated;
    Site site = test::site_of(Simulator(test::wall_and_floor().scene(), scanner,
                                        {.engine = Engine::embree, .user_size_m = 0.4, .point_spacing_m = 0.1}));
    EvaluationOptions options;
    options.registration = registration;
    return evaluate_stations({.simulator = site.simulator()}, stations, options).registration->rms_m;
  };
  const Angle usual = RegistrationOptions().tilt, coarse = Angle::degrees(0.05);
  const RegistrationOptions asked{.tilt_of_scanner = true};
  EXPECT_EQ(rms(coarse, {}), rms(usual, {})) << "not asked";
  EXPECT_EQ(rms(coarse, asked), rms(usual, {.tilt = coarse}));
  EXPECT_GT(rms(coarse, asked), rms(usual, asked)) << "one wall does not hold all tilts";
  EXPECT_THROW(rms(Angle(), asked), Error) << "it states none";
}

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::invalid_argument);
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

TEST(EvaluateStations, AMeasureThatItLacksIsRefusedWithTheNearestName) {
  Bench bench;
  const Evaluation found = evaluate_stations({.simulator = bench.simulator}, bench.stations);
  EXPECT_EQ(message_of([&] { (void)found.value("covrage"); }),
            "the evaluation has no \"covrage\"; did you mean coverage?");
  EXPECT_EQ(message_of([&] { (void)found.value("registration"); }),
            "the evaluation has no \"registration\"; it has coverage, overlap; name others in what is to be measured");
}

// Two rooms of 4 × 5 × 2.5 m, and what is between them.
enum class Between { wall, pane, pane_with_door };

Evaluation of_two_rooms(Between between) {
  test::QuadScene scene;
  const auto board = [&](const Float3& corner, const Float3& u, const Float3& v) {
    scene.quad(corner, u, v, between == Between::wall ? Role::surveyed : Role::blocking);
    scene.data().meshes.back().glass = between != Between::wall;
  };
  for (const float z : {0.0f, 2.5f}) scene.quad({-4, 0, z}, {8, 0, 0}, {0, 5, 0});
  for (const float y : {0.0f, 5.0f}) scene.quad({-4, y, 0}, {8, 0, 0}, {0, 0, 2.5f});
  for (const float x : {-4.0f, 4.0f}) scene.quad({x, 0, 0}, {0, 5, 0}, {0, 0, 2.5f});
  board({0, 0, 0}, {0, between == Between::pane_with_door ? 3.0f : 5.0f, 0}, {0, 0, 2.5f});
  Site site = test::site_of(Simulator(scene.scene(), test::coarse_scanner(1),
                                      {.engine = Engine::embree, .user_size_m = 0.3, .point_spacing_m = 0.1}));
  const std::vector<PlacedStation> stations{
      {.position = {-1.3, 2.2, 1.7}}, {.position = {-2.5, 4, 1.7}}, {.position = {1.9, 3.6, 1.5}}};
  return site.evaluate(stations);
}

TEST(EvaluateStations, ALinkThroughGlassIsToldAndDoesNotCount) {
  const Evaluation found = of_two_rooms(Between::pane);
  const StationLinks links = *found.links();
  EXPECT_EQ(links.parts, (std::vector<std::vector<std::size_t>>{{0, 1}, {2}}));
  EXPECT_EQ(links.gaps.at(0).value, 0);
  ASSERT_EQ(links.through_glass.size(), 1u);
  EXPECT_EQ(links.through_glass[0].inside, 2u);
  EXPECT_GT(links.through_glass[0].value, 0.8);
  const std::string summary = summary_text(found);
  EXPECT_NE(summary.find("S3 and S"), std::string::npos) << summary;
  EXPECT_NE(summary.find("through glass, which does not count"), std::string::npos) << summary;
  const auto json = nlohmann::json::parse(evaluation_json(found));
  ASSERT_EQ(json["through_glass"].size(), 1u);
  EXPECT_EQ(json["through_glass"][0]["stations"][0], 3);
  EXPECT_EQ(json["through_glass"][0]["scan_overlap"], 0);
  EXPECT_EQ(json["through_glass"][0]["through_glass"], links.through_glass[0].value);
}

TEST(EvaluateStations, GlassIsLookedThroughOnlyWhereItMayPart) {
  const Evaluation wall = of_two_rooms(Between::wall), door = of_two_rooms(Between::pane_with_door);
  EXPECT_EQ(wall.links()->parts.size(), 2u);
  EXPECT_EQ(wall.through_glass.size(), 0u) << "no glass";
  EXPECT_EQ(door.links()->parts.size(), 1u);
  EXPECT_EQ(door.through_glass.size(), 0u) << "linked without it";
  for (const Evaluation* found : {&wall, &door}) {
    EXPECT_TRUE(found->links()->through_glass.empty());
    EXPECT_FALSE(nlohmann::json::parse(evaluation_json(*found)).contains("through_glass"));
  }
}

// Two walls of surveyed meshes, one to the east and one to the west, and ground that only blocks.
struct TwoWalls {
  Scene scene = [] {
    test::QuadScene quads = test::wall_and_floor({1e5, 2e5, 30});
    quads.quad({-6, -3, -1.5f}, {0, 6, 0}, {0, 0, 4});
    quads.data().meshes[0].name = "facade-east", quads.data().meshes[2].name = "facade-west";
    quads.data().meshes[1].name = "ground";
    return quads.scene();
  }();
  Simulator simulator{
      scene, test::coarse_scanner(2), {.engine = Engine::embree, .user_size_m = 0.4, .point_spacing_m = 0.1}};
  std::vector<PlacedStation> stations{{.position = {1e5 + 2, 2e5, 31}}, {.position = {1e5 - 5, 2e5 + 1, 31}}};
  EvaluationSite site{.simulator = simulator};
};

Objective captured_part(const std::string& pattern) {
  return {
      .name = "part", .scale = maximise(1, 0), .needs = {.meshes = true}, .value = [pattern](const MeasuredNetwork& m) {
        return captured(m, pattern);
      }};
}

TEST(EvaluateStations, VoxelsAreCountedByMesh) {
  TwoWalls walls;
  const auto evaluate = [&](const std::string& pattern, std::optional<std::uint64_t> sample) {
    return evaluate_stations(walls.site, walls.stations,
                             {.sample_voxels = sample, .field = !sample, .measures = {captured_part(pattern)}});
  };
  const Evaluation whole = evaluate("facade-e*", {});
  ASSERT_EQ(whole.counts.meshes.size(), 3u);
  EXPECT_EQ(whole.counts.meshes[1], MeshVoxels{});
  // The same, computed from the points of every voxel and the surfaces in them.
  std::vector<std::uint32_t> every(walls.simulator.voxel_count());
  for (std::uint32_t v = 0; v < every.size(); ++v) every[v] = v;
  const auto patches = walls.simulator.voxel_patches(every);
  std::vector<MeshVoxels> expected(3);
  for (const std::uint32_t v : every) {
    MeshVoxels& own = expected[patches[v].mesh];
    ++own.voxels, own.captured += whole.field.count[v] >= walls.simulator.goal_density(v);
  }
  EXPECT_EQ(whole.counts.meshes, expected);
  const auto share = [&](std::size_t m) {
    return static_cast<double>(expected[m].captured) / static_cast<double>(expected[m].voxels);
  };
  EXPECT_EQ(whole.value("part"), share(0));
  EXPECT_GT(share(0), 0);
  EXPECT_LT(share(0), share(2));
  EXPECT_EQ(evaluate("facade-west", {}).value("part"), share(2));
  EXPECT_EQ(evaluate("facade*", {}).value("part"),
            static_cast<double>(expected[0].captured + expected[2].captured) / static_cast<double>(every.size()));
  EXPECT_EQ(whole.values.at("part").standard_error, 0);

  // A sample has a standard error, within three of which the share lies.
  const Evaluation sampled = evaluate("facade-west", every.size() / 3);
  const Estimate part = sampled.values.at("part");
  EXPECT_GT(part.standard_error, 0);
  EXPECT_NEAR(part.value, share(2), 3 * part.standard_error);
  std::uint64_t counted = 0;
  for (const MeshVoxels& mesh : sampled.counts.meshes) counted += mesh.voxels;
  EXPECT_EQ(counted, every.size() / 3);

  // Several networks at once, and one that sees nothing.
  std::vector<std::vector<PlacedStation>> networks{walls.stations, {walls.stations[0]}, {}};
  networks[2] = {{.position = walls.stations[0].position, .status = StationStatus::clash}};
  for (const auto sample : {std::optional<std::uint64_t>(), std::optional<std::uint64_t>(every.size())}) {
    const auto all =
        evaluate_networks(walls.site, networks, {.sample_voxels = sample, .measures = {captured_part("facade-w*")}});
    EXPECT_EQ(all[0].value("part"), share(2));
    EXPECT_LT(all[1].value("part"), share(2));
    EXPECT_EQ(all[2].value("part"), 0);
  }
}

TEST(EvaluateStations, APartThatIsNoSurveyedMeshIsRefused) {
  TwoWalls walls;
  const auto refused = [&](const Objective& part) {
    return message_of([&] { evaluate_stations(walls.site, walls.stations, {.measures = {part}}); });
  };
  EXPECT_EQ(refused(captured_part("facde-east")),
            "captured: no surveyed mesh is named like \"facde-east\"; did you mean facade-east?");
  EXPECT_EQ(refused(captured_part("ground")),
            "captured: no surveyed mesh is named like \"ground\"; there are facade-east, facade-west");
  Objective without = captured_part("facade*");
  without.needs = {};
  EXPECT_NE(refused(without).find("the objective has to need counts and meshes"), std::string::npos);
}

TEST(EvaluateStations, UncoveredVoxelsAreThoseBelowTheirGoal) {
  TwoWalls walls;
  const Evaluation found =
      evaluate_stations(walls.site, walls.stations, {.field = true, .measures = {captured_part("*")}});
  const UncoveredVoxels open = uncovered(walls.simulator, found);
  std::vector<MeshVoxels> rest = found.counts.meshes;
  for (std::size_t k = 0; k < open.voxels.size(); ++k) {
    const std::uint32_t v = open.voxels[k];
    ASSERT_TRUE(k == 0 || open.voxels[k - 1] < v);
    ASSERT_EQ(open.points[k], found.field.count[v]);
    ASSERT_LT(open.points[k], walls.simulator.goal_density(v));
    ASSERT_EQ(open.centres[k], walls.simulator.voxel_centre(v));
    --rest[open.meshes[k]].voxels;
  }
  EXPECT_GT(open.voxels.size(), 10u);
  for (const MeshVoxels& mesh : rest) EXPECT_EQ(mesh.voxels, mesh.captured);
  const Evaluation without = evaluate_stations(walls.site, walls.stations);
  EXPECT_NE(message_of([&] { uncovered(walls.simulator, without); }).find("keep the field"), std::string::npos);
}

TEST(EvaluateStations, OfASampleHasStandardErrors) {
  Bench bench;
  const RegistrationOptions registration;
  const std::uint64_t voxels = bench.simulator.voxel_count(), some = voxels / 3;
  const Evaluation found = evaluate_stations({.simulator = bench.simulator}, bench.stations,
                                             {.sample_voxels = some, .registration = registration});
  const NetworkCounts counts =
      bench.simulator.evaluate_sampled({&bench.network, 1}, {.voxels = some, .registration = registration.model})
          .front();
  EXPECT_FALSE(found.exact);
  EXPECT_EQ(found.counts.voxels, some);
  const Estimate covered = coverage_estimate(counts, bench.simulator.goal_density(), voxels);
  const Estimate overlap = overlap_estimate(counts, voxels);
  const Estimate rms = registration_estimate(counts, voxels, registration);
  EXPECT_GT(covered.standard_error, 0);
  EXPECT_EQ(found.value("coverage"), covered.value);
  EXPECT_EQ(found.values.at("coverage").standard_error, covered.standard_error);
  EXPECT_EQ(found.value("overlap"), overlap.value);
  EXPECT_EQ(found.values.at("overlap").standard_error, overlap.standard_error);
  EXPECT_EQ(found.value("registration"), 1000 * rms.value);
  EXPECT_EQ(found.values.at("registration").standard_error, 1000 * rms.standard_error);
  expect_equal(found.overlap_errors, overlap_standard_errors(counts, voxels));
  EXPECT_EQ(found.scan_overlap_matrix.size(), 0u);
  EXPECT_FALSE(found.visit);
  ASSERT_TRUE(found.links());
  EXPECT_EQ(found.links()->measure, LinkMeasure::overlap);
}

TEST(EvaluateStations, SeveralAtOnceAreEachAsAlone) {
  Bench bench;
  const std::vector<std::vector<PlacedStation>> networks{bench.stations, {bench.stations[1]}};
  const auto together = evaluate_networks(bench.site, networks, {.sample_voxels = 100});
  ASSERT_EQ(together.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    const Evaluation alone = evaluate_stations(bench.site, networks[k], {.sample_voxels = 100});
    EXPECT_EQ(together[k].value("coverage"), alone.value("coverage"));
    expect_equal(together[k].scan_overlap_matrix, alone.scan_overlap_matrix);
  }
}

TEST(EvaluateStations, MeasuresWhatIsAskedForAndSaysWhatIsViolated) {
  Bench bench;
  const std::vector<Requirement> requirements{make_requirement("link>=0.99"), make_requirement("time<=1"),
                                              make_requirement("coverage>=0")};
  const Evaluation found = evaluate_stations(
      bench.site, bench.stations,
      {.measures = {make_objective("fitness"), make_objective("stations")}, .requirements = requirements});
  for (const char* name : {"coverage", "overlap", "fitness", "stations", "link", "time"})
    EXPECT_TRUE(found.values.contains(name)) << name;
  EXPECT_EQ(found.value("stations"), 4);
  EXPECT_EQ(found.value("time"), found.visit->minutes);
  EXPECT_GT(found.violation, 0);
  EXPECT_EQ(found.violation,
            requirements[0].missed_by(found.value("link")) + requirements[1].missed_by(found.value("time")));
}

TEST(EvaluateStations, RefusesWhatItCannotMeasure) {
  Bench bench;
  const EvaluationSite bare{.simulator = bench.simulator};
  const auto refused = [&](const EvaluationOptions& options) {
    EXPECT_THROW(evaluate_stations(bare, bench.stations, options), Error);
  };
  refused({.measures = {make_objective("link")}});
  refused({.measures = {make_objective("time")}});
  refused({.measures = {make_objective("fitness")}});
  refused({.overlap = false, .registration = RegistrationOptions()});
  refused({.registration = RegistrationOptions{.surfaces = RegistrationSurfaces::all}});
  refused({.sample_voxels = 10, .field = true});
}

TEST(EvaluateStations, OfACancelledCallHasNoFigures) {
  Bench bench;
  std::stop_source stop;
  stop.request_stop();
  const Evaluation found = evaluate_stations(bench.site, bench.stations, {}, {.stop = stop.get_token()});
  EXPECT_TRUE(found.counts.cancelled);
  EXPECT_TRUE(found.values.empty());
  EXPECT_FALSE(found.links());
}

}  // namespace
}  // namespace vantage
