// SPDX-License-Identifier: Apache-2.0
// Results against all possible networks, on problems small enough to try them.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "unit/cover/random_matrix.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

using test::Chosen;
using test::connected_by_definition;
using test::coverage_by_definition;

struct RandomSite {
  CoverageMatrix matrix;
  StationGraph graph;

  CoverProblem problem(double coverage, double link, std::size_t most = 13) const {
    return {.matrix = matrix, .graph = &graph, .most = most, .coverage = coverage, .link = link};
  }
};

// Candidates on a square of 10 m. Each covers what lies within 4 m, and overlaps with another by how near it is.
RandomSite random_site(std::size_t candidates, unsigned seed) {
  std::mt19937 random(seed);
  const auto number = [&] { return 10 * static_cast<double>(random()) / 4294967296.0; };
  std::vector<Vec3> at(candidates);
  for (Vec3& p : at) p = {number(), number(), 0};
  constexpr int side = 10;
  CoverageMatrix matrix(std::vector<std::uint32_t>(side * side, 1), 4);
  const auto distance = [](const Vec3& a, const Vec3& b) { return std::sqrt(dot(a - b, a - b)); };
  for (const Vec3& p : at) {
    std::vector<std::uint32_t> amounts;
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        const double away = distance(p, {i + 0.5, j + 0.5, 0});
        amounts.push_back(away < 4 ? static_cast<std::uint32_t>(std::ceil(6 - away)) : 0);
      }
    matrix.add(amounts);
  }
  std::vector<float> overlaps;
  for (const Vec3& a : at)
    for (const Vec3& b : at) overlaps.push_back(static_cast<float>(std::max(0.0, 1 - distance(a, b) / 8)));
  return {std::move(matrix), StationGraph(candidates, overlaps)};
}

Chosen members(std::uint32_t set) {
  Chosen chosen;
  for (std::size_t k = 0; k < 32; ++k)
    if (set >> k & 1) chosen.push_back(k);
  return chosen;
}

// Size of the smallest set among 13 candidates with this coverage and these links; 100 if there is none.
std::size_t fewest_of_all(const RandomSite& site, double coverage, double link) {
  std::size_t fewest = 100;
  for (std::uint32_t set = 1; set < 1u << 13; ++set) {
    if (static_cast<std::size_t>(std::popcount(set)) >= fewest) continue;
    const Chosen chosen = members(set);
    if (coverage_by_definition(site.matrix, chosen) >= coverage &&
        (link == 0 || connected_by_definition(site.graph, chosen, link)))
      fewest = chosen.size();
  }
  return fewest;
}

// A hall that two linked candidates cover except for small rests, and a loft that no link reaches.
TEST(MinConnectedCover, TakesWhatNoLinkReachesBeforeCrumbs) {
  constexpr std::size_t kHall = 100, kLoft = 60, kCrumbs = 20;
  CoverageMatrix matrix(std::vector<std::uint32_t>(kHall + kLoft + kCrumbs, 1), 1);
  const auto add = [&](std::size_t first, std::size_t many) {
    std::vector<std::uint32_t> amounts(matrix.elements(), 0);
    std::fill_n(amounts.begin() + static_cast<std::ptrdiff_t>(first), many, 1u);
    matrix.add(amounts);
  };
  add(0, 60), add(60, 40);
  for (std::size_t k = 0; k < kCrumbs; ++k) add(kHall + kLoft + k, 1);
  add(kHall, kLoft);
  const std::size_t loft = matrix.candidates() - 1;
  StationGraph graph(matrix.candidates());
  for (std::size_t i = 0; i < loft; ++i)
    for (std::size_t j = 0; j < i; ++j) graph.set_overlap(i, j, 0.5f);
  CoverProblem problem{.matrix = matrix, .graph = &graph, .coverage = 0.88, .link = 0.3};
  Chosen chosen = min_connected_cover(problem).best.chosen;
  std::ranges::sort(chosen);
  EXPECT_EQ(chosen, (Chosen{0, 1, loft}));
  problem.least_help = -1;
  EXPECT_THROW(min_connected_cover(problem), Error);
}

TEST(MinConnectedCover, IsTheFewestThereIs) {
  int compared = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const RandomSite site = random_site(13, seed);
    for (const double coverage : {0.5, 0.7, 0.8}) {
      for (const double link : {0.0, 0.4, 0.6}) {
        const std::size_t fewest = fewest_of_all(site, coverage, link);
        const CoverSolution best = min_connected_cover(site.problem(coverage, link)).best;
        Chosen once = best.chosen;
        std::ranges::sort(once);
        ASSERT_EQ(std::ranges::adjacent_find(once), once.end()) << "no candidate twice";
        EXPECT_NEAR(best.coverage, coverage_by_definition(site.matrix, best.chosen), 1e-12);
        if (fewest == 100) {
          EXPECT_GT(best.violation, 0);
          continue;
        }
        ++compared;
        EXPECT_EQ(best.violation, 0) << "seed " << seed << ", coverage " << coverage << ", link " << link;
        EXPECT_GE(best.coverage, coverage);
        if (link > 0) {
          EXPECT_TRUE(connected_by_definition(site.graph, best.chosen, link));
        }
        EXPECT_EQ(best.chosen.size(), fewest) << "seed " << seed << ", coverage " << coverage << ", link " << link;
      }
    }
  }
  EXPECT_GT(compared, 50);
}

