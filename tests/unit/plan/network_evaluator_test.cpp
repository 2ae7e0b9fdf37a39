// SPDX-License-Identifier: Apache-2.0
#include "search/network_evaluator.hpp"

#include <gtest/gtest.h>

#include "unit/plan/toy_survey.hpp"

namespace vantage {
namespace {

PlacedStation at(double x, double y, double z, StationStatus status = StationStatus::ok) {
  return {.uv = {x / 10, y / 10}, .position = {x, y, z}, .status = status};
}

TEST(CachingEvaluator, SimulatesEachNetworkOnce) {
  test::ToyEvaluator evaluator;
  evaluator.at_once = 0;
  CachingEvaluator caching(evaluator);
  const PlacedNetwork a{at(1, 2, 3), at(4, 5, 6)}, b{at(4, 5, 6), at(1, 2, 3)};
  const std::vector<PlacedNetwork> networks{a, b, a, a};
  const auto values = caching.evaluate(networks, {}, {});
  ASSERT_TRUE(values);
  ASSERT_EQ(values->size(), 4u);
  EXPECT_EQ(evaluator.evaluated, 2u);  // another order is another network: a station's place keys its noise
  EXPECT_EQ((*values)[0][0], test::ToyEvaluator::coverage_of(a));
  EXPECT_EQ((*values)[2][1], test::ToyEvaluator::overlap_of(a));
  caching.evaluate(networks, {}, {});
  EXPECT_EQ(evaluator.evaluated, 2u);
  EXPECT_EQ(caching.simulated(), 2u);
}

TEST(CachingEvaluator, TellsNetworksApartByAllThatAnObjectiveMaySee) {
  test::ToyEvaluator evaluator;
  CachingEvaluator caching(evaluator);
  const PlacedNetwork one{at(1, 2, 3)}, clash{at(1, 2, 3), at(9, 9, 9, StationStatus::clash)},
      hole{at(1, 2, 3), at(9, 9, 9, StationStatus::hole)}, elsewhere{at(1, 2, 3), at(8, 9, 9, StationStatus::clash)};
  const std::vector<PlacedNetwork> networks{one, clash, hole, elsewhere};
  caching.evaluate(networks, {}, {});
  EXPECT_EQ(evaluator.evaluated, 4u);
}

TEST(CachingEvaluator, RemembersNothingOfAStoppedBatch) {
  test::ToyEvaluator evaluator;
  CachingEvaluator caching(evaluator);
  std::stop_source stop;
  stop.request_stop();
  const std::vector<PlacedNetwork> networks{{at(1, 2, 3)}};
  EXPECT_FALSE(caching.evaluate(networks, {}, {.stop = stop.get_token()}));
  EXPECT_TRUE(caching.evaluate(networks, {}, {}));
  EXPECT_EQ(evaluator.evaluated, 1u);
}

}  // namespace
}  // namespace vantage
