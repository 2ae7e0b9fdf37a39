// SPDX-License-Identifier: Apache-2.0
#include "vantage/objective.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "vantage/error.hpp"

namespace vantage {
namespace {

// Three stations, the first two of which share half of what they see.
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
            .kept = 1,
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
  EXPECT_EQ(value_of("parts", {.link_overlap = 0.5}), 3);  // the one link has 20 / 60
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
  EXPECT_EQ(weakest(4), 0.1);  // 1/10 is all that is left of the fourth
  counts.shared[4] = 0;
  EXPECT_EQ(weakest(4), 0);  // it stands alone
  counts.stations = 1, counts.seen = {5}, counts.shared = {};
  EXPECT_EQ(weakest(1), 1);  // nothing to link
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
  const Objective error{.name = "error", .label = "Error", .unit = "mm", .best = 0, .worst = 10};
  EXPECT_FALSE(error.maximised());
  EXPECT_EQ(error.scaled(0), 0);
  EXPECT_EQ(error.scaled(2.5), 0.25);
  EXPECT_EQ(error.scaled(20), 2);
  EXPECT_EQ(error.unscaled(0.25), 2.5);
  const Objective stations = make_objective("stations", {.stations_min = 4, .stations_max = 12});
  EXPECT_EQ(stations.unscaled(1.0 / 16), 5);  // by equation 7
  EXPECT_EQ((Objective{.best = 3, .worst = 3}).scaled(7), 0);
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
                      .needs = {.pairs = true},
                      .value = [](const MeasuredNetwork& m) {
                        return static_cast<double>(m.counts.seen[0]) / static_cast<double>(m.counts.voxels);
                      }};
  // Replicates 0.2 and 0.6 about 0.4: variance (1/2)·(0.04 + 0.04), less the share of the site that was sampled.
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
  for (const char* wrong : {"coverage", "coverage>0.9", "coverage=0.9", "coverage>=", "coverage>=x", "coverage>=nan",
                            "cover>=0.9", ">=0.9", "coverage>=0.9 0.8", "coverage>"})
    EXPECT_THROW(make_requirement(wrong), Error) << wrong;
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
