// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "unit/cover/random_matrix.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

using test::random_matrix;

void expect_equal(std::span<const CoverageMatrix::Entry> a, std::span<const CoverageMatrix::Entry> b) {
  EXPECT_TRUE(std::ranges::equal(a, b, [](const CoverageMatrix::Entry& x, const CoverageMatrix::Entry& y) {
    return x.element == y.element && x.amount == y.amount;
  }));
}

TEST(CoverageMatrix, KeepsColumnsHoweverTheyAreGiven) {
  CoverageMatrix matrix({1, 2, 3, 4}, 10);
  matrix.add(std::vector<std::uint32_t>{0, 7, 0, 12});
  matrix.add(std::vector<CoverageMatrix::Entry>{{1, 7}, {3, 12}});
  ASSERT_EQ(matrix.candidates(), 2u);
  ASSERT_EQ(matrix.column(0).size(), 2u);
  EXPECT_EQ(matrix.column(0)[1].element, 3u);
  EXPECT_EQ(matrix.column(0)[1].amount, 12u);
  expect_equal(matrix.column(0), matrix.column(1));
  EXPECT_DOUBLE_EQ(matrix.coverage(std::vector<std::size_t>{0}), (2 * 0.7 + 4) / 10);
  EXPECT_DOUBLE_EQ(matrix.coverage(std::vector<std::size_t>{0, 1}), (2 + 4) / 10.0);
}

TEST(CoverageMatrix, AppendsCandidatesOverTheSameElements) {
  const CoverageMatrix some = random_matrix(3, 20, 1);
  CoverageMatrix more(some.weights(), some.goal());
  more.append(some);
  more.append(some, 2);
  ASSERT_EQ(more.candidates(), 5u);
  for (std::size_t k = 0; k < 5; ++k) expect_equal(more.column(k), some.column(k % 3));
  EXPECT_THROW(more.append(random_matrix(3, 21, 1)), Error);
  EXPECT_THROW(more.append(CoverageMatrix(some.weights(), some.goal() + 1)), Error);
}

TEST(CoverageMatrix, CountsUpToTheGoalOfEachElement) {
  CoverageMatrix matrix = random_matrix(6, 40, 3, 0.5, 3);
  std::vector<double> goals(40);
  for (std::size_t e = 0; e < 40; ++e) goals[e] = e % 7 == 0 ? 0 : 1 + 0.35 * static_cast<double>(e % 30);
  const double before = matrix.coverage(std::vector<std::size_t>{0, 3});
  matrix.set_goals(std::vector<double>(40, matrix.goal()));
  EXPECT_EQ(matrix.coverage(std::vector<std::size_t>{0, 3}), before) << "the common goal, given one by one";
  matrix.set_goals(goals);
  const std::vector<std::size_t> chosen{1, 2, 5};
  double sum = 0, all = 0;
  for (std::size_t e = 0; e < 40; ++e) {
    double amount = 0;
    for (const std::size_t k : chosen)
      for (const CoverageMatrix::Entry& one : matrix.column(k)) amount += one.element == e ? one.amount : 0;
    sum += matrix.weights()[e] * std::min(amount, goals[e]);
    all += matrix.weights()[e] * goals[e];
  }
  EXPECT_NEAR(matrix.coverage(chosen), sum / all, 1e-12);
  CoverageMatrix other(matrix.weights(), matrix.goal());
  EXPECT_THROW(other.append(matrix), Error) << "over other goals";
  EXPECT_THROW(other.set_goals(std::vector<double>(39, 1)), Error);
  goals[4] = -1;
  EXPECT_THROW(other.set_goals(goals), Error);
}

TEST(CoverageMatrix, BoundsHoldWithGoalsOfTheirOwn) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CoverageMatrix matrix = random_matrix(9, 60, seed, 0.4, 2);
    // The best single candidate of each element, as what is attainable goes by.
    std::vector<double> goals(60, 0);
    for (std::size_t k = 0; k < 9; ++k)
      for (const CoverageMatrix::Entry& one : matrix.column(k))
        goals[one.element] = std::max(goals[one.element], std::min<double>(one.amount, matrix.goal()));
    matrix.set_goals(goals);
    double best = 0;
    test::each_choice(9, 3, [&](const test::Chosen& chosen) { best = std::max(best, matrix.coverage(chosen)); });
    const CoverSolution found = max_cover({.matrix = matrix, .most = 3}, {.exact_seconds = 5});
    EXPECT_NEAR(found.coverage, best, 1e-9) << seed;
    EXPECT_GE(found.bound, best - 1e-9) << seed;
    const StationsBound few = min_cover({.matrix = matrix, .coverage = best});
    EXPECT_LE(few.at_least, 3u) << seed;
    std::vector<std::size_t> all{0, 1, 2, 3, 4, 5, 6, 7, 8};
    EXPECT_NEAR(matrix.coverage(all), 1, 1e-12);
  }
}

}  // namespace
}  // namespace vantage
