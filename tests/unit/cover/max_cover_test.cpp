// SPDX-License-Identifier: Apache-2.0
// Results against all possible networks, on problems small enough to try them.
#include <gtest/gtest.h>

#include <algorithm>

#include "unit/cover/random_matrix.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

using test::Chosen;
using test::connected_by_definition;
using test::coverage_by_definition;
using test::each_choice;
using test::random_matrix;

double best_of_all(const CoverageMatrix& matrix, std::size_t count, const Chosen& existing = {}) {
  double best = 0;
  each_choice(matrix.candidates(), count, [&](Chosen chosen) {
    chosen.insert(chosen.end(), existing.begin(), existing.end());
    best = std::max(best, coverage_by_definition(matrix, chosen));
  });
  return best;
}

// Candidates that share nothing: the best N are the N largest, and no fraction does better.
TEST(MaxCover, IsTheSumOfTheLargestWhereNothingIsShared) {
  CoverageMatrix matrix(std::vector<std::uint32_t>(100, 1), 10);
  for (std::uint32_t k = 0; k < 10; ++k) {
    std::vector<std::uint32_t> amounts(100);
    for (std::uint32_t e = 0; e <= k; ++e) amounts[10 * k + e] = 25;
    matrix.add(amounts);
  }
  const CoverSolution best = max_cover({.matrix = matrix, .most = 3});
  EXPECT_NEAR(best.bound, 0.27, 1e-9);
  EXPECT_NEAR(best.coverage, 0.27, 1e-12);
  EXPECT_NEAR(best.half_bound, 0.12, 1e-9);  // candidates 0 to 4
  EXPECT_NEAR(best.spacing_term, 0.15, 1e-9);
  EXPECT_NEAR(best.gap(), 0, 1e-9);
  const StationsBound number = min_cover({.matrix = matrix, .coverage = 0.28});
  EXPECT_TRUE(number.possible);
  EXPECT_EQ(number.at_least, 4u);
  EXPECT_EQ(number.chosen.size(), 4u);
  EXPECT_NEAR(number.relaxation, 3 + 1.0 / 7, 1e-3);
  EXPECT_FALSE(min_cover({.matrix = matrix, .coverage = 0.56}).possible);
  EXPECT_TRUE(min_cover({.matrix = matrix, .coverage = 0.55}).possible);
}

TEST(MaxCover, BoundsEveryChoiceAndBranchingFindsTheBest) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const CoverageMatrix matrix = random_matrix(14, 150, seed, 0.15, 2);
    for (const std::size_t count : {2u, 4u}) {
      const double best = best_of_all(matrix, count);
      const CoverProblem problem{.matrix = matrix, .most = count};
      const CoverSolution quick = max_cover(problem);
      EXPECT_GE(quick.bound, best - 1e-9);
      EXPECT_GE(best, quick.coverage - 1e-9);
      EXPECT_EQ(quick.chosen.size(), count);
      EXPECT_NEAR(coverage_by_definition(matrix, quick.chosen), quick.coverage, 1e-12);
      const CoverSolution exact = max_cover(problem, {.tolerance = 1e-6, .exact_seconds = 60});
      EXPECT_NEAR(exact.coverage, best, 1e-9);
      EXPECT_NEAR(exact.bound, best, 1e-5);
      const StationsBound number = min_cover({.matrix = matrix, .coverage = best - 1e-6});
      EXPECT_LE(number.at_least, count);
      EXPECT_GE(number.chosen.size(), count);
    }
    const Chosen existing{3, 5};
    const CoverSolution with = max_cover({.matrix = matrix, .existing = existing, .most = 2}, {.exact_seconds = 60});
    EXPECT_TRUE(std::equal(existing.begin(), existing.end(), with.chosen.begin()));
    EXPECT_NEAR(with.coverage, best_of_all(matrix, 2, existing), 1e-9);
    EXPECT_GE(with.bound, with.coverage - 1e-9);
  }
}

