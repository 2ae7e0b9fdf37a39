// SPDX-License-Identifier: Apache-2.0
#include "plan/trade_off.hpp"

#include <gtest/gtest.h>

#include "plan/what_pays.hpp"
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

// A corridor: cells of a metre, of which those from 0 to 10 and the last two are surveyed; a station captures those
// within 2 m, and is linked to others within 3 m.
struct Corridor {
  static constexpr std::size_t kLength = 40;
  static CoverageMatrix columns(std::span<const PlacedStation> stations, double reach_m, bool surveyed) {
    std::vector<std::uint32_t> weights(kLength, 1);
    if (surveyed) std::fill(weights.begin() + 10, weights.end() - 2, 0);
    CoverageMatrix matrix(std::move(weights), 1);
    for (const PlacedStation& station : stations) {
      std::vector<std::uint32_t> amounts(kLength);
      for (std::size_t e = 0; e < kLength; ++e)
        amounts[e] = std::abs(static_cast<double>(e) + 0.5 - station.position.x) < reach_m;
      matrix.add(std::span<const std::uint32_t>(amounts));
    }
    return matrix;
  }
  static FewestChoice choice(double coverage) {
    FewestChoice made{
        .asked = fewest_asked(test::floor_problem(coverage)),
        .table = CandidateTable([](std::span<const PlacedStation> s, const Progress&) { return columns(s, 2, true); },
                                [](std::span<const PlacedStation> s, const Progress&) { return columns(s, 3, false); },
                                {.nearest_m = 0.1})};
    made.asked.link = 0.3, made.asked.most = 20;
    std::vector<PlacedStation> all;
    for (std::size_t k = 0; k < kLength; ++k)
      all.push_back({.position = {static_cast<double>(k) + 0.5, 0, 0}, .status = StationStatus::ok});
    made.table.add(all, {});
    choose(made, {}, {});
    return made;
  }
};

TEST(KeepWhatPays, LeavesAFarCorner) {
  // Without links four stations capture all: three at this end and one at the other.
  const UnitsToVisit square_metres{.units = {}, .least_m2 = 0, .element_m2 = 1};
  FewestChoice choice = Corridor::choice(1);
  choice.to_visit = &square_metres;
  ASSERT_EQ(choice.network.violation, 0);
  ASSERT_GT(choice.placed(), 8u) << "a chain of links to the other end";
  const std::size_t all = choice.placed();
  EXPECT_TRUE(keep_what_pays(choice, {.least_m2 = 1, .stations = 3}, 0, {}));
  EXPECT_LE(choice.placed(), 5u);
  EXPECT_EQ(choice.network.violation, 0);
  EXPECT_GE(choice.network.link, 0.3);
  EXPECT_NEAR(choice.asked.coverage, choice.table.matrix().coverage(choice.network.chosen), 1e-12);
  EXPECT_NEAR(choice.asked.coverage, 10.0 / 12, 1e-12) << "nothing but the far corner is left out";

  FewestChoice worth_it = Corridor::choice(1);
  worth_it.to_visit = &square_metres;
  EXPECT_FALSE(keep_what_pays(worth_it, {.least_m2 = 0.1, .stations = 3}, 0, {}));
  EXPECT_EQ(worth_it.placed(), all);
  EXPECT_EQ(worth_it.asked.coverage, 1);

  FewestChoice within = Corridor::choice(1);
  within.to_visit = &square_metres;
  EXPECT_FALSE(keep_what_pays(within, {.least_m2 = 1, .stations = all}, 0, {})) << "no more than pay by themselves";
  EXPECT_EQ(within.placed(), all);
}

TEST(AddWhatPays, EndsWhereALinkedStationAddsLess) {
  const UnitsToVisit cells{.units = {}, .least_m2 = 0, .element_m2 = 1.0 / 16};  // of the floor
  FewestChoice choice = test::floor_choice(test::floor_problem(0.4));
  const auto candidates = test::floor_candidates(16);
  look(choice.table, {}, candidates, test::floor_columns()(candidates, {}), {}, {});
  choose(choice, {}, {});
  choice.to_visit = &cells;
  const std::size_t before = choice.placed();
  EXPECT_FALSE(add_what_pays(choice, {.least_m2 = 1e3}, {}));
  EXPECT_EQ(choice.placed(), before);
  EXPECT_TRUE(add_what_pays(choice, {.least_m2 = 5}, {}));
  EXPECT_GT(choice.placed(), before);
  EXPECT_EQ(choice.network.violation, 0) << "what is added is linked";
  EXPECT_GE(choice.network.link, 0.1);
  EXPECT_NEAR(choice.asked.coverage, choice.network.coverage, 1e-12);
  const auto further_m2 = [&](const std::vector<std::size_t>& network) {
    CoverProblem problem = cover_problem(choice);
    problem.existing = network;
    return further_stations(problem, 1, cells.element_m2).each_m2;
  };
  EXPECT_LT(further_m2(choice.network.chosen), 5);
  const auto last = choice.network.chosen.end() - 1;
  EXPECT_GE(further_m2({choice.network.chosen.begin(), last}), 5) << "the last one paid";
  choice.asked.most = choice.placed();
  EXPECT_FALSE(add_what_pays(choice, {.least_m2 = 0}, {})) << "as many as are allowed";
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
