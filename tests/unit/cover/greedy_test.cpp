// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "unit/cover/random_matrix.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

using test::Chosen;
using test::coverage_by_definition;
using test::random_matrix;

// Each candidate after the existing ones adds as much as any other would.
void expect_greedy(const CoverageMatrix& matrix, const Chosen& chosen, std::size_t existing) {
  for (std::size_t at = existing; at < chosen.size(); ++at) {
    Chosen with(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(at + 1));
    const double value = coverage_by_definition(matrix, with);
    for (std::size_t k = 0; k < matrix.candidates(); ++k) {
      with.back() = k;
      EXPECT_LE(coverage_by_definition(matrix, with), value + 1e-12) << k << " instead of " << chosen[at];
    }
  }
}

TEST(Greedy, TakesWhatAddsMostThoughItIsLazy) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const CoverageMatrix matrix = random_matrix(25, 120, seed, 0.15, 3);
    const Chosen chosen = greedy({.matrix = matrix, .most = 8});
    EXPECT_EQ(chosen.size(), 8u);
    expect_greedy(matrix, chosen, 0);
    const Chosen existing{4, 9};
    const Chosen more = greedy({.matrix = matrix, .existing = existing, .most = 5});
    EXPECT_EQ(more.size(), 7u);
    EXPECT_TRUE(std::equal(existing.begin(), existing.end(), more.begin()));
    expect_greedy(matrix, more, 2);
  }
}

TEST(Greedy, StopsWhereNothingIsAddedOrItIsEnough) {
  const CoverageMatrix matrix = random_matrix(30, 40, 5, 0.4);
  Chosen every(30);
  for (std::size_t k = 0; k < every.size(); ++k) every[k] = k;
  const Chosen all = greedy({.matrix = matrix});
  EXPECT_LT(all.size(), 30u);
  EXPECT_NEAR(matrix.coverage(all), matrix.coverage(every), 1e-12);
  const Chosen some = greedy({.matrix = matrix, .coverage = 0.8});
  EXPECT_GE(matrix.coverage(some), 0.8);
  EXPECT_LT(matrix.coverage(std::span(some).first(some.size() - 1)), 0.8);
}

TEST(Greedy, TakesLaterWhatIsNotLinkedYet) {
  const CoverageMatrix matrix = random_matrix(20, 100, 6, 0.1);
  StationGraph chain(20);
  for (std::size_t k = 0; k + 1 < 20; ++k) chain.set_overlap(k, k + 1, 0.5F);
  const CoverProblem problem{.matrix = matrix, .graph = &chain, .existing = {10}, .most = 5, .link = 0.5};
  Chosen chosen = greedy(problem);
  ASSERT_EQ(chosen.size(), 6u);
  std::ranges::sort(chosen);
  EXPECT_EQ(chosen.back() - chosen.front(), 5u);
}

TEST(Greedy, GrowsEachOfTwoPartsThatNothingLinks) {
  const CoverageMatrix matrix = random_matrix(20, 100, 6, 0.1);
  StationGraph chains(20);
  for (std::size_t k = 0; k + 1 < 20; ++k)
    if (k != 9 && k != 18) chains.set_overlap(k, k + 1, 0.5F);  // 0 to 9, 10 to 18, and 19 alone
  Chosen chosen = greedy({.matrix = matrix, .graph = &chains, .existing = {5, 14}, .most = 20, .link = 0.5});
  std::ranges::sort(chosen);
  EXPECT_LT(chosen.back(), 19u);
  EXPECT_GT(chosen.size(), 12u);
}

TEST(Greedy, TakesNoTwoThatExcludeEachOther) {
  const CoverageMatrix matrix = random_matrix(20, 100, 7, 0.2);
  StationGraph graph(20);
  const std::size_t best = greedy({.matrix = matrix, .most = 1}).front();
  for (std::size_t k = 0; k < 20; ++k)
    if (k != best && k != 3) graph.exclude(best, k);
  EXPECT_EQ(greedy({.matrix = matrix, .graph = &graph}), (Chosen{best, 3}));
}

TEST(Greedy, RefusesProblemsThatContradictThemselves) {
  const CoverageMatrix matrix = random_matrix(5, 20, 1);
  const StationGraph small(4);
  EXPECT_THROW(greedy({.matrix = matrix, .existing = {5}}), Error);
  EXPECT_THROW(greedy({.matrix = matrix, .graph = &small}), Error);
  EXPECT_THROW(greedy({.matrix = matrix, .link = 0.3}), Error);
}

}  // namespace
}  // namespace vantage