TEST(MinConnectedCover, KeepsExistingCandidatesAndTheNumbersAsked) {
  const RandomSite site = random_site(13, 3);
  CoverProblem problem = site.problem(0.7, 0.3, 11);
  problem.existing = {7, 1};
  const CoverSolution best = min_connected_cover(problem).best;
  EXPECT_EQ(best.violation, 0);
  EXPECT_EQ(best.chosen[0], 7u);
  EXPECT_EQ(best.chosen[1], 1u);
  EXPECT_EQ(std::ranges::count(best.chosen, 7u) + std::ranges::count(best.chosen, 1u), 2);
  problem.existing.clear(), problem.fewest = 7;
  EXPECT_GE(min_connected_cover(problem).best.chosen.size(), 7u);
  problem.fewest = 1, problem.most = 2;
  const CoverSolution few = min_connected_cover(problem).best;
  EXPECT_LE(few.chosen.size(), 2u);
  EXPECT_GT(few.violation, 0) << "two circles of 4 m do not cover 70 m2 four times";
}

TEST(MinConnectedCover, TellsTheBestNetworkOfOneFewer) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const RandomSite site = random_site(40, seed);
    const ConnectedCover found = min_connected_cover(site.problem(0.8, 0.4, 40));
    ASSERT_EQ(found.best.violation, 0);
    ASSERT_TRUE(found.one_fewer);
    EXPECT_EQ(found.one_fewer->chosen.size() + 1, found.best.chosen.size());
    EXPECT_GT(found.one_fewer->violation, 0);
  }
}

TEST(MinConnectedCover, TakesNoTwoThatExcludeEachOther) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    RandomSite site = random_site(40, seed);
    for (std::size_t i = 0; i < 40; ++i)
      for (std::size_t j = i + 1; j < 40; ++j)
        if (site.graph.overlap(i, j) > 0.8F) site.graph.exclude(i, j);
    const CoverSolution best =
        improve_weakest_link(site.problem(0.8, 0.4, 40), min_connected_cover(site.problem(0.8, 0.4, 40)).best);
    EXPECT_EQ(best.violation, 0);
    for (const std::size_t a : best.chosen)
      for (const std::size_t b : best.chosen) EXPECT_FALSE(site.graph.excluded(a, b));
  }
}

TEST(MinConnectedCover, GivesANetworkEvenWhenStopped) {
  const RandomSite site = random_site(40, 1);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(min_connected_cover(site.problem(0.8, 0.4, 40), stop.get_token()).best.chosen.empty());
}

TEST(MinConnectedCover, GrowsFromWhereItIsNotEnough) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const RandomSite site = random_site(13, seed);
    CoverProblem problem = site.problem(0.4, 0.3);
    const CoverSolution few = min_connected_cover(problem).best;
    ASSERT_EQ(few.violation, 0);
    problem.coverage = 0.8;  // more is wanted now
    const CoverSolution more = min_connected_cover(problem, {}, evaluate_cover(problem, few.chosen)).best;
    EXPECT_EQ(more.violation, 0);
    EXPECT_GT(more.chosen.size(), few.chosen.size());
    EXPECT_LE(more.chosen.size(), min_connected_cover(problem).best.chosen.size() + 1);
    problem.most = few.chosen.size();  // but no more stations are allowed
    EXPECT_EQ(min_connected_cover(problem, {}, evaluate_cover(problem, few.chosen)).best.chosen.size(),
              few.chosen.size());
  }
}

TEST(ImproveWeakestLink, IsNeverWorse) {
  std::size_t stronger = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const RandomSite site = random_site(40, seed);
    const CoverProblem problem = site.problem(0.8, 0.4, 40);
    const CoverSolution first = min_connected_cover(problem).best, better = improve_weakest_link(problem, first);
    EXPECT_EQ(better.chosen.size(), first.chosen.size());
    EXPECT_LE(better.violation, first.violation);
    EXPECT_GE(better.link, first.link);
    EXPECT_TRUE(connected_by_definition(site.graph, better.chosen, better.link)) << "by links of that overlap";
    EXPECT_FALSE(connected_by_definition(site.graph, better.chosen, better.link + 1e-6)) << "and of no more";
    EXPECT_EQ(better.chosen, improve_weakest_link(problem, first).chosen) << "the same, to the last candidate";
    stronger += better.link > first.link;
  }
  EXPECT_GT(stronger, 0u);
}

// Nothing leads to the first component; a path between the others is found all the same.
TEST(MinConnectedCover, JoinsComponentsThoughOneIsOutOfReach) {
  const RandomSite site = random_site(6, 2);
  StationGraph graph(6);
  graph.set_overlap(1, 2, 0.5F), graph.set_overlap(2, 3, 0.5F);
  const CoverProblem problem{.matrix = site.matrix, .graph = &graph, .existing = {0, 1, 3}, .most = 3, .link = 0.4};
  CoverProblem covered = problem;
  covered.coverage = 0.1, covered.fewest = 0;
  const CoverSolution best = min_connected_cover(covered).best;
  EXPECT_EQ(best.chosen, (Chosen{0, 1, 3, 2}));
  EXPECT_NEAR(best.violation, 0.2, 1e-12) << "one link is missing";
}

TEST(EvaluateCover, CountsWhatIsShortAndEachMissingLink) {
  const RandomSite site = random_site(13, 2);
  StationGraph apart(13);
  apart.set_overlap(0, 1, 0.5F);
  const CoverProblem problem{.matrix = site.matrix, .graph = &apart, .coverage = 1, .link = 0.5};
  const CoverSolution three = evaluate_cover(problem, {0, 1, 2});
  EXPECT_NEAR(three.violation, 1 - coverage_by_definition(site.matrix, Chosen{0, 1, 2}) + 0.2, 1e-12);
  EXPECT_EQ(three.link, 0);
  EXPECT_EQ(evaluate_cover(problem, {0, 1}).link, 0.5);
  EXPECT_EQ(evaluate_cover(problem, {0}).link, 1);
}

}  // namespace
}  // namespace vantage
