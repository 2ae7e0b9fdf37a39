// SPDX-License-Identifier: Apache-2.0
// One evaluation against the functions of its counts, called one by one.
#include <gtest/gtest.h>

#include "support/quad_scene.hpp"
#include "support/site_of.hpp"
#include "vantage/error.hpp"
#include "vantage/evaluation.hpp"

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
