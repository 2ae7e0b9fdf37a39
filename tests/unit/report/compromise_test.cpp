// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "unit/report/files.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

OverlapMatrix chain(double first, double second) {  // of three stations
  OverlapMatrix matrix(3);
  matrix.set(0, 1, first);
  matrix.set(1, 2, second);
  return matrix;
}

PlanConfig config_of(Problem problem, double min_link_overlap = 0) {
  PlanConfig config;
  config.problem = problem;
  config.min_link_overlap = min_link_overlap;
  return config;
}

PlanResult front_of(std::initializer_list<std::array<double, 3>> values) {
  PlanResult result;
  for (const auto& [coverage, overlap, alpha] : values) {
    PlanEntry e;
    e.x = {0.5, 0.5, alpha};
    e.confirmed = true;
    e.exact_coverage = coverage, e.exact_overlap = overlap;
    result.front.push_back(e);
  }
  return result;
}

TEST(Compromise, HasTheLargestProductOfGains) {
  const PlanResult result = front_of({{0.99, 0.16, 0.9}, {0.98, 0.75, 0.8}, {0.50, 1.00, 0.1}});
  EXPECT_EQ(compromise(result, config_of(Problem::coverage_fix)), 0u);
  EXPECT_EQ(compromise(result, config_of(Problem::coverage_overlap_fix)), 1u);
  EXPECT_EQ(compromise(result, config_of(Problem::coverage_min)), 2u);
  EXPECT_EQ(compromise(result, config_of(Problem::coverage_overlap_min)), 2u);
}

TEST(Compromise, TakesWhatTheSearchSawWhereNothingWasConfirmed) {
  PlanResult result = front_of({{0, 0, 0}, {0, 0, 0}});
  for (PlanEntry& e : result.front) e.confirmed = false;
  result.front[0].coverage = 0.4, result.front[0].overlap = 0.4;
  result.front[1].coverage = 0.5, result.front[1].overlap = 0.5;
  EXPECT_EQ(compromise(result, config_of(Problem::coverage_overlap_fix)), 1u);
}

TEST(Compromise, HangsTogetherWhereAnyEntryDoes) {
  PlanResult result = front_of({{0.9, 0.5, 0}, {0.8, 0.5, 0}, {0.7, 0.5, 0}});
  result.front[0].exact_overlap_matrix = chain(0.9, 0.005);
  result.front[1].exact_overlap_matrix = chain(0.02, 0.02);
  result.front[2].exact_overlap_matrix = chain(0.1, 0.1);
  EXPECT_EQ(compromise(result, config_of(Problem::coverage_overlap_fix)), 1u);
  EXPECT_EQ(compromise(result, config_of(Problem::coverage_overlap_fix, 0.001)), 0u);
  EXPECT_EQ(compromise(result, config_of(Problem::coverage_overlap_fix, 0.05)), 2u);
  EXPECT_EQ(compromise(result, config_of(Problem::coverage_overlap_fix, 0.5)), 0u) << "none does";
  EXPECT_EQ(compromise(result, config_of(Problem::coverage_fix)), 0u) << "overlap does not matter";
}

TEST(Compromise, RefusesAnEmptyFront) { EXPECT_THROW(compromise({}, config_of(Problem::coverage_fix)), Error); }

}  // namespace
}  // namespace vantage
