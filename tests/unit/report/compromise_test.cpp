// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "unit/report/files.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

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
  EXPECT_EQ(compromise(result, Problem::coverage_fix), 0u);
  EXPECT_EQ(compromise(result, Problem::coverage_overlap_fix), 1u);
  EXPECT_EQ(compromise(result, Problem::coverage_min), 2u);
  EXPECT_EQ(compromise(result, Problem::coverage_overlap_min), 2u);
}

TEST(Compromise, TakesWhatTheSearchSawWhereNothingWasConfirmed) {
  PlanResult result = front_of({{0, 0, 0}, {0, 0, 0}});
  for (PlanEntry& e : result.front) e.confirmed = false;
  result.front[0].coverage = 0.4, result.front[0].overlap = 0.4;
  result.front[1].coverage = 0.5, result.front[1].overlap = 0.5;
  EXPECT_EQ(compromise(result, Problem::coverage_overlap_fix), 1u);
}

TEST(Compromise, RefusesAnEmptyFront) { EXPECT_THROW(compromise({}, Problem::coverage_fix), Error); }

}  // namespace
}  // namespace vantage
