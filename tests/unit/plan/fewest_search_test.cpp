// SPDX-License-Identifier: Apache-2.0
#include "plan/fewest_search.hpp"

#include <gtest/gtest.h>

#include "unit/plan/floor_survey.hpp"

namespace vantage {
namespace {

double limit_on(const SurveyProblem& problem, std::string_view name) {
  for (const Requirement& requirement : problem.requirements)
    if (requirement.objective.name == name) return requirement.limit;
  return -1;
}

TEST(FewestSearch, MovesRequirementsFurtherFromTheirLimits) {
  SurveyProblem problem = fewest_stations(0.8, 0.3, 1, 9, 1);
  problem.attainable = 0.5;
  for (Requirement& requirement : problem.requirements)
    if (requirement.objective.name == "capture") requirement.objective = make_objective("capture", problem.settings());
  const FewestAsked asked = fewest_asked(problem);
  const SurveyProblem moved = with_margins(problem, asked, 0.02, 0.05);
  EXPECT_DOUBLE_EQ(limit_on(moved, "capture"), 0.82);
  EXPECT_DOUBLE_EQ(limit_on(moved, "link"), 0.35);
  EXPECT_EQ(limit_on(moved, "apart"), limit_on(problem, "apart"));
  EXPECT_EQ(limit_on(with_margins(problem, asked, 0.3, 0), "capture"), 1) << "no more than all";
}

TEST(FewestSearch, TracesTwoStationsForEachCandidate) {
  const SurveyProblem problem = with_stations(test::floor_problem(0.7), 5);
  EXPECT_EQ(problem.stations_min, 5u);
  EXPECT_EQ(problem.stations_max, 5u);
  PlanConfig config{.population = 10, .iterations = 0};
  EXPECT_EQ(refining_config(problem, config, 1000).iterations, 40u);  // 2 × 1000 / (10 × 5)
  EXPECT_EQ(refining_config(problem, config, 10).iterations, 1u) << "at least";
  EXPECT_EQ(refining_config(problem, config, 100'000).iterations, 100u) << "at most";
  EXPECT_LT(refining_config(problem, config, 10).sigma0, config.sigma0);
  config.iterations = 7;
  EXPECT_EQ(refining_config(problem, config, 1000).iterations, 7u) << "as asked";
}

TEST(FewestSearch, TriesTenNetworksForEachCoordinateOrNone) {
  const PlanConfig config{.population = 10, .iterations = 10};
  SurveyProblem problem = test::floor_problem(0.7);
  problem.stations_max = 5;
  EXPECT_TRUE(worth_searching(problem, config));
  problem.stations_max = 6;
  EXPECT_FALSE(worth_searching(problem, config));
}

}  // namespace
}  // namespace vantage
