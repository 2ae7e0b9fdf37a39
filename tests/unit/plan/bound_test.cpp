// SPDX-License-Identifier: Apache-2.0
#include "vantage/bound.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <coin/ClpSimplex.hpp>
#include <functional>

#include "core/philox.hpp"
#include "plan/capture_master.hpp"
#include "unit/plan/random_rows.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

using test::random_rows;
using Rows = std::vector<std::size_t>;

// Every choice of `count` rows.
void each_choice(std::size_t rows, std::size_t count, const std::function<void(const Rows&)>& with) {
  std::vector<bool> in(rows);
  std::fill(in.begin(), in.begin() + static_cast<std::ptrdiff_t>(count), true);
  do {
    Rows chosen;
    for (std::size_t k = 0; k < rows; ++k)
      if (in[k]) chosen.push_back(k);
    with(chosen);
  } while (std::prev_permutation(in.begin(), in.end()));
}

double best_of_all(const CaptureRows& rows, std::size_t count, const Rows& fixed = {}) {
  double best = 0;
  each_choice(rows.size(), count, [&](Rows chosen) {
    chosen.insert(chosen.end(), fixed.begin(), fixed.end());
    best = std::max(best, rows.coverage(chosen).value);
  });
  return best;
}

// The relaxation as it stands in the header, voxel by voxel, instead of cut by cut.
double relaxation_in_full(const CaptureRows& rows, double stations) {
  const int candidates = static_cast<int>(rows.size()), voxels = static_cast<int>(rows.voxels().size());
  ClpSimplex lp;
  lp.setLogLevel(0);
  lp.resize(0, candidates + voxels);
  lp.setOptimizationDirection(-1);
  std::vector<std::vector<int>> index(rows.voxels().size());
  std::vector<std::vector<double>> value(rows.voxels().size());
  for (int v = 0; v < voxels; ++v) {
    const auto i = static_cast<std::size_t>(v);
    index[i] = {candidates + v};
    value[i] = {1};
    lp.setObjectiveCoefficient(candidates + v, rows.weights()[i] / rows.total_weight());
  }
  for (int k = 0; k < candidates; ++k)
    for (const CapturedVoxel& seen : rows.row(static_cast<std::size_t>(k))) {
      index[seen.voxel].push_back(k);
      value[seen.voxel].push_back(-std::min(seen.points / rows.goal_density(), 1.0));
    }
  for (int c = 0; c < candidates + voxels; ++c) lp.setColumnBounds(c, 0, 1);
  for (std::size_t v = 0; v < index.size(); ++v)
    lp.addRow(static_cast<int>(index[v].size()), index[v].data(), value[v].data(), -COIN_DBL_MAX, 0);
  std::vector<int> all;
  for (int k = 0; k < candidates; ++k) all.push_back(k);
  const std::vector<double> ones(all.size(), 1);
  lp.addRow(candidates, all.data(), ones.data(), -COIN_DBL_MAX, stations);
  lp.primal();
  return lp.objectiveValue();
}

TEST(CaptureMaster, SolvesTheRelaxation) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const CaptureRows rows = random_rows(30, 300, seed, 0.12, 3);
    CaptureMaster master(rows, rows.size());
    for (const double stations : {1.0, 3.0, 5.5, 9.0}) {
      const double expected = relaxation_in_full(rows, stations);
      const Relaxed relaxed = master.most(stations, 1e-7, 0);
      EXPECT_TRUE(relaxed.complete);
      EXPECT_NEAR(relaxed.bound, expected, 2e-7) << stations;
      EXPECT_NEAR(relaxed.reached, expected, 2e-7) << stations;
      EXPECT_GE(relaxed.bound, expected - 1e-9) << stations;
      EXPECT_NEAR(master.value(relaxed.y), relaxed.reached, 1e-12);
      // And the other way round: so much capture takes so many.
      const Relaxed fewest = master.fewest(expected, 1e-7, 0);
      EXPECT_NEAR(fewest.bound, stations, 1e-4);
      EXPECT_LE(fewest.bound, stations + 1e-6);
    }
  }
}

TEST(CaptureMaster, IsABoundHoweverEarlyItStops) {
  const CaptureRows rows = random_rows(40, 400, 3, 0.08);
  const double expected = relaxation_in_full(rows, 6);
  for (const double tolerance : {0.3, 0.1, 0.03, 0.01}) {
    CaptureMaster master(rows, rows.size());
    const Relaxed relaxed = master.most(6, tolerance, 0);
    EXPECT_GE(relaxed.bound, expected - 1e-9);
    EXPECT_LE(relaxed.reached, expected + 1e-9);
    EXPECT_LE(relaxed.bound - relaxed.reached, tolerance);
    CaptureMaster again(rows, rows.size());
    EXPECT_LE(again.fewest(expected, tolerance, 0).bound, 6 + 1e-6);
  }
}

