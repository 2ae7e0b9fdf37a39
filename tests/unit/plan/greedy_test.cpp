// SPDX-License-Identifier: Apache-2.0
#include "plan/greedy.hpp"

#include <gtest/gtest.h>

#include "unit/plan/toy_survey.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

TEST(Greedy, ChoosesAsTheEagerAlgorithmDoes) {
  const PlacementOracle site = test::toy_site();
  test::ToyEvaluator lazy, eager;
  lazy.at_once = 0;
  const GreedyConfig config{.stations = 6, .candidates = 150};
  const GreedyResult result = choose_greedily(site, lazy, config, {});
  ASSERT_EQ(result.stations.size(), 6u);
  EXPECT_FALSE(result.cancelled);
  EXPECT_EQ(result.evaluations, lazy.evaluated);

  // All candidates, tried again at every step. Choosing one station of each is how to get at them.
  test::ToyEvaluator recorder;
  std::vector<PlacedStation> candidates;
  recorder.before_each = [&](const PlacedNetwork& n) { candidates.push_back(n[0]); };
  choose_greedily(site, recorder, {.stations = 1, .candidates = 150}, {});
  ASSERT_EQ(candidates.size(), 150u);
  PlacedNetwork chosen;
  for (std::size_t step = 0; step < 6; ++step) {
    double best = -1;
    PlacedStation taken;
    for (const PlacedStation& c : candidates) {
      PlacedNetwork with = chosen;
      with.push_back(c);
      const double value = test::ToyEvaluator::coverage_of(with);
      if (value > best) best = value, taken = c;
    }
    chosen.push_back(taken);
    EXPECT_EQ(result.stations[step].position, taken.position) << step;
    EXPECT_NEAR(result.coverage[step], best, 1e-12);
  }
  EXPECT_LT(result.evaluations, 6u * 150 / 2);  // most candidates were looked at once
}

TEST(Greedy, CandidatesStandOnlyWhereTheyMay) {
  const PlacementOracle site = test::toy_site();
  test::ToyEvaluator evaluator;
  const GreedyResult result = choose_greedily(site, evaluator, {.stations = 40, .candidates = 50}, {});
  EXPECT_EQ(result.stations.size(), 40u);
  for (const PlacedStation& s : result.stations) EXPECT_EQ(s.status, StationStatus::ok);
  EXPECT_THROW(choose_greedily(site, evaluator, {.stations = 8, .candidates = 5}, {}), Error);
  EXPECT_THROW(choose_greedily(site, evaluator, {.stations = max_stations + 1, .candidates = 500}, {}), Error);
  PlacementOracle nowhere = site;
  nowhere.locate = [](Uv) { return std::nullopt; };
  EXPECT_THROW(choose_greedily(nowhere, evaluator, {}, {}), Error);
}

TEST(Greedy, AddsToWhatIsThere) {
  const PlacementOracle site = test::toy_site();
  test::ToyEvaluator evaluator;
  const GreedyResult alone = choose_greedily(site, evaluator, {.stations = 4, .candidates = 150}, {});
  GreedyConfig config{.stations = 2, .candidates = 150};
  config.fixed = {alone.stations[0].position, alone.stations[1].position};
  const GreedyResult rest = choose_greedily(site, evaluator, config, {});
  ASSERT_EQ(rest.stations.size(), 2u);
  EXPECT_EQ(rest.stations[0].position, alone.stations[2].position);
  EXPECT_EQ(rest.stations[1].position, alone.stations[3].position);
  EXPECT_NEAR(rest.coverage[1], alone.coverage[3], 1e-12);
}

TEST(Greedy, StopsWhenTold) {
  const PlacementOracle site = test::toy_site();
  test::ToyEvaluator evaluator;
  std::stop_source stop;
  evaluator.before_each = [&](const PlacedNetwork&) {
    if (evaluator.evaluated == 60) stop.request_stop();
  };
  const GreedyResult result =
      choose_greedily(site, evaluator, {.stations = 6, .candidates = 50}, {.report = {}, .stop = stop.get_token()});
  EXPECT_TRUE(result.cancelled);
  EXPECT_GT(result.stations.size(), 0u);
  EXPECT_LT(result.stations.size(), 6u);
}

TEST(Greedy, SeedsTheSearch) {
  const PlacementOracle site = test::toy_site();
  test::ToyEvaluator evaluator;
  const GreedyResult greedy = choose_greedily(site, evaluator, {.stations = 8, .candidates = 200}, {});
  const SurveyProblem problem = test::toy_problem("coverage-min");
  PlanConfig config = test::toy_config();
  config.iterations = 1;
  for (const PlacedStation& s : greedy.stations) config.start.push_back(s.position);
  const SearchOutcome seeded = test::toy_search(problem, config, evaluator);
  config.start.clear();
  const SearchOutcome random = test::toy_search(problem, config, evaluator);
  EXPECT_GT(seeded.hypervolume, random.hypervolume);
}

TEST(Greedy, ASeededSearchIsNoWorseThanItsSeed) {
  const PlacementOracle site = test::toy_site();
  test::ToyEvaluator evaluator;
  const GreedyResult greedy = choose_greedily(site, evaluator, {.stations = 4, .candidates = 300}, {});
  PlanConfig config = test::toy_config();
  config.iterations = 1;
  config.sigma0 = 1;  // far from the seed
  for (const PlacedStation& s : greedy.stations) config.start.push_back(s.position);
  const SearchOutcome seeded = test::toy_search(test::toy_problem("coverage-fix"), config, evaluator);
  EXPECT_GE(seeded.hypervolume, greedy.coverage.back() - 1e-9);
  config.start.clear();
  const SearchOutcome random = test::toy_search(test::toy_problem("coverage-fix"), config, evaluator);
  EXPECT_LT(random.hypervolume, greedy.coverage.back() - 1e-3) << "or the seed would not tell";
}

}  // namespace
}  // namespace vantage
