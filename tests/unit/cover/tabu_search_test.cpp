// SPDX-License-Identifier: Apache-2.0
#include "cover/tabu_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "unit/cover/random_matrix.hpp"

namespace vantage {
namespace {

using test::Chosen;

// The same search, with every swap of every candidate evaluated by definition.
Chosen by_definition(const CoverProblem& problem, Chosen chosen, double link) {
  using Quality = std::pair<double, double>;  // violation, and coverage below 0
  const auto quality = [&](const Chosen& network) {
    const double coverage = problem.matrix.coverage(network);
    return Quality{violation(problem, coverage, components_of(problem, network, link).count), -coverage};
  };
  const auto better = [](const Quality& a, const Quality& b) {  // rounding must not decide
    return a.first < b.first - 1e-12 || (a.first < b.first + 1e-12 && a.second < b.second - 1e-12);
  };
  Chosen best = chosen;
  Quality least = quality(best);
  std::vector<std::size_t> tabu(problem.matrix.candidates(), 0);
  std::size_t swap = 1;
  for (std::size_t idle = 0; least.first > 0 && idle < TabuSearch::kPatience; ++swap, ++idle) {
    Quality now{std::numeric_limits<double>::infinity(), 0};
    std::size_t place = 0, in = 0;
    for (std::size_t at = problem.existing.size(); at < chosen.size(); ++at)
      for (const std::size_t k : free_candidates(problem)) {
        bool stands = std::ranges::find(chosen, k) == chosen.end();
        for (std::size_t other = 0; other < chosen.size(); ++other)
          stands = stands && (other == at || !problem.graph->excluded(chosen[other], k));
        if (!stands) continue;
        Chosen swapped = chosen;
        swapped[at] = k;
        const Quality here = quality(swapped);
        if ((tabu[chosen[at]] > swap || tabu[k] > swap) && !(here.first < least.first - 1e-12)) continue;
        if (better(here, now)) now = here, place = at, in = k;
      }
    if (now.first == std::numeric_limits<double>::infinity()) break;
    tabu[chosen[place]] = swap + TabuSearch::kTabu + 1, tabu[in] = swap + TabuSearch::kTabu / 2 + 1;
    chosen[place] = in;
    if (!better(now, least)) continue;
    if (now.first < least.first - 1e-12) idle = 0;
    best = chosen, least = now;
  }
  return best;
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
};

TEST(TabuSearch, FindsWhatTryingAllSwapsFinds) {
  std::size_t connected = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Line line(seed);
    const ColumnIndex columns(line.matrix);
    for (const double link : {0.0, 0.3, 0.6}) {
      SCOPED_TRACE(std::to_string(seed) + ", links of " + std::to_string(link));
      const CoverProblem problem{.matrix = line.matrix,
                                 .graph = &line.graph,
                                 .existing = {2, 31},
                                 .most = 12,
                                 .coverage = 0.5,
                                 .link = std::min(link, 0.3)};
      Chosen start = problem.existing;
      for (std::size_t k = 3; start.size() < 12; k += 5)
        if (std::ranges::find(start, k) == start.end()) start.push_back(k);
      const Chosen found = TabuSearch(problem, columns).run(start, link),
                   expected = by_definition(problem, start, link);
      EXPECT_EQ(found, expected);
      connected += link > 0 && components_of(problem, found, link).count == 1;
    }
  }
  EXPECT_GT(connected, 3u);
}

}  // namespace
}  // namespace vantage