// Rows that share nothing: the best N are the N largest, and no fraction does better.
TEST(Bound, IsTheSumOfTheLargestWhereNothingIsShared) {
  CaptureRows rows(std::vector<std::uint32_t>(100, 1), 10);
  for (std::uint32_t k = 0; k < 10; ++k) {
    std::vector<std::uint32_t> points(100);
    for (std::uint32_t v = 0; v <= k; ++v) points[10 * k + v] = 25;
    rows.add(points);
  }
  const CaptureBound bound = bound_capture(rows, 3);
  EXPECT_NEAR(bound.bound, 0.27, 1e-9);
  EXPECT_NEAR(bound.reached.value, 0.27, 1e-12);
  EXPECT_NEAR(bound.half_bound, 0.12, 1e-9);  // rows 0 to 4
  EXPECT_NEAR(bound.spacing_term, 0.15, 1e-9);
  EXPECT_NEAR(bound.gap(), 0, 1e-9);
  const StationsBound number = bound_stations(rows, 0.28);
  EXPECT_TRUE(number.possible);
  EXPECT_EQ(number.at_least, 4u);
  EXPECT_EQ(number.chosen.size(), 4u);
  EXPECT_NEAR(number.relaxation, 3 + 1.0 / 7, 1e-3);
  EXPECT_FALSE(bound_stations(rows, 0.56).possible);
  EXPECT_TRUE(bound_stations(rows, 0.55).possible);
}

TEST(Bound, HoldsForEveryChoiceAndBranchingFindsTheBest) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const CaptureRows rows = random_rows(14, 150, seed, 0.15, 2);
    for (const std::size_t count : {2u, 4u}) {
      const double best = best_of_all(rows, count);
      const CaptureBound bound = bound_capture(rows, count);
      EXPECT_GE(bound.bound, best - 1e-9);
      EXPECT_GE(best, bound.reached.value - 1e-9);
      EXPECT_EQ(bound.chosen.size(), count);
      EXPECT_NEAR(rows.coverage(bound.chosen).value, bound.reached.value, 1e-12);
      const CaptureBound exact = bound_capture(rows, count, {}, {.tolerance = 1e-6, .exact_seconds = 60});
      EXPECT_NEAR(exact.reached.value, best, 1e-9);
      EXPECT_NEAR(exact.bound, best, 1e-5);
      const StationsBound number = bound_stations(rows, best - 1e-6);
      EXPECT_LE(number.at_least, count);
      EXPECT_GE(number.chosen.size(), count);
    }
    const Rows fixed{3, 5};
    const CaptureBound with = bound_capture(rows, 2, fixed, {.exact_seconds = 60});
    EXPECT_TRUE(std::equal(fixed.begin(), fixed.end(), with.chosen.begin()));
    EXPECT_NEAR(with.reached.value, best_of_all(rows, 2, fixed), 1e-9);
    EXPECT_GE(with.bound, with.reached.value - 1e-9);
  }
}

// Whether rows hang together along links, by hand: what the first reaches in as many steps as there are rows.
bool hangs_together(const Rows& chosen, const std::vector<RowLink>& links) {
  Rows reached{chosen.front()};
  for (std::size_t step = 0; step < chosen.size(); ++step)
    for (const auto& [a, b] : links)
      for (const auto& [from, to] : {std::pair{a, b}, {b, a}})
        if (std::ranges::count(reached, from) && std::ranges::count(chosen, to) && !std::ranges::count(reached, to))
          reached.push_back(to);
  return reached.size() == chosen.size();
}

TEST(Bound, FindsTheBestThatHangsTogether) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    const CaptureRows rows = random_rows(12, 150, seed, 0.15, 2);
    RandomStream random(seed + 100);
    std::vector<RowLink> links;
    for (std::size_t a = 0; a < rows.size(); ++a)
      for (std::size_t b = a + 1; b < rows.size(); ++b)
        if (random.uniform() < 0.2) links.push_back({a, b});
    const BoundConfig config{.tolerance = 1e-6, .exact_seconds = 60};
    for (const Rows& fixed : {Rows{}, Rows{3}}) {
      double best = 0, best_of_any = 0;
      each_choice(rows.size(), 4, [&](Rows chosen) {
        chosen.insert(chosen.end(), fixed.begin(), fixed.end());
        if (fixed.size() == 1 && std::ranges::count(chosen, 3u) > 1) return;
        const double value = rows.coverage(chosen).value;
        best_of_any = std::max(best_of_any, value);
        if (hangs_together(chosen, links)) best = std::max(best, value);
      });
      ASSERT_GT(best, 0);
      const CaptureBound found = bound_linked_capture(rows, 4, links, fixed, config);
      EXPECT_NEAR(found.reached.value, best, 1e-9);
      EXPECT_NEAR(found.bound, best, 2e-5);
      EXPECT_TRUE(hangs_together(found.chosen, links));
      EXPECT_EQ(found.chosen.size(), 4 + fixed.size());
      EXPECT_TRUE(std::equal(fixed.begin(), fixed.end(), found.chosen.begin()));
      EXPECT_GE(bound_linked_capture(rows, 4, links, fixed).bound, best - 1e-9) << "without branch and bound";
      EXPECT_LE(best, best_of_any);
    }
  }
}

