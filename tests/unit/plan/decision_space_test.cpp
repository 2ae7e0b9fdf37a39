// SPDX-License-Identifier: Apache-2.0
#include "plan/decision_space.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/plan/toy_survey.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

PlanConfig config_of(Problem problem, std::size_t low, std::size_t high) {
  return {.problem = problem, .stations_min = low, .stations_max = high};
}

TEST(DecisionSpace, HasTheDimensionsOfSection44) {
  const Site site = test::toy_site();
  EXPECT_EQ(DecisionSpace(site, config_of(Problem::coverage_fix, 4, 4)).dimension(), 8u);
  EXPECT_EQ(DecisionSpace(site, config_of(Problem::coverage_overlap_min, 8, 20)).dimension(), 41u);
  PlanConfig heights = config_of(Problem::coverage_min, 2, 3);
  heights.heights_m = {1.2, 2.4};
  const DecisionSpace space(site, heights);
  EXPECT_EQ(space.dimension(), 10u);
  EXPECT_EQ(space.bounds().lower, (std::vector<double>{0, 0, 0, 0, 0, 0, 1.2, 1.2, 1.2, 0}));
  EXPECT_EQ(space.bounds().upper, (std::vector<double>{1, 1, 1, 1, 1, 1, 2.4, 2.4, 2.4, 1}));
}

TEST(DecisionSpace, KnowsWhichCoordinatesMakeAStation) {
  const Site site = test::toy_site();
  PlanConfig config = config_of(Problem::coverage_min, 2, 3);
  EXPECT_EQ(DecisionSpace(site, config).blocks(), (std::vector<std::vector<std::size_t>>{{0, 1}, {2, 3}, {4, 5}}));
  config.heights_m = {1.2, 2.4};
  EXPECT_EQ(DecisionSpace(site, config).blocks(),
            (std::vector<std::vector<std::size_t>>{{0, 1, 6}, {2, 3, 7}, {4, 5, 8}}));
}

TEST(DecisionSpace, DecodesByEquation7) {
  const Site site = test::toy_site();
  const DecisionSpace space(site, config_of(Problem::coverage_min, 2, 4));
  std::vector<double> x{0.1, 0.1, 0.9, 0.2, 0.5, 0.5, 0.01, 0.5, 0};
  EXPECT_EQ(space.decode(x).size(), 2u);
  x.back() = 0.25;  // half up
  EXPECT_EQ(space.decode(x).size(), 3u);
  x.back() = 1;
  const auto stations = space.decode(x);
  ASSERT_EQ(stations.size(), 4u);
  EXPECT_EQ(stations[0].position, (Vec3{1, 1, 4.5}));
  EXPECT_EQ(stations[1].status, StationStatus::ok);
  EXPECT_EQ(stations[2].status, StationStatus::hole);
  EXPECT_EQ(stations[3].status, StationStatus::clash);
  const Network network = to_network(stations);
  EXPECT_TRUE(network[0].active);
  EXPECT_FALSE(network[2].active);
  EXPECT_FALSE(network[3].active);
}

TEST(DecisionSpace, KeepsStationsAndVariesHeights) {
  const Site site = test::toy_site();
  PlanConfig config = config_of(Problem::coverage_overlap_fix, 2, 2);
  config.fixed = {{5, 5, 9}};  // above the hole: it was scanned from there all the same
  config.heights_m = {1, 2};
  const DecisionSpace space(site, config);
  const std::vector<double> x{0.1, 0.1, 0.9, 0.9, 1.25, 1.75};
  const auto stations = space.decode(x);
  ASSERT_EQ(stations.size(), 3u);
  EXPECT_EQ(stations[0].position, (Vec3{5, 5, 9}));
  EXPECT_EQ(stations[0].status, StationStatus::ok);
  EXPECT_EQ(stations[1].position.z, 4.25);
  EXPECT_EQ(stations[2].position.z, 4.75);
  EXPECT_EQ(space.coordinates(2), (std::vector<std::size_t>{2, 3}));
}

TEST(DecisionSpace, ObjectivesOfTable2) {
  const Site site = test::toy_site();
  const std::vector<double> x{0.1, 0.1, 0.9, 0.9, 0.25};
  const auto f = [&](Problem problem, std::size_t high, std::size_t parts) {
    const DecisionSpace space(site, config_of(problem, 1, high));
    std::vector<double> values(space.objectives());
    space.objectives_of(x, 0.75, 0.5, parts, values);
    return values;
  };
  EXPECT_EQ(f(Problem::coverage_fix, 1, 1), (std::vector<double>{0.25}));
  EXPECT_EQ(f(Problem::coverage_overlap_fix, 1, 1), (std::vector<double>{0.25, 0.5}));
  EXPECT_EQ(f(Problem::coverage_min, 2, 1), (std::vector<double>{0.25, 0.25}));
  EXPECT_EQ(f(Problem::coverage_overlap_min, 2, 1), (std::vector<double>{0.25, 0.5, 0.25}));
  EXPECT_EQ(f(Problem::coverage_overlap_min, 2, 3), (std::vector<double>{2.25, 2.5, 2.25}));
}

