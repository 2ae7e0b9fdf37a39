// SPDX-License-Identifier: Apache-2.0
#include "plan/trade_off.hpp"

#include <gtest/gtest.h>

#include "unit/plan/floor_survey.hpp"

namespace vantage {
namespace {

TEST(TradeOff, NumbersLeadFromOneToBeyondTheChosen) {
  const auto around = [](std::size_t chosen) { return trade_off_numbers(chosen, 1000); };
  EXPECT_EQ(around(1), (std::vector<std::size_t>{1, 2, 3, 4, 5}));
  EXPECT_EQ(around(4), (std::vector<std::size_t>{1, 2, 3, 4, 5, 6, 7, 8}));
  const auto many = around(80);
  EXPECT_EQ(many.front(), 1u);
  EXPECT_EQ(many.back(), 120u);
  EXPECT_EQ(std::ranges::count(many, 80u), 1);
  EXPECT_LE(many.size(), 15u);
  EXPECT_TRUE(std::ranges::is_sorted(many));
  EXPECT_EQ(around(500), (std::vector<std::size_t>{1, 250, 500, 750})) << "hundreds take long";
  EXPECT_EQ(trade_off_numbers(6, 7).back(), 7u) << "no more than there may be";
}

TEST(TradeOff, NetworksAreLinkedAndCaptureMoreTheMoreStationsTheyHave) {
  const SurveyProblem problem = test::floor_problem(0.7);
  FewestChoice choice = test::floor_choice(problem);
  const auto candidates = test::floor_candidates(10);
  look(choice.table, {}, candidates, test::floor_columns()(candidates, {}), {}, {});
  choose(choice, {}, {});
  const auto networks = trade_off_networks(choice, {}, {});
  ASSERT_GE(networks.size(), choice.placed());
  EXPECT_EQ(networks.front().chosen.size(), 1u);
  EXPECT_GT(networks.back().chosen.size(), choice.placed());
  bool chosen_is_there = false;
  for (std::size_t k = 0; k < networks.size(); ++k) {
    EXPECT_GE(networks[k].link, 0.1) << k;
    EXPECT_NEAR(networks[k].coverage, choice.table.matrix().coverage(networks[k].chosen), 1e-12);
    chosen_is_there = chosen_is_there || networks[k].chosen == choice.network.chosen;
    if (k == 0) continue;
    EXPECT_GT(networks[k].chosen.size(), networks[k - 1].chosen.size());
    EXPECT_GE(networks[k].coverage, networks[k - 1].coverage - 1e-12);
  }
  EXPECT_TRUE(chosen_is_there);
  // The smallest is the best single candidate.
  double best = 0;
  for (std::size_t k = 0; k < candidates.size(); ++k)
    best = std::max(best, choice.table.matrix().coverage(std::vector<std::size_t>{k}));
  EXPECT_NEAR(networks.front().coverage, best, 1e-12);
}

TEST(TradeOff, KneeIsFarthestAboveTheLineBetweenTheEnds) {
  std::vector<TradeOffPoint> points;
  const auto add = [&](std::size_t stations, double captured) {
    TradeOffPoint& point = points.emplace_back();
    point.stations.resize(stations);
    point.values["capture"] = {captured, 0};
  };
  add(1, 0.1), add(2, 0.4), add(4, 0.8), add(8, 0.85), add(11, 0.9);
  mark_knee(points);
  for (const TradeOffPoint& point : points) EXPECT_EQ(point.knee, point.stations.size() == 4);
  points.clear();
  add(1, 0.3), add(2, 0.6), add(3, 0.9);
  mark_knee(points);
  EXPECT_TRUE(std::ranges::none_of(points, &TradeOffPoint::knee)) << "a straight line has none";
}

}  // namespace
}  // namespace vantage
