// SPDX-License-Identifier: Apache-2.0
#include "search/sample_statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vantage {
namespace {

using Values = std::vector<std::vector<double>>;

TEST(SampleStatistics, MeansOverSamplesAndWhatNewcomersAreToldWith) {
  SampleStatistics statistics(1);
  const std::vector<ParetoPoint> population{{.x = {1}, .f = {0}}, {.x = {2}, .f = {0}}};
  // The first sample after the one that took them in, which does not count.
  Values seen{{0.5}, {0.7}};
  statistics.average(population, seen);
  EXPECT_EQ(seen, (Values{{0.5}, {0.7}}));
  std::vector<double> newcomer{0.2};
  statistics.correct(newcomer);
  EXPECT_DOUBLE_EQ(newcomer[0], 0.2);
  // The next one is 0.2 below it.
  seen = {{0.3}, {0.5}};
  statistics.average(population, seen);
  EXPECT_DOUBLE_EQ(seen[0][0], 0.4);
  EXPECT_DOUBLE_EQ(seen[1][0], 0.6);
  statistics.correct(newcomer);
  EXPECT_DOUBLE_EQ(newcomer[0], 0.3);
  EXPECT_EQ(statistics.state().known.size(), 2u);
  // A third sample: the first network is known on three, and a newcomer on one.
  const std::vector<ParetoPoint> next{{.x = {1}, .f = {0}}, {.x = {4}, .f = {0}}};
  seen = {{0.4}, {0.3}};
  statistics.average(next, seen);
  EXPECT_DOUBLE_EQ(seen[0][0], 0.4);
  EXPECT_DOUBLE_EQ(seen[1][0], 0.3);
}

TEST(SampleStatistics, AllSamplesTogetherAtTheLevelOfTheLast) {
  SampleStatistics statistics(1);
  const std::vector<ParetoPoint> known{{.x = {1}, .f = {0}}};
  for (const double value : {0.5, 0.4, 0.6}) {
    Values seen{{value}};
    statistics.average(known, seen);
  }
  Values other{{0.5}, {0.9}};  // a fourth sample, on which another network is known as well
  const std::vector<ParetoPoint> both{known[0], {.x = {3}, .f = {0}}};
  statistics.average(both, other);
  // Means of 0.5 and 0.9 that the last sample, four times as large, estimates at 0.4 and 0.6: they are 0.2 too high.
  const std::vector<ParetoPoint> kept{both[0], both[1], {.x = {2}, .f = {0}}};
  const auto pooled = statistics.pooled(kept, {{{0.4, 0.02}}, {{0.6, 0.02}}, {{0.2, 0.03}}}, 4);
  EXPECT_NEAR(pooled[0][0].value, (4 * 0.3 + 4 * 0.4) / 8, 1e-15);
  EXPECT_NEAR(pooled[1][0].value, (0.7 + 4 * 0.6) / 5, 1e-15);
  EXPECT_EQ(pooled[2][0].value, 0.2);
  EXPECT_EQ(pooled[0][0].standard_error, 0.02);
}

TEST(SampleStatistics, TheSameNetworkTwiceIsMeasuredOnce) {
  SampleStatistics statistics(1);
  const ParetoPoint point{.x = {1}, .f = {0}};
  const std::vector<ParetoPoint> population{point, point};
  Values seen{{0.5}, {0.5}};
  statistics.average(population, seen);
  seen = {{0.25}, {0.25}};
  statistics.average(population, seen);
  EXPECT_EQ(seen, (Values{{0.375}, {0.375}}));
  EXPECT_EQ(statistics.state().known.at(point.x).count, 2u);
}

}  // namespace
}  // namespace vantage
