// SPDX-License-Identifier: Apache-2.0
#include "cover/benders_master.hpp"

#include <gtest/gtest.h>

#include <coin/ClpSimplex.hpp>

#include "unit/cover/random_matrix.hpp"

namespace vantage {
namespace {

using test::random_matrix;

// The relaxation as it stands in the header, element by element instead of cut by cut.
double relaxation_in_full(const CoverageMatrix& matrix, double stations) {
  const int candidates = static_cast<int>(matrix.candidates()), elements = static_cast<int>(matrix.elements());
  ClpSimplex lp;
  lp.setLogLevel(0);
  lp.resize(0, candidates + elements);
  lp.setOptimizationDirection(-1);
  std::vector<std::vector<int>> index(matrix.elements());
  std::vector<std::vector<double>> value(matrix.elements());
  for (int e = 0; e < elements; ++e) {
    const auto i = static_cast<std::size_t>(e);
    index[i] = {candidates + e};
    value[i] = {1};
    lp.setObjectiveCoefficient(candidates + e, matrix.weights()[i] / matrix.total_weight());
  }
  for (int k = 0; k < candidates; ++k)
    for (const CoverageMatrix::Entry& one : matrix.column(static_cast<std::size_t>(k))) {
      index[one.element].push_back(k);
      value[one.element].push_back(-std::min(one.amount / matrix.goal(), 1.0));
    }
  for (int c = 0; c < candidates + elements; ++c) lp.setColumnBounds(c, 0, 1);
  for (std::size_t v = 0; v < index.size(); ++v)
    lp.addRow(static_cast<int>(index[v].size()), index[v].data(), value[v].data(), -COIN_DBL_MAX, 0);
  std::vector<int> all;
  for (int k = 0; k < candidates; ++k) all.push_back(k);
  const std::vector<double> ones(all.size(), 1);
  lp.addRow(candidates, all.data(), ones.data(), -COIN_DBL_MAX, stations);
  lp.primal();
  return lp.objectiveValue();
}

TEST(BendersMaster, SolvesTheRelaxation) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const CoverageMatrix matrix = random_matrix(30, 300, seed, 0.12, 3);
    const CoverProblem problem{.matrix = matrix};
    BendersMaster master(problem, matrix.candidates());
    for (const double stations : {1.0, 3.0, 5.5, 9.0}) {
      const double expected = relaxation_in_full(matrix, stations);
      const Relaxed relaxed = master.max_coverage(stations, 1e-7, 0);
      EXPECT_TRUE(relaxed.complete);
      EXPECT_NEAR(relaxed.bound, expected, 2e-7) << stations;
      EXPECT_NEAR(relaxed.reached, expected, 2e-7) << stations;
      EXPECT_GE(relaxed.bound, expected - 1e-9) << stations;
      EXPECT_NEAR(master.value(relaxed.y), relaxed.reached, 1e-12);
      // And the other way round: so much coverage takes so many.
      const Relaxed fewest = master.min_stations(expected, 1e-7, 0);
      EXPECT_NEAR(fewest.bound, stations, 1e-4);
      EXPECT_LE(fewest.bound, stations + 1e-6);
    }
  }
}

TEST(BendersMaster, IsABoundHoweverEarlyItStops) {
  const CoverageMatrix matrix = random_matrix(40, 400, 3, 0.08);
  const CoverProblem problem{.matrix = matrix};
  const double expected = relaxation_in_full(matrix, 6);
  for (const double tolerance : {0.3, 0.1, 0.03, 0.01}) {
    BendersMaster master(problem, matrix.candidates());
    const Relaxed relaxed = master.max_coverage(6, tolerance, 0);
    EXPECT_GE(relaxed.bound, expected - 1e-9);
    EXPECT_LE(relaxed.reached, expected + 1e-9);
    EXPECT_LE(relaxed.bound - relaxed.reached, tolerance);
    BendersMaster again(problem, matrix.candidates());
    EXPECT_LE(again.min_stations(expected, tolerance, 0).bound, 6 + 1e-6);
  }
}

}  // namespace
}  // namespace vantage
