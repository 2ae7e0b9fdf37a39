// SPDX-License-Identifier: Apache-2.0
#include "plan/network_evaluator.hpp"

#include <gtest/gtest.h>

#include "unit/plan/toy_survey.hpp"

namespace vantage {
namespace {

TEST(CachingEvaluator, SimulatesEachNetworkOnce) {
  test::ToyEvaluator evaluator;
  evaluator.at_once = 0;
  CachingEvaluator caching(evaluator);
  const Network a{{{1, 2, 3}, true}, {{4, 5, 6}, true}}, b{{{4, 5, 6}, true}, {{1, 2, 3}, true}};
  const std::vector<Network> networks{a, b, a, a};
  const auto values = caching.evaluate(networks, {});
  ASSERT_TRUE(values);
  ASSERT_EQ(values->size(), 4u);
  EXPECT_EQ(evaluator.evaluated, 2u);  // another order is another network: a station's place keys its noise
  EXPECT_EQ((*values)[0].coverage, test::ToyEvaluator::value_of(a).coverage);
  EXPECT_EQ((*values)[2].overlap, test::ToyEvaluator::value_of(a).overlap);
  caching.evaluate(networks, {});
  EXPECT_EQ(evaluator.evaluated, 2u);
  EXPECT_EQ(caching.simulated(), 2u);
}

TEST(CachingEvaluator, TellsNetworksApartByTheirSkippedStations) {
  test::ToyEvaluator evaluator;
  CachingEvaluator caching(evaluator);
  const Network two{{{1, 2, 3}, true}}, three{{{1, 2, 3}, true}, {{}, false}},
      moved{{{1, 2, 3}, true}, {{9, 9, 9}, false}};
  const std::vector<Network> networks{two, three, moved};
  caching.evaluate(networks, {});
  EXPECT_EQ(evaluator.evaluated, 2u);  // where a skipped station would stand does not matter, that there is one does
}

TEST(CachingEvaluator, NeedsNoSimulationWhereNoStationStands) {
  test::ToyEvaluator evaluator;
  CachingEvaluator caching(evaluator);
  const std::vector<Network> networks{{{{1, 2, 3}, false}, {{}, false}}};
  const auto values = caching.evaluate(networks, {});
  ASSERT_TRUE(values);
  EXPECT_EQ(evaluator.evaluated, 0u);
  EXPECT_EQ((*values)[0].coverage, 0);
  EXPECT_EQ((*values)[0].overlap, 0);
}

TEST(CachingEvaluator, RemembersNothingOfAStoppedBatch) {
  test::ToyEvaluator evaluator;
  CachingEvaluator caching(evaluator);
  std::stop_source stop;
  stop.request_stop();
  const std::vector<Network> networks{{{{1, 2, 3}, true}}};
  EXPECT_FALSE(caching.evaluate(networks, {.report = {}, .stop = stop.get_token()}));
  EXPECT_TRUE(caching.evaluate(networks, {}));
  EXPECT_EQ(evaluator.evaluated, 1u);
}

}  // namespace
}  // namespace vantage
