// SPDX-License-Identifier: Apache-2.0
#include "plan/answer.hpp"

#include <gtest/gtest.h>

#include "unit/formats/files.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

OverlapMatrix chain(double first, double second) {  // of three stations
  OverlapMatrix matrix(3);
  matrix.set(0, 1, first);
  matrix.set(1, 2, second);
  return matrix;
}

PlanResult front_of(SurveyProblem problem, std::initializer_list<std::array<double, 3>> values) {
  PlanResult result;
  result.problem = std::move(problem);
  result.measures = measures_of(result.problem).all;
  for (const auto& [coverage, overlap, alpha] : values) {
    PlanEntry e;
    e.x = {0.5, 0.5, alpha};
    e.exact = true;
    for (const Objective& measure : result.measures) e.searched[measure.name] = e.values[measure.name] = {0.5, 0};
    e.values["coverage"].value = coverage, e.values["overlap"].value = overlap;
    result.front.push_back(e);
  }
  return result;
}

TEST(Answer, IsNearestToTheBestOfAllObjectives) {
  const auto best_of = [](const SurveyProblem& problem) {
    return answer(front_of(problem, {{0.99, 0.16, 0.9}, {0.98, 0.75, 0.8}, {0.50, 1.00, 0.1}}));
  };
  EXPECT_EQ(best_of(coverage_fix(1)), 0u);
  EXPECT_EQ(best_of(coverage_overlap_fix(1)), 1u);
  EXPECT_EQ(best_of(coverage_min(1, 2)), 2u);
  EXPECT_EQ(best_of(coverage_overlap_min(1, 2)), 2u);
}

TEST(Answer, TakesWhatTheSearchSawWhereNothingWasConfirmed) {
  PlanResult result = front_of(coverage_overlap_fix(1), {{0, 0, 0}, {0, 0, 0}});
  for (std::size_t k = 0; k < 2; ++k) {
    result.front[k].exact = false;
    const double seen = 0.4 + 0.1 * static_cast<double>(k);
    result.front[k].values["coverage"] = result.front[k].values["overlap"] = {seen, 0};
  }
  EXPECT_EQ(answer(result), 1u);
}

TEST(Answer, HangsTogetherWhereAnyEntryDoes) {
  PlanResult result = front_of(coverage_overlap_fix(3), {{0.9, 0.5, 0}, {0.8, 0.5, 0}, {0.7, 0.5, 0}});
  result.front[0].overlap_matrix = chain(0.9, 0.005);
  result.front[1].overlap_matrix = chain(0.02, 0.02);
  result.front[2].overlap_matrix = chain(0.1, 0.1);
  const auto with_links_from = [&](double least) {
    result.problem.link_overlap = least;
    return answer(result);
  };
  EXPECT_EQ(with_links_from(default_link_overlap), 1u);
  EXPECT_EQ(with_links_from(0.001), 0u);
  EXPECT_EQ(with_links_from(0.05), 2u);
  EXPECT_EQ(with_links_from(0.5), 0u) << "none does";
  result.problem = coverage_fix(3);
  EXPECT_EQ(answer(result), 0u) << "overlap does not matter";
}

TEST(Answer, KeepsTheRequirementsWhereAnyEntryDoes) {
  PlanResult result = front_of(coverage_overlap_fix(1), {{0.99, 0.9, 0}, {0.5, 0.5, 0}, {0.6, 0.3, 0}});
  result.front[0].violation = 0.01;
  EXPECT_EQ(answer(result), 1u);
  result.front[1].violation = 0.2, result.front[2].violation = 0.1;
  EXPECT_EQ(answer(result), 0u) << "none does: the one that misses least";
}

TEST(Answer, HasTheFewestStationsThatKeepWhatIsRequired) {
  PlanResult result = front_of(coverage_overlap_fix(1), {{0.95, 0.9, 0}, {0.91, 0.5, 0}, {0.92, 0.6, 0}});
  result.problem.fewest = true;
  result.problem.requirements = {make_requirement("coverage>=0.9")};
  result.front[0].stations.resize(3), result.front[1].stations.resize(2), result.front[2].stations.resize(2);
  EXPECT_EQ(answer(result), 2u) << "then the best";
  EXPECT_TRUE(met(result));
  EXPECT_TRUE(what_would_help(result).empty());
  for (PlanEntry& entry : result.front) entry.violation = 0.1;
  result.front[0].violation = 0.05, result.front[0].values["coverage"].value = 0.85;
  EXPECT_EQ(answer(result), 0u);
  EXPECT_FALSE(met(result));
  ASSERT_EQ(what_would_help(result).size(), 1u);
  EXPECT_NE(what_would_help(result)[0].find("share captured of the site at least 90 %, it has 85.0 %"),
            std::string::npos);
  result.front[0].violation = 0, result.front[0].exact = false;
  EXPECT_FALSE(met(result)) << "not for sure";
}

TEST(Answer, AdvisesMoreStationsOnlyWhereMoreMayBeAllowed) {
  PlanResult result = front_of(coverage_overlap_fix(1), {{0.85, 0.9, 0}});
  result.problem.requirements = {make_requirement("coverage>=0.9")};
  result.front[0].violation = 0.05;
  const auto asks_for_more = [&](std::size_t placed, std::size_t allowed) {
    result.problem.stations_max = allowed;
    result.front[0].stations.resize(placed);
    const bool asks = advised_requirements(result)[0].objective.advice.find("more stations") != std::string::npos;
    EXPECT_EQ(what_would_help(result).at(0).find("allow more stations") != std::string::npos, asks);
    return asks;
  };
  EXPECT_TRUE(asks_for_more(5, 5));
  EXPECT_FALSE(asks_for_more(4, 5)) << "one more may be placed as it is";
  EXPECT_FALSE(asks_for_more(19, max_stations));
  EXPECT_FALSE(asks_for_more(max_stations, max_stations)) << "there may be no more";
}

TEST(Answer, RefusesAnEmptyFront) { EXPECT_THROW(answer({}), Error); }

}  // namespace
}  // namespace vantage
