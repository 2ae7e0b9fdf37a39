// SPDX-License-Identifier: Apache-2.0
#include "cover/swaps.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numeric>

#include "unit/cover/random_matrix.hpp"

namespace vantage {
namespace {

using test::Chosen;
using test::coverage_by_definition;
using test::random_matrix;

TEST(Swaps, EndWhereNoneHelps) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const CoverageMatrix matrix = random_matrix(25, 120, seed, 0.12, 3);
    const Chosen start{0, 1, 2, 3, 4, 5}, existing(start.begin(), start.begin() + static_cast<int>(seed % 3));
    const Chosen chosen = improve_by_swaps({.matrix = matrix, .existing = existing}, start);
    ASSERT_EQ(chosen.size(), start.size());
    EXPECT_TRUE(std::equal(existing.begin(), existing.end(), chosen.begin()));
    const double value = coverage_by_definition(matrix, chosen);
    EXPECT_GT(value, coverage_by_definition(matrix, start));
    for (std::size_t at = existing.size(); at < chosen.size(); ++at) {
      for (std::size_t k = 0; k < matrix.candidates(); ++k) {
        Chosen other = chosen;
        other[at] = k;
        EXPECT_LE(coverage_by_definition(matrix, other), value + 2e-9) << at << " for " << k;
      }
    }
  }
}

TEST(Swaps, BreakNoConnectionAndNoExclusion) {
  std::size_t changed = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const CoverageMatrix matrix = random_matrix(25, 120, seed, 0.12, 3);
    StationGraph graph = test::random_links(25, seed + 50, 0.3);
    for (std::size_t k = 0; k < 3; ++k) graph.set_overlap(k, k + 1, 1);
    graph.exclude(0, 9), graph.exclude(0, 11), graph.exclude(0, 13);
    const Chosen start{0, 1, 2, 3};
    const Chosen chosen = improve_by_swaps({.matrix = matrix, .graph = &graph, .existing = {0}, .link = 1}, start);
    EXPECT_TRUE(test::connected_by_definition(graph, chosen, 1));
    for (const std::size_t k : chosen) EXPECT_FALSE(graph.excluded(0, k));
    EXPECT_GE(coverage_by_definition(matrix, chosen), coverage_by_definition(matrix, start));
    changed += chosen != start;
  }
  EXPECT_GT(changed, 5u);
}

TEST(Swaps, ImproveANetworkInTwoPartsWithoutAThird) {
  std::size_t changed = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const CoverageMatrix matrix = random_matrix(24, 120, seed, 0.12, 3);
    const StationGraph random = test::random_links(24, seed + 50, 0.4);
    StationGraph graph(24);
    for (const std::size_t first : {0u, 12u})
      for (std::size_t a = first; a < first + 12; ++a)
        for (std::size_t b = a + 1; b < first + 12; ++b)
          if (random.linked(a, b, 1) || b == a + 1) graph.set_overlap(a, b, 1);
    const Chosen start{0, 1, 12, 13, 14};
    const Chosen chosen = improve_by_swaps({.matrix = matrix, .graph = &graph, .link = 1}, start);
    std::array<Chosen, 2> parts;
    for (const std::size_t k : chosen) parts[k / 12].push_back(k);
    for (const Chosen& part : parts) EXPECT_TRUE(part.empty() || test::connected_by_definition(graph, part, 1));
    changed += chosen != start;
  }
  EXPECT_GT(changed, 5u);
}

TEST(Swaps, DropsWhatIsToSpareAndNoMore) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const CoverageMatrix matrix = random_matrix(25, 120, seed, 0.15, 3);
    Chosen all(matrix.candidates());
    std::iota(all.begin(), all.end(), 0u);
    const double enough = 0.6 * matrix.coverage(all);
    const Chosen few = drop_and_swap({.matrix = matrix, .existing = {0, 1}, .coverage = enough}, all);
    EXPECT_GE(coverage_by_definition(matrix, few), enough);
    EXPECT_LT(few.size(), all.size());
    EXPECT_TRUE(std::equal(few.begin(), few.begin() + 2, all.begin())) << "existing ones stay";
    for (std::size_t at = 2; at < few.size(); ++at) {
      Chosen fewer = few;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(at));
      EXPECT_LT(coverage_by_definition(matrix, fewer), enough);
    }
  }
}

}  // namespace
}  // namespace vantage
