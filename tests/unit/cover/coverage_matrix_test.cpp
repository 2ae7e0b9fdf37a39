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

}  // namespace
}  // namespace vantage