TEST(DecisionSpace, FitnessOfEquation1) {
  const Site site = test::toy_site();
  PlanConfig config = config_of(Problem::coverage_min, 4, 12);
  config.fitness = FitnessWeights{};
  const DecisionSpace space(site, config);
  ASSERT_EQ(space.objectives(), 1u);
  std::vector<double> x(25, 0.1), f(1);
  const auto fitness = [&](double alpha, double coverage, std::size_t parts) {
    x.back() = alpha;
    space.objectives_of(x, coverage, 0, parts, f);
    return 1 - f[0];
  };
  EXPECT_NEAR(fitness(0, 0.83, 1), 0.4 * 0.83 + 0.4 + 0.2, 1e-15);  // the paper's best: 0.93
  EXPECT_NEAR(fitness(0, 0.83, 1), 0.93, 0.005);
  EXPECT_NEAR(fitness(1, 1, 4), 0.4 + 0.2 / 4, 1e-15);
  EXPECT_NEAR(fitness(0.5, 0, 2), 0.4 * (std::sqrt(2.0) - 1) + 0.1, 1e-15);

  config.problem = Problem::coverage_overlap_min;
  EXPECT_THROW(DecisionSpace(site, config), Error);
}

TEST(VisibilityParts, CountsWhoSeesWhomWithinRange) {
  const Site site = test::toy_site();  // a wall at y = 5, range 6 m
  const Network network{{{1, 1, 0}, true}, {{6, 1, 0}, true}, {{9, 4, 0}, true}, {{1, 9, 0}, true}, {{9, 9, 0}, true}};
  EXPECT_EQ(visibility_parts(site, network), 3u);  // 1-2-3, 4, 5
  Network skipped = network;
  skipped[1].active = false;
  EXPECT_EQ(visibility_parts(site, skipped), 5u);
  EXPECT_EQ(visibility_parts(site, Network(1)), 1u);
}

TEST(DecisionSpace, EncodesAnInitialNetworkForEachNumber) {
  const Site site = test::toy_site();
  const std::vector<Vec3> heads{{1, 2, 4.5}, {8, 9, 4.5}, {9, 1, 4.5}};
  const DecisionSpace space(site, config_of(Problem::coverage_min, 2, 4));
  const auto xs = space.encode_each(heads);
  ASSERT_EQ(xs.size(), 2u);
  EXPECT_EQ(space.placed_count(xs[0]), 3u);
  EXPECT_EQ(space.placed_count(xs[1]), 2u);
  EXPECT_EQ(space.decode(xs[1])[1].uv, (Uv{0.8, 0.9}));
  const DecisionSpace fixed(site, config_of(Problem::coverage_overlap_fix, 3, 3));
  EXPECT_EQ(fixed.encode_each(heads).size(), 1u);
}

TEST(DecisionSpace, EncodesAnInitialNetwork) {
  const Site site = test::toy_site();
  PlanConfig config = config_of(Problem::coverage_min, 2, 4);
  config.heights_m = {1, 2};
  const DecisionSpace space(site, config);
  const std::vector<Vec3> heads{{1, 2, 4.7}, {8, 9, 4.5}, {9, 1, 9.0}};
  const auto x = space.encode(heads);
  EXPECT_EQ(space.placed_count(x), 3u);
  const auto stations = space.decode(x);
  EXPECT_NEAR(stations[0].position.z, 4.7, 1e-12);
  EXPECT_EQ(stations[1].uv, (Uv{0.8, 0.9}));
  EXPECT_EQ(stations[2].position.z, 5);  // no higher than the bounds
  const std::vector<Vec3> outside{{11, 2, 4.5}}, five(5, Vec3{1, 1, 4.5});
  EXPECT_THROW(space.encode(outside), Error);
  EXPECT_THROW(space.encode(five), Error);
}

TEST(DecisionSpace, RefusesWhatCannotBe) {
  const Site site = test::toy_site();
  const auto refused = [&](const PlanConfig& config, const std::string& part) {
    try {
      DecisionSpace space(site, config);
      ADD_FAILURE() << "not refused: " << part;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), Errc::invalid_argument);
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
    }
  };
  refused(config_of(Problem::coverage_fix, 0, 0), "at least one");
  refused(config_of(Problem::coverage_min, 5, 4), "5 is above stations_max 4");
  refused(config_of(Problem::coverage_fix, 4, 5), "4 to 5");
  refused(config_of(Problem::coverage_min, 4, 65), "65 were asked for");
  PlanConfig config = config_of(Problem::coverage_min, 4, 64);
  config.fixed = {{1, 1, 1}};
  refused(config, "65 were asked for");
  config = config_of(Problem::coverage_overlap_fix, 4, 4);
  config.sigma0 = 0;
  refused(config, "sigma0");
  config.sigma0 = 0.2, config.heights_m = {2, 1};
  refused(config, "heights_m");
  config.heights_m.reset(), config.population = 1;
  refused(config, "population of 1");
  config.population = 0, config.min_link_overlap = 1;
  refused(config, "min_link_overlap");
}

TEST(Problem, NamesReadBack) {
  for (const Problem p :
       {Problem::coverage_fix, Problem::coverage_overlap_fix, Problem::coverage_min, Problem::coverage_overlap_min})
    EXPECT_EQ(problem_from_string(to_string(p)), p);
  try {
    problem_from_string("coverage");
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("coverage-overlap-min"), std::string::npos);
  }
}

}  // namespace
}  // namespace vantage