TEST(Bound, TakesNoTwoThatExcludeEachOther) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    const CaptureRows rows = random_rows(12, 150, seed, 0.15, 2);
    RandomStream random(seed + 200);
    std::vector<RowLink> links, exclude;
    for (std::size_t a = 0; a < rows.size(); ++a)
      for (std::size_t b = a + 1; b < rows.size(); ++b) {
        if (random.uniform() < 0.5) links.push_back({a, b});
        if (random.uniform() < 0.4) exclude.push_back({a, b});
      }
    const auto stands = [&](const Rows& chosen) {
      return std::ranges::none_of(exclude, [&](const RowLink& pair) {
        return std::ranges::count(chosen, pair[0]) > 0 && std::ranges::count(chosen, pair[1]) > 0;
      });
    };
    const BoundConfig config{.tolerance = 1e-6, .exact_seconds = 60, .exclude = exclude};
    for (const Rows& fixed : {Rows{}, Rows{3}}) {
      double best = 0, best_linked = 0;
      for (const std::size_t count : {1u, 2u, 3u})  // fewer may be all that stand together
        each_choice(rows.size(), count, [&](Rows chosen) {
          if (fixed.size() == 1 && std::ranges::count(chosen, 3u) > 0) return;
          chosen.insert(chosen.end(), fixed.begin(), fixed.end());
          if (!stands(chosen)) return;
          const double value = rows.coverage(chosen).value;
          best = std::max(best, value);
          if (hangs_together(chosen, links)) best_linked = std::max(best_linked, value);
        });
      const CaptureBound found = bound_capture(rows, 3, fixed, config);
      EXPECT_TRUE(stands(found.chosen));
      EXPECT_NEAR(found.reached.value, best, 1e-9);
      EXPECT_NEAR(found.bound, best, 2e-5);
      const CaptureBound linked = bound_linked_capture(rows, 3, links, fixed, config);
      EXPECT_TRUE(stands(linked.chosen) && hangs_together(linked.chosen, links));
      EXPECT_NEAR(linked.reached.value, best_linked, 1e-9);
      EXPECT_NEAR(linked.bound, best_linked, 2e-5);
    }
  }
  const CaptureRows rows = random_rows(5, 50, 1);
  EXPECT_THROW(bound_capture(rows, 2, {}, {.exclude = {{0, 5}}}), Error);
}

TEST(Bound, SaysWhereNothingHangsTogether) {
  const CaptureRows rows = random_rows(6, 80, 4, 0.3);
  const CaptureBound none = bound_linked_capture(rows, 3, {}, Rows{0, 1}, {.exact_seconds = 10});
  EXPECT_TRUE(none.chosen.empty());
  EXPECT_EQ(none.reached.value, 0);
  EXPECT_THROW(bound_linked_capture(rows, 3, std::vector<RowLink>{{0, 6}}), Error);
  EXPECT_THROW(bound_linked_capture(rows, max_stations + 1, {}), Error);
}

TEST(Bound, RefusesWhatMakesNoSense) {
  const CaptureRows rows = random_rows(5, 50, 1);
  EXPECT_THROW(bound_capture(rows, 0), Error);
  EXPECT_THROW(bound_capture(rows, 2, Rows{5}), Error);
  EXPECT_THROW(bound_stations(rows, 1.5), Error);
  EXPECT_THROW(bound_capture(CaptureRows({1, 1}, 1), 1), Error);
}

// Along a wall of 10 000 voxels, each candidate sees 100 in a row: no more than 80 times 100 for 80 stations, which
// stations side by side have.
TEST(Bound, HasNoLimitOf64Stations) {
  constexpr std::uint32_t voxels = 10'000, sight = 100, apart = 25;
  CaptureRows rows(std::vector<std::uint32_t>(voxels, 1), 10);
  for (std::uint32_t first = 0; first + sight <= voxels; first += apart) {
    std::vector<std::uint32_t> points(voxels);
    std::fill_n(points.begin() + first, sight, 11);
    rows.add(points);
  }
  const CaptureBound bound = bound_capture(rows, 80);
  EXPECT_NEAR(bound.bound, 0.8, 2e-3);
  EXPECT_GE(bound.bound, 0.8 - 1e-9);
  EXPECT_EQ(bound.chosen.size(), 80u);
  EXPECT_GT(bound.reached.value, 0.75);
}

}  // namespace
}  // namespace vantage
