// SPDX-License-Identifier: Apache-2.0
// `PlanConfig::max_seconds` limits the whole call of plan().
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "support/quad_scene.hpp"
#include "support/site_of.hpp"
#include "vantage/candidates.hpp"
#include "vantage/planner.hpp"
#include "vantage/question.hpp"

namespace vantage {
namespace {

class TimeLimit : public testing::Test {
 protected:
  static SearchArea ground() {
    return SearchArea::from_mesh({.positions = {{0, -2, -1.5}, {3, -2, -1.5}, {3, 2, -1.5}, {0, 2, -1.5}},
                                  .uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
                                  .triangles = {{0, 1, 2}, {0, 2, 3}}});
  }
  PlanResult plan(const SurveyProblem& problem, const PlanConfig& config, const PlanWatch& watch = {}) {
    return vantage::plan(site_, problem, config, watch);
  }

  static Site site(const Scanner& scanner) {
    return test::site_of(Simulator(test::wall_and_floor().scene(), scanner,
                                   {.engine = Engine::embree, .user_size_m = 0.5, .point_spacing_m = 0.2}),
                         ground(), {.radius_m = 0});
  }
  Site site_ = site(test::coarse_scanner());
};

TEST_F(TimeLimit, EndsTheLookAndClaimsNothing) {
  const PlanResult result = plan(fewest_stations(0.9, 0, 1, 8, 0), {.sample_voxels = 200, .max_seconds = 1e-6});
  EXPECT_EQ(result.stop_reason, StopReason::max_time);
  ASSERT_TRUE(result.candidates);
  EXPECT_EQ(result.candidates->ended(), "cancelled");
  EXPECT_FALSE(met(result));
  for (const PlanEntry& entry : result.front) {
    EXPECT_FALSE(entry.exact);
    EXPECT_TRUE(std::isnan(entry.value("coverage")));
  }
}

TEST_F(TimeLimit, EndsTheSearchAndConfirmsWhatItFound) {
  double longest = 0;
  // Few rays, so that networks differ: with more, all capture everything, and the search ends by itself.
  Site few_rays = site(test::coarse_scanner(5));
  const PlanResult result =
      vantage::plan(few_rays, coverage_overlap_fix(3),
                    {.population = 10, .iterations = 100'000'000, .sample_voxels = 200, .max_seconds = 2},
                    {.report = [&](const PlanProgress& now) { longest = std::max(longest, now.seconds_left); }});
  EXPECT_EQ(result.stop_reason, StopReason::max_time);
  EXPECT_GT(result.evaluations, 0u);
  EXPECT_LE(longest, 2);
  ASSERT_FALSE(result.front.empty());
  for (const PlanEntry& entry : result.front) EXPECT_TRUE(entry.exact) << "there was a fifth of the time for it";
}

TEST_F(TimeLimit, LeavesTheCallerWhatItAsksFor) {
  std::vector<std::pair<std::size_t, double>> asked;
  Site few_rays = site(test::coarse_scanner(5));
  const PlanResult result =
      vantage::plan(few_rays, coverage_overlap_fix(3),
                    {.population = 10, .iterations = 100'000'000, .sample_voxels = 200, .max_seconds = 6},
                    {.seconds_after = [&](std::size_t stations, double seconds_a_station) {
                      asked.emplace_back(stations, seconds_a_station);
                      return 2.9 + static_cast<double>(stations) * seconds_a_station;
                    }});
  EXPECT_EQ(result.stop_reason, StopReason::max_time);
  EXPECT_LT(result.seconds, 4);
  ASSERT_GT(asked.size(), 2u) << "at the beginning, before the search, and after it";
  EXPECT_EQ(asked.front(), (std::pair<std::size_t, double>{0, 0}));
  for (const auto& [stations, seconds] : std::span(asked).subspan(1)) {
    EXPECT_EQ(stations, 3u);
    EXPECT_GT(seconds, 0);
  }
  for (const PlanEntry& entry : result.front) EXPECT_TRUE(entry.exact);
}

// As if the time were over after one network.
TEST_F(TimeLimit, CountsTheAnswerFirst) {
  Site few_rays = site(test::coarse_scanner(5));
  std::stop_source abort;
  int asked = 0;  // at the beginning, before the search, and once the first network is counted
  const PlanResult result =
      vantage::plan(few_rays, coverage_overlap_fix(3),
                    {.population = 10, .iterations = 20, .sample_voxels = 100, .max_seconds = 1000},
                    {.abort = abort.get_token(), .seconds_after = [&](std::size_t, double) {
                       if (++asked == 3) abort.request_stop();
                       return 0.0;
                     }});
  ASSERT_GT(result.front.size(), 1u);
  EXPECT_EQ(std::ranges::count(result.front, true, &PlanEntry::exact), 1);
  const PlanEntry& entry = result.front[answer(result)];
  EXPECT_TRUE(entry.exact);
  EXPECT_TRUE(entry.visit);
}

TEST_F(TimeLimit, LeavesNothingUnknownThatPositionsTell) {
  SurveyProblem problem = coverage_fix(3);
  problem.requirements = {make_requirement("apart>=0.5", problem.settings())};
  std::stop_source abort;
  abort.request_stop();
  const PlanResult result = plan(problem, {.iterations = 3, .sample_voxels = 100}, {.abort = abort.get_token()});
  ASSERT_FALSE(result.front.empty());
  for (const PlanEntry& entry : result.front) {
    EXPECT_FALSE(entry.exact);
    EXPECT_TRUE(std::isfinite(entry.value("apart")));
  }
}

TEST_F(TimeLimit, IsNotBlamedForAStopByTheCaller) {
  std::stop_source stop;
  const PlanResult result =
      plan(coverage_fix(3), {.iterations = 100'000'000, .sample_voxels = 200, .max_seconds = 1000},
           {.report =
                [&](const PlanProgress& now) {
                  if (now.evaluations > 20) stop.request_stop();
                },
            .stop = stop.get_token()});
  EXPECT_EQ(result.stop_reason, StopReason::cancelled);
}

// If the look is cut short, attainable coverage is too low, and shares of it are too high.
TEST_F(TimeLimit, ALookCutShortLeavesCaptureUnknown) {
  PlanResult result = plan(fewest_stations(0.5, 0, 1, 8, 0), {.iterations = 2, .sample_voxels = 200});
  ASSERT_TRUE(met(result));
  std::stop_source stop;
  stop.request_stop();
  result.candidates = std::make_shared<const Candidates>(find_candidates(site_, {}, {.stop = stop.get_token()}));
  EXPECT_FALSE(met(result));
  ASSERT_EQ(what_would_help(result).size(), 1u);
  EXPECT_NE(what_would_help(result)[0].find("cut short"), std::string::npos);
}

}  // namespace
}  // namespace vantage
