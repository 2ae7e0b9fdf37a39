// SPDX-License-Identifier: Apache-2.0
#include "plan/fewest_verify.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "core/graph.hpp"
#include "unit/plan/floor_survey.hpp"

namespace vantage {
namespace {

// A choice on the floor, and an evaluator that knows better.
class FewestVerify : public testing::Test {
 protected:
  explicit FewestVerify(double coverage = 0.7) : problem(test::floor_problem(coverage)) {
    const auto candidates = test::floor_candidates(10);
    look(choice.table, {}, candidates, test::floor_columns()(candidates, {}), {}, {});
    choose(choice, {}, {});
  }
  VerifiedNetworks networks() { return {problem, measures, oracle, evaluator, 100, watch}; }

  SurveyProblem problem;
  Measures measures = measures_of(problem);
  PlacementOracle oracle = test::toy_site();
  test::FloorEvaluator evaluator{measures};
  PlanWatch watch;
  FewestChoice choice = test::floor_choice(problem);
};

TEST_F(FewestVerify, SaysByHowMuchTheSampleOverstates) {
  evaluator.overstated = 0.03;
  VerifiedNetworks verified = networks();
  EXPECT_NEAR(verify(choice, verified), 0.03, 1e-12);
  ASSERT_EQ(verified.entries().size(), 1u);
  EXPECT_TRUE(verified.entries()[0].exact);
  EXPECT_EQ(verified.entries()[0].violation, 0);
  EXPECT_NEAR(verified.entries()[0].value("coverage"), choice.network.coverage, 1e-12);
  EXPECT_EQ(verified.best(), &verified.entries()[0]);
}

TEST_F(FewestVerify, FallsBackToTheMarginWhereItIsAborted) {
  std::stop_source abort;
  abort.request_stop();
  watch.abort = abort.get_token();
  choice.margins.coverage = 0.05;
  VerifiedNetworks verified = networks();
  EXPECT_EQ(verify(choice, verified), 0.05);
  EXPECT_EQ(verified.best(), nullptr);
  EXPECT_FALSE(repair(choice, verified, oracle, {}));
}

TEST_F(FewestVerify, RepairsWhatEveryRayShowsToBeShort) {
  evaluator.penalty = [](const PlacedNetwork&) { return 0.04; };
  VerifiedNetworks verified = networks();
  verify(choice, verified);
  ASSERT_GT(verified.best()->violation, 0);
  const double short_of = 0.7 - (choice.network.coverage - 0.04);
  ASSERT_TRUE(repair(choice, verified, oracle, {}));
  EXPECT_NEAR(choice.margins.coverage, 1.25 * short_of, 1e-9);
  EXPECT_EQ(choice.network.violation, 0);
  EXPECT_GE(choice.network.coverage, 0.7 + 1.25 * short_of);
  // The sample keeps overestimating, so that it may take more than one step.
  for (int k = 0; k < 10 && verified.best()->violation > 0; ++k) {
    verify(choice, verified);
    repair(choice, verified, oracle, {});
  }
  EXPECT_EQ(verified.best()->violation, 0);
  EXPECT_FALSE(repair(choice, verified, oracle, {})) << "nothing is short";
}

// Every ray shows the weakest links of the chosen stations to be too weak, and all others as the sample does.
TEST_F(FewestVerify, MendsLinksThatEveryRayShowsToBeTooWeak) {
  const auto weakest = static_cast<float>(choice.network.link);
  const auto chosen = choice.network.chosen;
  const auto is_chosen = [&, stations = choice.placed_of(choice.network)](const PlacedStation& one) {
    return std::ranges::any_of(
        stations, [&](const PlacedStation& other) { return test::apart_m(one.position, other.position) < 1e-6; });
  };
  evaluator.exact_overlap = [&](const PlacedStation& a, const PlacedStation& b, float sampled) {
    return sampled <= weakest && is_chosen(a) && is_chosen(b) ? 0.05F : sampled;
  };
  VerifiedNetworks verified = networks();
  verify(choice, verified);
  ASSERT_GT(verified.best()->violation, 0);
  const StationGraph before = choice.table.graph();
  ASSERT_TRUE(repair(choice, verified, oracle, {}));
  int taken_in = 0;
  for (const std::size_t i : chosen)
    for (const std::size_t j : chosen) {
      if (i >= j) continue;
      const bool weak = before.overlap(i, j) <= weakest;
      EXPECT_EQ(choice.table.graph().overlap(i, j), weak ? 0.05F : before.overlap(i, j)) << i << ' ' << j;
      taken_in += weak;
    }
  EXPECT_GT(taken_in, 0);
  EXPECT_EQ(choice.network.violation, 0);
  EXPECT_EQ(choice.network.chosen.size(), chosen.size()) << "no station more";
  verify(choice, verified);
  EXPECT_EQ(verified.best()->violation, 0);
  EXPECT_FALSE(repair(choice, verified, oracle, {})) << "nothing is short";
}

// Every ray shows all links between the candidates to be too weak. Only positions between them link stations.
TEST_F(FewestVerify, LooksBetweenStationsThatNoCandidateLinks) {
  const auto candidates = test::floor_candidates(3);
  const auto is_candidate = [&](const PlacedStation& one) {
    return std::ranges::any_of(
        candidates, [&](const PlacedStation& other) { return test::apart_m(one.position, other.position) < 1e-6; });
  };
  choice = test::floor_choice(problem);
  look(choice.table, {}, candidates, test::floor_columns()(candidates, {}), {}, {});
  choose(choice, {}, {});
  ASSERT_EQ(choice.network.violation, 0);
  evaluator.exact_overlap = [&](const PlacedStation& a, const PlacedStation& b, float sampled) {
    return is_candidate(a) && is_candidate(b) ? 0.05F : sampled;
  };
  VerifiedNetworks verified = networks();
  verify(choice, verified);
  ASSERT_GT(verified.best()->violation, 0);
  for (int k = 0; k < 6 && verified.best()->violation > 0 && repair(choice, verified, oracle, {}); ++k)
    verify(choice, verified);
  EXPECT_EQ(verified.best()->violation, 0);
  EXPECT_GT(std::ranges::count_if(verified.best()->stations, std::not_fn(is_candidate)), 0);
}

// Another sample shows the weakest links of the chosen stations to be too weak, and all others as the first one does.
TEST_F(FewestVerify, ChecksLinksByAnotherSampleUntilTheyHold) {
  const auto weakest = static_cast<float>(choice.network.link);
  const std::vector<PlacedStation> chosen = choice.placed_of(choice.network);
  const StationGraph flattered = choice.table.graph();
  const auto index_of = [&](const PlacedStation& one) {
    const auto& all = choice.table.stations();
    return static_cast<std::size_t>(
        std::ranges::min_element(all, {}, [&](const auto& s) { return test::apart_m(s.position, one.position); }) -
        all.begin());
  };
  const auto is_chosen = [&](const PlacedStation& one) {
    return std::ranges::any_of(
        chosen, [&](const PlacedStation& other) { return test::apart_m(one.position, other.position) < 1e-6; });
  };
  std::vector<std::size_t> measured;
  const LeastOverlaps least = [&](std::span<const PlacedStation> stations) {
    measured.push_back(stations.size());
    ScanOverlapMatrix overlap(stations.size());
    for (std::size_t i = 0; i < stations.size(); ++i)
      for (std::size_t j = i + 1; j < stations.size(); ++j) {
        const float sampled = flattered.overlap(index_of(stations[i]), index_of(stations[j]));
        const bool weak = sampled <= weakest && is_chosen(stations[i]) && is_chosen(stations[j]);
        overlap.set(i, j, weak ? 0.05 : static_cast<double>(sampled));
      }
    return std::optional(overlap);
  };
  check_links(choice, oracle, least, {});
  EXPECT_GE(measured.size(), 2u) << "the first choice does not hold";
  EXPECT_EQ(choice.network.violation, 0);
  EXPECT_EQ(choice.placed(), chosen.size()) << "no station more";
  const auto& now = choice.network.chosen;
  const Components parts = components(now.size(), [&](std::size_t i, std::size_t j) {
    return choice.table.is_known(now[i], now[j]) &&
           static_cast<double>(choice.table.graph().overlap(now[i], now[j])) >= choice.asked.link;
  });
  EXPECT_EQ(parts.count, 1u) << "links that were checked hold all stations together";
  const std::size_t calls = measured.size();
  check_links(choice, oracle, least, {});
  EXPECT_EQ(measured.size(), calls) << "nothing is left to measure";
}

TEST_F(FewestVerify, KeepsTheChoiceWhereTheCheckIsStopped) {
  const auto chosen = choice.network.chosen;
  check_links(choice, oracle, [](std::span<const PlacedStation>) { return std::nullopt; }, {});
  EXPECT_EQ(choice.network.chosen, chosen);
}

TEST_F(FewestVerify, LeavesAloneWhatEveryRayShowsAsItWasKnown) {
  choice.asked.coverage = 1;
  choice.asked.most = 3;
  choose(choice, {}, {});
  ASSERT_GT(choice.network.violation, 0);
  VerifiedNetworks verified = networks();
  verify(choice, verified);
  const auto chosen = choice.network.chosen;
  EXPECT_FALSE(repair(choice, verified, oracle, {}));
  EXPECT_EQ(choice.network.chosen, chosen);
}

TEST_F(FewestVerify, TakesAStationFewerWhereTheSampleIsKnownToBeRight) {
  // The choice has a margin of a tenth, which makes it a station too many.
  const std::size_t enough = choice.placed();
  choice.margins.coverage = 0.1;
  choose(choice, {}, {});
  const std::size_t chosen = choice.placed();
  ASSERT_GT(chosen, enough);
  VerifiedNetworks verified = networks();
  double overstated = verify(choice, verified);
  ASSERT_TRUE(choose_by_known_error(choice, verified, overstated, {}));
  EXPECT_LT(choice.placed(), chosen);
  EXPECT_NEAR(choice.margins.coverage, 0, 1e-12);
  const auto front = verified.front();
  ASSERT_EQ(front.size(), 1u);
  EXPECT_EQ(front[0].stations.size(), choice.placed());
  EXPECT_FALSE(choose_by_known_error(choice, verified, overstated, {})) << "no margin is left";
}

TEST_F(FewestVerify, KeepsTheChoiceWhereAStationFewerDoesNotDo) {
  const std::size_t enough = choice.placed();
  choice.margins.coverage = 0.1;
  choose(choice, {}, {});
  // Every ray finds nothing wrong with this network, and much with smaller ones.
  const std::size_t chosen = choice.placed();
  evaluator.penalty = [=](const PlacedNetwork& network) { return network.size() < chosen ? 0.3 : 0.0; };
  VerifiedNetworks verified = networks();
  double overstated = verify(choice, verified);
  const double before = overstated;
  const auto network = choice.network.chosen;
  ASSERT_TRUE(choice.one_fewer);
  EXPECT_FALSE(choose_by_known_error(choice, verified, overstated, {}));
  EXPECT_EQ(verified.entries().size(), 2u) << "it was tried";
  EXPECT_EQ(choice.network.chosen, network);
  EXPECT_EQ(choice.margins.coverage, 0.1);
  EXPECT_EQ(overstated, before);
  const auto front = verified.front();
  ASSERT_EQ(front.size(), 1u);
  EXPECT_EQ(front[0].stations.size(), chosen);
  EXPECT_GT(chosen, enough);
}

TEST_F(FewestVerify, FrontIsOfFewestStationsThatDo) {
  VerifiedNetworks verified = networks();
  const auto placed = choice.placed_of(choice.network);
  verified.add(std::span(placed).first(placed.size() - 1));  // does not do
  verified.add(placed);
  auto more = placed;
  more.push_back(choice.table.stations().front());
  verified.add(more);
  ASSERT_EQ(verified.entries().size(), 3u);
  const auto front = verified.front();
  ASSERT_EQ(front.size(), 1u);
  EXPECT_EQ(front[0].stations.size(), placed.size());
}

TEST_F(FewestVerify, ATiePastTheStairIsAMissingLink) {
  const auto placed = choice.placed_of(choice.network);
  auto more = placed;
  more.push_back(choice.table.stations().front());
  VerifiedNetworks verified(problem, measures, oracle, evaluator, 100, watch, {},
                            [&](const Evaluation& one) { return one.stations.size() == placed.size() ? 2u : 0u; });
  verify(choice, verified);
  EXPECT_NEAR(verified.best()->violation, 2 * 0.2, 1e-12);
  EXPECT_EQ(verified.ties_past_stairs(*verified.best()), 2u);
  verified.add(more);
  EXPECT_EQ(verified.best()->violation, 0);
  const auto front = verified.front();
  ASSERT_EQ(front.size(), 1u);
  EXPECT_EQ(front[0].stations.size(), more.size()) << "a station more that ties nothing past the stair";
}

// The toy floor is flat, and one half of it is a storey higher here. Every ray shows all links between the halves to be
// past the stair but those within a strip.
TEST_F(FewestVerify, KeepsToStairsWhereOnlyEveryRayShowsTies) {
  std::vector<PlacedStation> raised = test::floor_candidates(10);
  for (PlacedStation& one : raised)
    if (one.position.y > 5) one.ground.z += 3, one.position.z += 3;
  oracle.locate = [flat = oracle.locate](Uv uv) {
    std::optional<Vec3> ground = flat(uv);
    if (ground && ground->y > 5) ground->z += 3;
    return ground;
  };
  choice = test::floor_choice(problem);
  look(choice.table, {}, raised, test::floor_columns()(raised, {}), {}, {});
  choose(choice, {}, {});
  const auto in_strip = [](const PlacedStation& one) { return one.position.x > 8; };
  const PastStairs past = [&](std::span<const PlacedStation> some,
                              std::span<const std::pair<std::size_t, std::size_t>> pairs) {
    std::vector<std::uint8_t> found;
    for (const auto& [a, b] : pairs)
      found.push_back((some[a].position.y > 5) != (some[b].position.y > 5) &&
                      !(in_strip(some[a]) && in_strip(some[b])));
    return found;
  };
  // Components by the links of every ray that a person walks along.
  const auto parts_on_foot = [&](const Evaluation& entry) {
    return components(entry.stations.size(),
                      [&](std::size_t a, std::size_t b) {
                        const PlacedStation &one = entry.stations[a], &other = entry.stations[b];
                        const bool same = (one.position.y > 5) == (other.position.y > 5);
                        return entry.scan_overlap_matrix(a, b) >= 0.1 && (same || (in_strip(one) && in_strip(other)));
                      })
        .count;
  };
  std::optional<VerifiedNetworks> verified;
  verified.emplace(
      problem, measures, oracle, evaluator, 100, watch, VerifiedNetworks::VisitOrder(),
      [&](const Evaluation& one) -> std::size_t { return choice.past_stairs ? parts_on_foot(one) - 1 : 0; });
  verify(choice, *verified);
  ASSERT_EQ(verified->best()->violation, 0);
  ASSERT_GT(parts_on_foot(*verified->best()), 1u) << "the plain choice ties the halves elsewhere";
  EXPECT_FALSE(keep_to_stairs(choice, *verified, {})) << "nothing is known of stairs";
  choice.past_stairs = past;
  ASSERT_TRUE(keep_to_stairs(choice, *verified, {}));
  EXPECT_GT(verified->best()->violation, 0) << "it is judged by its ties now";
  EXPECT_FALSE(keep_to_stairs(choice, *verified, {})) << "it was done";
  verify(choice, *verified);
  EXPECT_EQ(verified->best()->violation, 0);
  EXPECT_EQ(parts_on_foot(*verified->best()), 1u);
}

}  // namespace
}  // namespace vantage