TEST(MaxCover, FindsTheBestConnectedNetwork) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    const CoverageMatrix matrix = random_matrix(12, 150, seed, 0.15, 2);
    const StationGraph graph = test::random_links(12, seed + 100, 0.2);
    for (const Chosen& existing : {Chosen{}, Chosen{3}}) {
      double best = 0;
      each_choice(matrix.candidates(), 4, [&](Chosen chosen) {
        if (!existing.empty() && std::ranges::count(chosen, 3u) > 0) return;
        chosen.insert(chosen.end(), existing.begin(), existing.end());
        if (connected_by_definition(graph, chosen, 1)) best = std::max(best, coverage_by_definition(matrix, chosen));
      });
      ASSERT_GT(best, 0);
      const CoverProblem problem{.matrix = matrix, .graph = &graph, .existing = existing, .most = 4, .link = 1};
      const CoverSolution found = max_cover(problem, {.tolerance = 1e-6, .exact_seconds = 60});
      EXPECT_NEAR(found.coverage, best, 1e-9);
      EXPECT_NEAR(found.bound, best, 2e-5);
      EXPECT_TRUE(connected_by_definition(graph, found.chosen, 1));
      EXPECT_EQ(found.link, 1);
      EXPECT_EQ(found.chosen.size(), 4 + existing.size());
      EXPECT_TRUE(std::equal(existing.begin(), existing.end(), found.chosen.begin()));
      EXPECT_GE(max_cover(problem).bound, best - 1e-9) << "without branch and bound";
      EXPECT_GE(max_cover(problem, {.exact_seconds = 1e-3}).bound, best - 1e-9) << "cut short";
    }
  }
}

// Rooms off a hub: a room's door sees whatever its two candidates see. A relaxation that adds up halves of a station in
// a room and of one in its door has twice as many rooms as there are stations for.
TEST(MaxCover, AddsUpNoHalvesBehindADoor) {
  constexpr std::size_t kRooms = 5, kEach = 40;
  constexpr std::uint32_t kGoal = 2;
  CoverageMatrix matrix(std::vector<std::uint32_t>(kRooms * kEach, 1), kGoal);
  std::vector<std::uint32_t> amounts(kRooms * kEach, 0);
  matrix.add(amounts);  // the hub
  StationGraph graph(1 + 3 * kRooms);
  for (std::size_t room = 0; room < kRooms; ++room)
    for (std::size_t k = 0; k < 3; ++k) {
      std::ranges::fill(amounts, 0u);
      // In its room the door captures a half of 16, and each of the others all of its own 20 and a half of the rest.
      for (std::size_t e = 0; e < kEach; ++e)
        amounts[room * kEach + e] = k == 0 ? (e < 16 ? kGoal / 2 : 0) : ((e < 20) == (k == 1) ? kGoal : kGoal / 2);
      matrix.add(amounts);
      const std::size_t at = 1 + 3 * room + k;
      graph.set_overlap(k == 0 ? 0 : at - k, at, 1);
    }
  double best = 0;
  each_choice(matrix.candidates(), 5, [&](const Chosen& chosen) {
    if (connected_by_definition(graph, chosen, 1)) best = std::max(best, coverage_by_definition(matrix, chosen));
  });
  const CoverProblem problem{.matrix = matrix, .graph = &graph, .most = 5, .link = 1};
  const CoverSolution found = max_cover(problem, {.tolerance = 1e-6, .exact_seconds = 60});
  EXPECT_NEAR(found.coverage, best, 1e-9);
  EXPECT_NEAR(found.bound, best, 2e-5);
  EXPECT_GT(max_cover(problem).bound, 1.3 * best) << "without links the bound is far";
}

