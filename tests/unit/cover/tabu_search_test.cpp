// SPDX-License-Identifier: Apache-2.0
#include "cover/tabu_search.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <utility>

#include "unit/cover/random_matrix.hpp"

namespace vantage {
namespace {

using test::Chosen;

constexpr std::size_t kPatience = 100;

// Violation of a network by its definition.
double violation_of(const CoverProblem& problem, const Chosen& network, double link) {
  return violation(problem, problem.matrix.coverage(network), components_of(problem, network, link).count);
}

// Whether all members may stand together, each once, the existing ones first.
bool stands(const CoverProblem& problem, const Chosen& network) {
  for (std::size_t i = 0; i < network.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (network[i] == network[j] || (problem.graph && problem.graph->excluded(network[i], network[j]))) return false;
  return std::equal(problem.existing.begin(), problem.existing.end(), network.begin());
}

// The least violation that the best swap of all, one after the other, comes to: 40 without success, 7 before a
// candidate may return.
double by_best_swaps(const CoverProblem& problem, Chosen chosen, double link) {
  double least = violation_of(problem, chosen, link);
  std::vector<std::size_t> tabu(problem.matrix.candidates(), 0);
  std::size_t swap = 1;
  for (std::size_t idle = 0; least > 0 && idle < 40; ++swap, ++idle) {
    double best = std::numeric_limits<double>::infinity();
    std::size_t place = 0, in = 0;
    for (std::size_t at = problem.existing.size(); at < chosen.size(); ++at)
      for (const std::size_t k : free_candidates(problem)) {
        Chosen swapped = chosen;
        swapped[at] = k;
        if (!stands(problem, swapped)) continue;
        const double here = violation_of(problem, swapped, link);
        if ((tabu[chosen[at]] > swap || tabu[k] > swap) && here >= least) continue;
        if (here < best) best = here, place = at, in = k;
      }
    if (best == std::numeric_limits<double>::infinity()) break;
    tabu[chosen[place]] = swap + 8, tabu[in] = swap + 4;
    chosen[place] = in;
    if (best < least) idle = 0, least = best;
  }
  return least;
}

// Candidates along a line, each with the elements and the links near it: most have nothing in common, and a network
// falls apart without most of its members.
struct Line {
  CoverageMatrix matrix;
  StationGraph graph{60};
  explicit Line(std::uint64_t seed) {
    RandomStream random(seed);
    std::vector<std::uint32_t> weights(120);  // so different that hardly two networks have the same coverage
    for (std::uint32_t& weight : weights) weight = 1 + static_cast<std::uint32_t>(random.uniform() * 1e6);
    matrix = CoverageMatrix(weights, 12);
    std::vector<double> at(60);
    for (double& x : at) x = random.uniform() * 120;
    for (const double x : at) {
      std::vector<std::uint32_t> amounts(120, 0);
      for (std::size_t e = 0; e < amounts.size(); ++e)
        if (std::abs(x - static_cast<double>(e)) < 9) amounts[e] = static_cast<std::uint32_t>(random.uniform() * 9);
      matrix.add(amounts);
    }
    for (std::size_t i = 0; i < at.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const double apart = std::abs(at[i] - at[j]);
        if (apart < 22 && random.uniform() < 0.7) graph.set_overlap(i, j, static_cast<float>(1 - apart / 25));
        if (apart < 1.5 && random.uniform() < 0.5) graph.exclude(i, j);
      }
  }
  CoverProblem problem(double link) const {
    return {.matrix = matrix,
            .graph = &graph,
            .existing = {2, 31},
            .most = 12,
            .coverage = 0.5,
            .link = std::min(link, 0.3)};
  }
};

// A network of 12 in which all may stand.
Chosen start_of(const CoverProblem& problem, std::size_t from) {
  Chosen start = problem.existing;
  for (std::size_t k = from; start.size() < 12; k = (k + 5) % 60) {
    start.push_back(k);
    if (!stands(problem, start)) start.pop_back(), k += 1;
  }
  return start;
}

TEST(TabuSearch, FindsNetworksAsGoodAsTheBestSwapOfAllDoes) {
  double all = 0, all_by_best_swaps = 0;
  std::size_t connected = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Line line(seed);
    for (const double link : {0.0, 0.3, 0.6}) {
      SCOPED_TRACE(std::to_string(seed) + ", links of " + std::to_string(link));
      const CoverProblem problem = line.problem(link);
      const Chosen start = start_of(problem, 3);
      const TabuSearch::Found found = TabuSearch(problem, kPatience).run(start, link);
      EXPECT_EQ(found.network.size(), start.size());
      EXPECT_TRUE(stands(problem, found.network));
      EXPECT_NEAR(found.violation, violation_of(problem, found.network, link), 1e-9);
      EXPECT_LE(found.violation, violation_of(problem, start, link) + 1e-9) << "never worse";
      for (const std::size_t k : found.network)
        EXPECT_TRUE(std::ranges::count(start, k) + std::ranges::count(found.joined, k) > 0) << "where is it from?";
      all += found.violation;
      all_by_best_swaps += by_best_swaps(problem, start, link);
      connected += link > 0 && components_of(problem, found.network, link).count == 1;
    }
  }
  EXPECT_LE(all, all_by_best_swaps);
  EXPECT_GT(connected, 3u);
}

TEST(TabuSearch, FindsTheSameWithAnyNumberOfThreads) {
  const Line line(3);
  const CoverProblem problem = line.problem(0.3);
  std::vector<Chosen> starts;
  for (const std::size_t from : {3u, 7u, 11u, 16u, 22u}) starts.push_back(start_of(problem, from));
  const TabuSearch search(problem, kPatience);
  for (const double enough : {0.0, 0.1, 0.5}) {  // all fail; some do not
    std::vector<std::vector<TabuSearch::Found>> found;
    for (const std::size_t threads : {1u, 2u, 8u, 8u, 8u}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      found.push_back(search.run(starts, 0.3, enough));
    }
    for (std::size_t k = 0; k + 1 < found.front().size(); ++k) EXPECT_GT(found.front()[k].violation, enough);
    if (found.front().size() < starts.size()) {
      EXPECT_LE(found.front().back().violation, enough) << "only a good one ends the list";
    }
    for (const auto& other : found) {
      ASSERT_EQ(other.size(), found.front().size());
      for (std::size_t k = 0; k < other.size(); ++k) {
        EXPECT_EQ(other[k].network, found.front()[k].network);
        EXPECT_EQ(other[k].joined, found.front()[k].joined);
      }
    }
  }
}

TEST(TabuSearch, EndsWhereNoMemberMayLeaveOrNoneMayCome) {
  const Line line(1);
  CoverProblem problem = line.problem(0.3);
  EXPECT_EQ(TabuSearch(problem, kPatience).run(problem.existing, 0.3).network, problem.existing);
  StationGraph apart(60);  // all exclude each other
  for (std::size_t i = 0; i < 60; ++i)
    for (std::size_t j = 0; j < i; ++j) apart.exclude(i, j);
  problem.graph = &apart;
  problem.existing = {2};
  EXPECT_EQ(TabuSearch(problem, kPatience).run({2, 9}, 0.3).network, (Chosen{2, 9}));
}

}  // namespace
}  // namespace vantage
