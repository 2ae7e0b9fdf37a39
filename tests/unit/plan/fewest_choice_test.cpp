// SPDX-License-Identifier: Apache-2.0
#include "plan/fewest_choice.hpp"

#include <gtest/gtest.h>

#include <random>

#include "unit/plan/floor_survey.hpp"

namespace vantage {
namespace {

using test::floor_candidates;
using test::floor_choice;
using test::floor_columns;
using test::floor_problem;

// A choice among the lattice's candidates.
FewestChoice chosen(const SurveyProblem& problem, int side, std::size_t step = 1) {
  FewestChoice choice = floor_choice(problem, step);
  const auto candidates = floor_candidates(side);
  look(choice.table, {}, candidates, floor_columns(step)(candidates, {}), {}, {});
  choose(choice, {}, {});
  return choice;
}

TEST(FewestAsked, TakesTheStrictestLimits) {
  SurveyProblem problem = fewest_stations(0.8, 0.25, 2, 9, 1.5);
  problem.attainable = 0.5;
  for (Requirement& requirement : problem.requirements)
    if (requirement.objective.name == "capture") requirement.objective = make_objective("capture", problem.settings());
  problem.existing = {{1, 1, 4.5}};
  FewestAsked asked = fewest_asked(problem);
  EXPECT_EQ(asked.existing, 1u);
  EXPECT_EQ(asked.fewest, 2u);
  EXPECT_EQ(asked.most, 9u);
  EXPECT_TRUE(asked.captured);
  EXPECT_DOUBLE_EQ(asked.coverage, 0.8) << "of what is attainable";
  EXPECT_EQ(asked.link, 0.25);
  EXPECT_EQ(asked.apart_m, 1.5);
  EXPECT_FALSE(asked.minutes);
  problem.requirements.push_back({.objective = make_objective("coverage", problem.settings()), .limit = 0.45});
  problem.requirements.push_back(
      {.objective = make_objective("time", problem.settings()), .bound = Requirement::Bound::at_most, .limit = 90});
  asked = fewest_asked(problem);
  EXPECT_EQ(asked.coverage, 0.9) << "a coverage of 0.45, of 0.5 that are attainable";
  EXPECT_EQ(asked.minutes, 90);
  std::erase_if(problem.requirements, [](const Requirement& r) { return r.objective.name == "capture"; });
  asked = fewest_asked(problem);
  EXPECT_FALSE(asked.captured);
  EXPECT_EQ(asked.coverage, 0.45);
}

TEST(Look, TakesExistingStationsFirstAndSomeCandidatesWhereTimeIsOver) {
  const auto candidates = floor_candidates(16);
  ASSERT_GT(candidates.size(), 150u);
  const CoverageMatrix known = floor_columns()(candidates, {});
  const PlacedStation existing = candidates.back();
  const auto looked_at = [&](std::stop_token stop, std::stop_token abort) {
    FewestChoice choice = floor_choice(floor_problem(0.5));
    look(choice.table, {&existing, 1}, candidates, known, {.report = {}, .stop = std::move(stop)}, abort);
    return choice.table;
  };
  std::stop_source stop, abort;
  const CandidateTable all = looked_at({}, {});
  EXPECT_EQ(all.stations().size(), candidates.size() + 1);
  EXPECT_EQ(all.stations().front().position, existing.position);
  EXPECT_GT(all.graph().overlap(1, 2), 0);
  stop.request_stop();
  EXPECT_GE(looked_at(stop.get_token(), {}).stations().size(), 97u) << "as many as two seconds allow, but some";
  abort.request_stop();
  EXPECT_EQ(looked_at(stop.get_token(), abort.get_token()).stations().size(), 0u);
}

// A share of so much, of which samples show more or less: the bound is above it in a share of the samples that the
// normal distribution gives for as many standard errors.
TEST(LeastShare, IsRarelyAboveTheTruth) {
  std::mt19937 rng(3);
  for (const int size : {20, 100, 1000}) {
    int above = 0;
    constexpr int kSamples = 20'000;
    std::binomial_distribution<int> drawn(size, 0.3);
    for (int k = 0; k < kSamples; ++k) above += least_share(static_cast<double>(drawn(rng)) / size, size, 2) > 0.3;
    EXPECT_LT(above, 0.035 * kSamples) << size;
    EXPECT_GT(above, 0.008 * kSamples) << size;
  }
  EXPECT_EQ(least_share(0, 10, 2), 0);
  EXPECT_DOUBLE_EQ(least_share(0.4, 10, 0), 0.4) << "all was counted";
  EXPECT_NEAR(least_share(1, 12, 2), 0.75, 1e-12) << "few voxels prove little, even if all agree";
}

TEST(CandidateTable, TakesOverlapsForTheLeastThatTheirSampleAdmits) {
  const auto candidates = floor_candidates(6);
  CandidateTable plain(floor_columns(), floor_columns(7, 4), {}),
      careful(floor_columns(), floor_columns(7, 4), {}, 0.25);
  const std::size_t half = candidates.size() / 2;
  for (CandidateTable* table : {&plain, &careful}) {
    table->add(std::span(candidates).first(half), {});
    if (table == &careful) careful.take_least_overlaps(1);
    table->add(std::span(candidates).subspan(half), {});
  }
  ScanOverlapMatrix exact(3);
  exact.set(0, 1, 0.25), exact.set(0, 2, 0), exact.set(1, 2, 0.75);
  const std::vector<std::size_t> chosen{4, 2, 7};
  careful.take_in(chosen, exact);
  careful.take_least_overlaps(2);
  EXPECT_EQ(careful.graph().overlap(4, 2), 0.25F);
  EXPECT_EQ(careful.graph().overlap(4, 7), 0);
  EXPECT_EQ(careful.graph().overlap(7, 2), 0.75F);
  const CoverageMatrix seen = floor_columns(7, 4)(candidates, {});
  int linked = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    for (std::size_t j = 0; j < candidates.size(); ++j) {
      if (i == j || plain.graph().overlap(i, j) == 0) continue;
      if (std::ranges::count(chosen, i) + std::ranges::count(chosen, j) == 2) continue;
      ++linked;
      const auto share = static_cast<double>(plain.graph().overlap(i, j));
      const auto size = static_cast<double>(std::min(seen.column(i).size(), seen.column(j).size()));
      EXPECT_FLOAT_EQ(careful.graph().overlap(i, j), static_cast<float>(least_share(share, size, 1))) << i << ' ' << j;
      EXPECT_EQ(careful.graph().overlap(i, j), careful.graph().overlap(j, i));
    }
  EXPECT_GT(linked, 100);
}

TEST(Choose, KeepsWhatIsAskedAndNoStationFewerDoes) {
  const FewestChoice choice = chosen(floor_problem(0.7), 12);
  EXPECT_EQ(choice.network.violation, 0);
  EXPECT_GE(choice.network.coverage, 0.7);
  EXPECT_GE(choice.network.link, 0.1);
  ASSERT_TRUE(choice.one_fewer);
  EXPECT_EQ(choice.one_fewer->chosen.size() + 1, choice.placed());
  const auto stations = choice.placed_of(choice.network);
  for (std::size_t i = 0; i < stations.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE(test::apart_m(stations[i].position, stations[j].position), 1);
}

TEST(Choose, TakesAsManyAsThereIsTimeFor) {
  const std::size_t without_limit = chosen(floor_problem(0.8), 12).placed();
  ASSERT_GT(without_limit, 3u);
  FewestChoice choice = floor_choice(floor_problem(0.8));
  choice.asked.minutes = 35;
  const auto candidates = floor_candidates(12);
  look(choice.table, {}, candidates, floor_columns()(candidates, {}), {}, {});
  // 10 minutes a station and 2 for the way to it.
  const VisitTime visit{.each_min = 10, .minutes = [](std::span<const PlacedStation> placed) {
                          return 12 * static_cast<double>(placed.size());
                        }};
  choose(choice, visit, {});
  EXPECT_EQ(choice.placed(), 2u);
  EXPECT_EQ(choice.asked.most, 2u);
  EXPECT_GT(choice.network.violation, 0);
}

TEST(RefineAround, AddsAllowedPositionsNearTheChosen) {
  FewestChoice choice = chosen(floor_problem(0.7), 7);
  const std::size_t before = choice.table.stations().size(), placed = choice.placed();
  std::vector<PlacedStation> from = choice.placed_of(choice.network);
  const auto fewer = choice.placed_of(*choice.one_fewer);
  from.insert(from.end(), fewer.begin(), fewer.end());
  refine_around(choice, test::toy_site(), 0.8, {});
  const auto& stations = choice.table.stations();
  EXPECT_GT(stations.size(), before);
  for (std::size_t k = before; k < stations.size(); ++k) {
    EXPECT_EQ(stations[k].status, StationStatus::ok);
    EXPECT_TRUE(std::ranges::any_of(from, [&](const PlacedStation& one) {
      return test::apart_m(one.position, stations[k].position) <= 0.8 + 1e-9;
    }));
    for (std::size_t other = before; other < k; ++other)
      EXPECT_GT(test::apart_m(stations[other].position, stations[k].position), 0) << "a position is tried once";
  }
  EXPECT_EQ(choice.network.violation, 0);
  EXPECT_LE(choice.placed(), placed);
}

TEST(Choose, TakesTheMostCoverageOfSoManyStations) {
  SurveyProblem problem = floor_problem(0);
  std::erase_if(problem.requirements, [](const Requirement& r) { return r.objective.name == "capture"; });
  problem.stations_min = problem.stations_max = 3;
  const FewestAsked asked = fewest_asked(problem);
  EXPECT_TRUE(asked.most_coverage);
  EXPECT_FALSE(asked.captured) << "coverage is searched for";
  FewestChoice choice = chosen(problem, 10);
  ASSERT_EQ(choice.placed(), 3u);
  EXPECT_GE(choice.network.link, 0.1) << "and linked";
  // No swap of one station among the linked, apart networks of as many has more.
  const CoverProblem asked_of = cover_problem(choice);
  for (std::size_t at = 0; at < 3; ++at)
    for (std::size_t k = 0; k < choice.table.stations().size(); ++k) {
      std::vector<std::size_t> other = choice.network.chosen;
      other[at] = k;
      const CoverSolution swapped = evaluate_cover(asked_of, other);
      const auto near = [&](std::size_t i, std::size_t j) { return choice.table.graph().excluded(i, j) || i == j; };
      if (swapped.link < 0.1 || near(other[0], other[1]) || near(other[0], other[2]) || near(other[1], other[2]))
        continue;
      EXPECT_LE(swapped.coverage, choice.network.coverage + 1e-9);
    }
}

}  // namespace
}  // namespace vantage