TEST(MaxCover, TakesNoTwoThatExcludeEachOther) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    const CoverageMatrix matrix = random_matrix(12, 150, seed, 0.15, 2);
    StationGraph graph = test::random_links(12, seed + 200, 0.5);
    RandomStream random(seed + 300);
    for (std::size_t a = 0; a < 12; ++a)
      for (std::size_t b = a + 1; b < 12; ++b)
        if (random.uniform() < 0.4) graph.exclude(a, b);
    const auto stands = [&](const Chosen& chosen) {
      return std::ranges::none_of(chosen, [&](std::size_t a) {
        return std::ranges::any_of(chosen, [&](std::size_t b) { return graph.excluded(a, b); });
      });
    };
    const BoundConfig config{.tolerance = 1e-6, .exact_seconds = 60};
    for (const Chosen& existing : {Chosen{}, Chosen{3}}) {
      double best = 0, best_linked = 0;
      for (const std::size_t count : {1u, 2u, 3u})  // fewer may be all that stand together
        each_choice(matrix.candidates(), count, [&](Chosen chosen) {
          if (!existing.empty() && std::ranges::count(chosen, 3u) > 0) return;
          chosen.insert(chosen.end(), existing.begin(), existing.end());
          if (!stands(chosen)) return;
          const double value = coverage_by_definition(matrix, chosen);
          best = std::max(best, value);
          if (connected_by_definition(graph, chosen, 1)) best_linked = std::max(best_linked, value);
        });
      CoverProblem problem{.matrix = matrix, .graph = &graph, .existing = existing, .most = 3};
      const CoverSolution found = max_cover(problem, config);
      EXPECT_TRUE(stands(found.chosen));
      EXPECT_NEAR(found.coverage, best, 1e-9);
      EXPECT_NEAR(found.bound, best, 2e-5);
      problem.link = 1;
      const CoverSolution linked = max_cover(problem, config);
      EXPECT_TRUE(stands(linked.chosen) && connected_by_definition(graph, linked.chosen, 1));
      EXPECT_NEAR(linked.coverage, best_linked, 1e-9);
      EXPECT_NEAR(linked.bound, best_linked, 2e-5);
    }
  }
}

// Existing stations are there, however near to each other.
TEST(MaxCover, LetsExistingCandidatesExcludeEachOther) {
  const CoverageMatrix matrix = random_matrix(10, 120, 3, 0.15, 2);
  StationGraph graph(10);
  graph.exclude(0, 1), graph.exclude(1, 2);
  double best = 0;
  for (std::size_t k = 3; k < 10; ++k) best = std::max(best, coverage_by_definition(matrix, Chosen{0, 1, k}));
  const CoverSolution found =
      max_cover({.matrix = matrix, .graph = &graph, .existing = {0, 1}, .most = 1}, {.exact_seconds = 60});
  EXPECT_NEAR(found.coverage, best, 1e-9);
  EXPECT_NEAR(found.bound, best, 2e-5);
}

TEST(MaxCover, SaysWhereNoNetworkIsConnected) {
  const CoverageMatrix matrix = random_matrix(6, 80, 4, 0.3);
  const StationGraph apart(6);
  const CoverSolution none =
      max_cover({.matrix = matrix, .graph = &apart, .existing = {0, 1}, .most = 3, .link = 1}, {.exact_seconds = 10});
  EXPECT_TRUE(none.chosen.empty());
  EXPECT_EQ(none.coverage, 0);
}

TEST(MaxCover, RefusesWhatMakesNoSense) {
  const CoverageMatrix matrix = random_matrix(5, 50, 1), empty({1, 1}, 1);
  EXPECT_THROW(max_cover({.matrix = matrix, .most = 0}), Error);
  EXPECT_THROW(max_cover({.matrix = matrix}), Error) << "without a number";
  EXPECT_THROW(max_cover({.matrix = matrix, .existing = {5}, .most = 2}), Error);
  EXPECT_THROW(max_cover({.matrix = empty, .most = 1}), Error);
  EXPECT_THROW(min_cover({.matrix = matrix, .coverage = 1.5}), Error);
  EXPECT_THROW(min_cover({.matrix = empty, .coverage = 0.5}), Error);
}

// Along a wall of 10 000 elements, each candidate covers 100 in a row: 80 stations cover at most 80 times 100, and side
// by side they do.
TEST(MaxCover, HasNoLimitOf64Stations) {
  constexpr std::uint32_t elements = 10'000, sight = 100, apart = 25;
  CoverageMatrix matrix(std::vector<std::uint32_t>(elements, 1), 10);
  for (std::uint32_t first = 0; first + sight <= elements; first += apart) {
    std::vector<std::uint32_t> amounts(elements);
    std::fill_n(amounts.begin() + first, sight, 11);
    matrix.add(amounts);
  }
  const CoverSolution best = max_cover({.matrix = matrix, .most = 80});
  EXPECT_NEAR(best.bound, 0.8, 2e-3);
  EXPECT_GE(best.bound, 0.8 - 1e-9);
  EXPECT_EQ(best.chosen.size(), 80u);
  EXPECT_GT(best.coverage, 0.75);
}

}  // namespace
}  // namespace vantage
