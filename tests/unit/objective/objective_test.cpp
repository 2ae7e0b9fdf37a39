// SPDX-License-Identifier: Apache-2.0
#include "vantage/objective.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "vantage/error.hpp"

namespace vantage {
namespace {

// Three stations; the first two share half of what they see.
struct Survey {
  NetworkCounts counts;
  std::vector<PlacedStation> stations = std::vector<PlacedStation>(3);
  Survey() {
    counts.stations = 3, counts.voxels = counts.weight = 100, counts.saturated = 50, counts.partial_points = 100;
    counts.seen = {40, 40, 10};
    counts.shared = {20, 0, 0};
  }
  MeasuredNetwork measured() const {
    return {.counts = counts,
            .stations = stations,
            .existing = 1,
            .goal_density = 4,
            .voxels = 100,
            .overlap = overlap_matrix(counts),
            .visible_parts = 2};
  }
};

double value_of(const std::string& name, const ObjectiveSettings& settings = {}) {
  const Survey survey;
  return make_objective(name, settings).value(survey.measured());
}

TEST(Objective, BuiltInOnesAreTheFormulasTheyName) {
  const Survey survey;
  EXPECT_EQ(value_of("coverage"), coverage(survey.counts, 4));
  EXPECT_EQ(value_of("coverage"), 0.75);
  EXPECT_EQ(value_of("overlap"), clustering_coefficient(overlap_matrix(survey.counts)));
  EXPECT_EQ(value_of("stations"), 3);
  EXPECT_EQ(value_of("parts"), 2);
  EXPECT_EQ(value_of("parts", {.link_overlap = 0.5}), 3);  // the only link has 20 / 60
}

TEST(Objective, TheWeakestLinkIsThatOfTheStrongestTree) {
  NetworkCounts counts;
  counts.stations = 4, counts.seen = {100, 50, 40, 10};
  //                0-1 0-2 0-3 1-2 1-3 2-3
  counts.shared = {25, 4, 0, 20, 1, 4};
  const auto weakest = [&](std::size_t stations) {
    const std::vector<PlacedStation> placed(stations);
    return make_objective("weakest_link")
        .value({.counts = counts, .stations = placed, .overlap = overlap_matrix(counts)});
  };
  EXPECT_EQ(weakest(4), 0.4);  // 25/50, 20/40 and 4/10 span it
  counts.shared[5] = 0;
  EXPECT_EQ(weakest(4), 0.1);  // the fourth is linked only by 1/10
  counts.shared[4] = 0;
  EXPECT_EQ(weakest(4), 0);  // the fourth is not connected
  counts.stations = 1, counts.seen = {5}, counts.shared = {};
  EXPECT_EQ(weakest(1), 1);  // nothing to link
}

TEST(Objective, LinkIsOverAllSurfaces) {
  NetworkCounts surveyed, around;
  surveyed.stations = around.stations = 3;
  surveyed.seen = {10, 10, 10}, surveyed.shared = {0, 0, 0};  // no surveyed surface is shared
  around.seen = {100, 50, 40};
  //               0-1 0-2 1-2
  around.shared = {25, 2, 16};
  const auto link = [&](std::size_t stations) {
    const std::vector<PlacedStation> placed(stations);
    return make_objective("link").value({.counts = surveyed, .stations = placed, .surroundings = &around});
  };
  EXPECT_EQ(link(3), 0.4);  // 25/50 and 16/40 span it
  around.shared[2] = 0;
  EXPECT_EQ(link(3), 0.05);
  around.shared[1] = 0;
  EXPECT_EQ(link(3), 0) << "in two parts";
  around.stations = 1, around.seen = {5}, around.shared = {};
  EXPECT_EQ(link(1), 1);
  EXPECT_TRUE(make_objective("link").needs.surroundings);
  EXPECT_FALSE(make_objective("link").needs.counts);
}

TEST(Objective, LinksErrorComesFromTheSurroundingsSample) {
  NetworkCounts surveyed, around, half, rest;
  for (NetworkCounts* counts : {&around, &half, &rest}) counts->stations = 2;
  around.voxels = 100, around.seen = {40, 40}, around.shared = {20};
  half.voxels = rest.voxels = 50;
  half.seen = {20, 20}, half.shared = {8}, rest.seen = {20, 20}, rest.shared = {12};
  around.groups = {half, rest};
  const std::vector<PlacedStation> placed(2);
  MeasuredNetwork measured{.counts = surveyed, .stations = placed};
  measured.surroundings = &around, measured.surroundings_voxels = 1000;
  const Estimate link = estimate(make_objective("link"), measured);
  EXPECT_EQ(link.value, 0.5);
  // Replicates 0.6 and 0.4 about 0.5, less the sampled tenth.
  EXPECT_NEAR(link.standard_error, std::sqrt(0.9 * 0.5 * 0.02), 1e-12);
  measured.surroundings_voxels = 100;
  EXPECT_EQ(estimate(make_objective("link"), measured).standard_error, 0);
}

TEST(Objective, CaptureIsOfWhatIsAttainable) {
  EXPECT_TRUE(std::isnan(value_of("capture"))) << "nobody counted it";
  const NetworkCounts counts;
  MeasuredNetwork measured{.counts = counts, .stations = {}};
  measured.captured = {0.8, 0.01};
  const Objective capture = make_objective("capture", {.attainable = 0.6});
  const Estimate share = estimate(capture, measured);
  EXPECT_EQ(share.value, 0.8);
  EXPECT_DOUBLE_EQ(share.standard_error, 0.01) << "of the voxels that it was counted on";
  EXPECT_EQ(capture.coverage_of_one, 0.6);
  EXPECT_THROW(make_objective("capture", {.attainable = 0}), Error);
  EXPECT_THROW(make_objective("capture", {.attainable = 1.5}), Error);
}

TEST(Objective, CaptureOfMeshesIsThatOfTheirPattern) {
  const NetworkCounts counts;
  MeasuredNetwork measured{.counts = counts, .stations = {}};
  measured.captured = {0.8, 0.01};
  measured.captured_of_meshes = {{"IfcWall*", {0.9, 0.02}}, {"!IfcWall*", {0.6, 0.03}}};
  for (const auto& [pattern, share] : measured.captured_of_meshes) {
    const Objective capture = make_objective("capture(" + pattern + ")");
    EXPECT_EQ(capture.meshes, pattern);
    EXPECT_EQ(estimate(capture, measured).value, share.value);
    EXPECT_DOUBLE_EQ(estimate(capture, measured).standard_error, share.standard_error);
    EXPECT_TRUE(capture.kind == Objective::Kind::other) << "it is no limit on all that is captured";
  }
  EXPECT_TRUE(std::isnan(make_objective("capture(IfcSlab*)").value(measured))) << "nobody counted it";
  const Requirement odd = make_requirement("capture(Wall <a>=2 (old))>=0.95");
  EXPECT_EQ(odd.objective.meshes, "Wall <a>=2 (old)");
  EXPECT_EQ(odd.limit, 0.95);
  EXPECT_NE(in_words(make_requirement("capture(!IfcWall*)>=0.8")).find("of all but IfcWall* at least 80 %"),
            std::string::npos);
  for (const char* wrong : {"capture()", "capture(!)", "capture(a", "coverage(a)"})
    EXPECT_THROW(make_objective(wrong), Error) << wrong;
}

TEST(Objective, ApartIsBetweenTheNearestTwo) {
  const NetworkCounts counts;
  std::vector<PlacedStation> placed(3);
  placed[1].position = {3, 4, 0}, placed[2].position = {3, 4, 2};
  const auto apart = [&] { return make_objective("apart").value({.counts = counts, .stations = placed}); };
  EXPECT_EQ(apart(), 2);
  placed[2].status = StationStatus::hole;
  EXPECT_EQ(apart(), 5);
  placed.resize(1);
  EXPECT_EQ(apart(), std::numeric_limits<double>::infinity());
  const Requirement apart_by_1 = make_requirement("apart>=1");
  EXPECT_EQ(apart_by_1.missed_by(apart()), 0);
  EXPECT_EQ(apart_by_1.missed_by(0.25), 0.75);
}

TEST(Objective, TimeIsWhatTheRoundTakes) {
  const NetworkCounts counts;
  const std::vector<PlacedStation> placed(2);
  MeasuredNetwork measured{.counts = counts, .stations = placed};
  measured.minutes_on_site = 42;
  const Objective time = make_objective("time", {.stations_max = 4});
  EXPECT_EQ(time.value(measured), 42);
  EXPECT_FALSE(time.maximised());
  EXPECT_EQ(time.scaled(120), 0.5) << "of an hour a station";
}

TEST(Objective, ThoseOfASearchNeedWhatAnyNeeds) {
  const std::vector<Objective> all{make_objective("link"), make_objective("coverage")};
  EXPECT_FALSE(required_inputs_of({}).counts);
  EXPECT_FALSE(required_inputs_of(std::span(all).first(1)).counts);
  EXPECT_TRUE(required_inputs_of(std::span(all).first(1)).surroundings);
  EXPECT_TRUE(required_inputs_of(all).counts);
  EXPECT_TRUE(required_inputs_of(all).surroundings);
}

TEST(Objective, FitnessIsEquation1) {
  const auto fitness = [](std::size_t stations, double covered, std::size_t parts) {
    NetworkCounts counts;
    counts.weight = 1'000'000, counts.saturated = static_cast<std::uint64_t>(1e6 * covered);
    const std::vector<PlacedStation> placed(stations);
    return make_objective("fitness", {.stations_min = 4, .stations_max = 12})
        .value({.counts = counts, .stations = placed, .visible_parts = parts});
  };
  EXPECT_NEAR(fitness(4, 0.83, 1), 0.4 * 0.83 + 0.4 + 0.2, 1e-12);  // the paper's best: 0.93
  EXPECT_NEAR(fitness(4, 0.83, 1), 0.93, 0.005);
  EXPECT_NEAR(fitness(12, 1, 4), 0.4 + 0.2 / 4, 1e-12);
  EXPECT_NEAR(fitness(8, 0, 2), 0.4 * (std::sqrt(2.0) - 1) + 0.1, 1e-12);
  EXPECT_THROW(make_objective("fitness", {.fitness = {.coverage = 2}}), Error);
}

TEST(Objective, ScalesBetweenBestAndWorst) {
  const Objective error{.name = "error", .label = "Error", .unit = "mm", .scale = minimise(0, 10)};
  EXPECT_FALSE(error.maximised());
  EXPECT_EQ(error.scaled(0), 0);
  EXPECT_EQ(error.scaled(2.5), 0.25);
  EXPECT_EQ(error.scaled(20), 2);
  EXPECT_EQ(error.unscaled(0.25), 2.5);
  const Objective stations = make_objective("stations", {.stations_min = 4, .stations_max = 12});
  EXPECT_EQ(stations.unscaled(1.0 / 16), 5);  // by equation 7
  for (const char* name : {"registration", "registration_worst"})
    EXPECT_EQ(make_objective(name).scaled(10), 1) << name;  // mm
  EXPECT_EQ((Objective{.scale = minimise(3, 3)}).scaled(7), 0);
  EXPECT_TRUE((Objective{.scale = maximise(1, 0)}).maximised());
  EXPECT_FALSE(Objective{}.scale.given());
  EXPECT_THROW(minimise(1, 0), Error);
  EXPECT_THROW(maximise(0, 1), Error);
  EXPECT_THROW(minimise(0, std::numeric_limits<double>::infinity()), Error);
  EXPECT_THROW(maximise(std::numeric_limits<double>::quiet_NaN(), 0), Error);
}

TEST(Objective, StandardErrorsComeByTheJackknifeWhereNoneIsGiven) {
  Survey survey;
  NetworkCounts half = survey.counts;
  half.voxels = half.weight = 50, half.seen = {30, 10, 5}, half.shared = {8, 0, 0};
  half.saturated = 30, half.partial_points = 50;
  NetworkCounts rest = survey.counts;
  rest.voxels = rest.weight = 50, rest.seen = {10, 30, 5}, rest.shared = {12, 0, 0};
  rest.saturated = 20, rest.partial_points = 50;
  survey.counts.groups = {half, rest};
  MeasuredNetwork measured = survey.measured();
  measured.voxels = 1000;
  const Estimate overlap = estimate(make_objective("overlap"), measured);
  const Estimate by_formula = overlap_estimate(survey.counts, 1000);
  EXPECT_EQ(overlap.value, by_formula.value);
  EXPECT_EQ(overlap.standard_error, by_formula.standard_error);

  const Objective own{.name = "own",
                      .label = "Share of voxels that the first station sees",
                      .scale = maximise(1, 0),
                      .needs = {.pairs = true},
                      .value = [](const MeasuredNetwork& m) {
                        return static_cast<double>(m.counts.seen[0]) / static_cast<double>(m.counts.voxels);
                      }};
  // Replicates 0.2 and 0.6 about 0.4: variance (1/2)·(0.04 + 0.04), less the sampled share of the site.
  EXPECT_NEAR(estimate(own, measured).standard_error, std::sqrt(0.9 * 0.04), 1e-12);
  EXPECT_EQ(estimate(make_objective("stations"), measured).standard_error, 0);
  measured.voxels = 100;  // all of them were counted
  EXPECT_EQ(estimate(own, measured).standard_error, 0);
}

TEST(Requirement, ReadsWhatIsAsked) {
  const Requirement covered = make_requirement(" coverage >= 0.9 ");
  EXPECT_EQ(to_string(covered), "coverage >= 0.9");
  EXPECT_EQ(covered.missed_by(0.95), 0);
  EXPECT_EQ(covered.missed_by(0.9), 0);
  EXPECT_NEAR(covered.missed_by(0.7), 0.2, 1e-15);
  EXPECT_EQ(covered.missed_by(std::nan("")), std::numeric_limits<double>::infinity());
  const Requirement few = make_requirement("stations<=8", {.stations_min = 4, .stations_max = 12});
  EXPECT_EQ(few.missed_by(10), 0.25);
  EXPECT_EQ(few.missed_by(8), 0);
  // Attainable coverage is known to some tenths of a per cent: a share that is printed as the limit meets it.
  const Requirement share = make_requirement("capture>=0.9");
  EXPECT_EQ(share.missed_by(0.89998), 0);
  EXPECT_EQ(share.missed_by(0.8996), 0);
  EXPECT_GT(share.missed_by(0.8994), 0);
  EXPECT_EQ(share.missed_by(Estimate{0.8985, 0.002}), 0) << "within its standard error";
  EXPECT_GT(share.missed_by(Estimate{0.8975, 0.002}), 0);
  EXPECT_GT(covered.missed_by(Estimate{0.8985, 0.002}), 0) << "is counted, not estimated, in the end";
  EXPECT_EQ(value_text(covered, 0.89998), "89.998 %");
  EXPECT_EQ(value_text(covered, 0.85), "85.0 %");
  for (const char* wrong : {"coverage", "coverage>0.9", "coverage=0.9", "coverage>=", "coverage>=x", "coverage>=nan",
                            "cover>=0.9", ">=0.9", "coverage>=0.9 0.8", "coverage>"})
    EXPECT_THROW(make_requirement(wrong), Error) << wrong;
}

TEST(Requirement, AdviceTellsAMissedValueFromItsLimit) {
  const Requirement capture = make_requirement("capture>=0.9");
  EXPECT_NE(advice(capture, 0.85).find(", it has 85.0 %;"), std::string::npos) << advice(capture, 0.85);
  EXPECT_NE(advice(capture, 0.89981).find(", it has 89.98 %;"), std::string::npos) << advice(capture, 0.89981);
  EXPECT_NE(advice(capture, 0.899999).find(", it has 89.9999 %;"), std::string::npos) << advice(capture, 0.899999);
}

TEST(Objective, NamesAreListedWhereOneIsUnknown) {
  for (const std::string& name : objective_names()) EXPECT_EQ(make_objective(name).name, name);
  try {
    make_objective("registration_error");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), Errc::invalid_argument);
    EXPECT_NE(std::string(e.what()).find("coverage, overlap, stations"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace vantage
