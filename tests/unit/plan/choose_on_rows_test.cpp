// SPDX-License-Identifier: Apache-2.0
#include "plan/choose_on_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "unit/plan/random_rows.hpp"

namespace vantage {
namespace {

using test::random_rows;
using Rows = std::vector<std::size_t>;

// Equation 8 by the book.
double captured(const CaptureRows& rows, const Rows& chosen) {
  std::vector<double> points(rows.voxels().size());
  for (const std::size_t k : chosen)
    for (const CapturedVoxel& seen : rows.row(k)) points[seen.voxel] += seen.points;
  double sum = 0;
  for (std::size_t v = 0; v < points.size(); ++v)
    sum += rows.weights()[v] * std::min(points[v] / rows.goal_density(), 1.0);
  return sum / rows.total_weight();
}

// Whether each row after the first `fixed` was the one that adds most, or as much as any.
void expect_greedy(const CaptureRows& rows, const Rows& chosen, std::size_t fixed) {
  for (std::size_t at = fixed; at < chosen.size(); ++at) {
    Rows with(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(at + 1));
    const double value = captured(rows, with);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      with.back() = k;
      EXPECT_LE(captured(rows, with), value + 1e-12) << k << " instead of " << chosen[at];
    }
  }
}

TEST(ChooseOnRows, CoverKeepsEquation8) {
  const CaptureRows rows = random_rows(12, 80, 1, 0.3, 4);
  RowCover cover(rows);
  Rows chosen;
  for (const std::size_t k : {3u, 7u, 1u, 3u}) {
    const double before = cover.value(), gain = cover.gain(k);
    cover.add(k);
    chosen.push_back(k);
    EXPECT_NEAR(cover.value(), captured(rows, chosen), 1e-12);
    EXPECT_NEAR(cover.value() - before, gain, 1e-12);
    EXPECT_NEAR(cover.loss(k), gain, 1e-12);
  }
  EXPECT_NEAR(rows.coverage(chosen).value, cover.value(), 1e-12);
  cover.remove(7);
  EXPECT_NEAR(cover.value(), captured(rows, {3, 1, 3}), 1e-12);
}

TEST(ChooseOnRows, ColumnsKnowWhatRowsGainWithoutOneThatLeaves) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const CaptureRows rows = random_rows(20, 90, seed, 0.3, 3);
    const Rows chosen{2, 11, 7, 2, 19};  // one of them twice
    const RowCover cover(rows, chosen);
    const RowColumns columns(rows);
    for (std::size_t at = 0; at < chosen.size(); ++at) {
      Rows others = chosen;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(at));
      const RowCover without(rows, others);
      std::vector<double> gains(rows.size());
      for (std::size_t row = 0; row < rows.size(); ++row) gains[row] = cover.gain(row);
      columns.add_gains_without(chosen[at], cover, gains);
      for (std::size_t row = 0; row < rows.size(); ++row)
        EXPECT_NEAR(gains[row], without.gain(row), 1e-12) << row << " without " << chosen[at];
    }
  }
}

TEST(ChooseOnRows, LazyGreedyIsGreedy) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const CaptureRows rows = random_rows(25, 120, seed, 0.15, 3);
    const Rows chosen = choose_greedily(rows, 8);
    EXPECT_EQ(chosen.size(), 8u);
    expect_greedy(rows, chosen, 0);
    const Rows fixed{4, 9};
    const Rows more = choose_greedily(rows, 5, fixed);
    EXPECT_EQ(more.size(), 7u);
    EXPECT_TRUE(std::equal(fixed.begin(), fixed.end(), more.begin()));
    expect_greedy(rows, more, 2);
  }
}

TEST(ChooseOnRows, GreedyStopsWhereNothingIsAddedOrItIsEnough) {
  const CaptureRows rows = random_rows(30, 40, 5, 0.4);
  const Rows all = choose_greedily(rows, 30);
  EXPECT_LT(all.size(), 30u);
  EXPECT_NEAR(captured(rows, all), rows.coverage().value, 1e-12);
  const Rows some = choose_greedily(rows, 30, {}, 0.8);
  EXPECT_GE(captured(rows, some), 0.8);
  EXPECT_LT(captured(rows, {some.begin(), some.end() - 1}), 0.8);
}

TEST(ChooseOnRows, RowsThatMayNotBeTakenNowMayBeLater) {
  const CaptureRows rows = random_rows(20, 100, 6, 0.1);
  // Neighbours by number of what is taken: a chain.
  const MayTake chained = [](std::size_t row, std::span<const std::size_t> taken) {
    return taken.empty() ? row == 10
                         : std::ranges::any_of(taken, [&](std::size_t k) { return k + 1 == row || row + 1 == k; });
  };
  const Rows chosen = choose_greedily(rows, 6, {}, 1, chained);
  ASSERT_EQ(chosen.size(), 6u);
  Rows sorted = chosen;
  std::ranges::sort(sorted);
  EXPECT_EQ(sorted.back() - sorted.front(), 5u);
}

TEST(ChooseOnRows, SwapsEndWhereNoneHelps) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const CaptureRows rows = random_rows(25, 120, seed, 0.12, 3);
    const Rows start{0, 1, 2, 3, 4, 5};
    const std::size_t fixed = seed % 3;
    const Rows chosen = improve_by_swaps(rows, start, fixed);
    ASSERT_EQ(chosen.size(), start.size());
    EXPECT_TRUE(std::equal(start.begin(), start.begin() + static_cast<std::ptrdiff_t>(fixed), chosen.begin()));
    const double value = captured(rows, chosen);
    EXPECT_GT(value, captured(rows, start));
    for (std::size_t at = fixed; at < chosen.size(); ++at) {
      for (std::size_t k = 0; k < rows.size(); ++k) {
        Rows other = chosen;
        other[at] = k;
        EXPECT_LE(captured(rows, other), value + 2e-9) << at << " for " << k;
      }
    }
  }
}

TEST(ChooseOnRows, DropsWhatIsToSpareAndNoMore) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const CaptureRows rows = random_rows(25, 120, seed, 0.15, 3);
    const double enough = 0.6 * rows.coverage().value;
    Rows all(rows.size());
    std::iota(all.begin(), all.end(), 0u);
    const Rows few = drop_and_swap(rows, all, 2, enough);
    EXPECT_GE(captured(rows, few), enough);
    EXPECT_LT(few.size(), all.size());
    EXPECT_TRUE(std::equal(few.begin(), few.begin() + 2, all.begin())) << "the fixed ones stay";
    for (std::size_t at = 2; at < few.size(); ++at) {
      Rows fewer = few;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(at));
      EXPECT_LT(captured(rows, fewer), enough);
    }
  }
}

}  // namespace
}  // namespace vantage
