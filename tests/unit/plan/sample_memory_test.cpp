// SPDX-License-Identifier: Apache-2.0
#include "plan/sample_memory.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vantage {
namespace {

using Values = std::vector<std::vector<double>>;

TEST(SampleMemory, LooksAreOffByAMeanAndADeviation) {
  const Values looked{{1, 10}, {2, 20}, {3, 30}}, measured{{1.5, 9}, {2.5, 22}, {3.5, 29}};
  const auto errors = look_errors(looked, measured);
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_DOUBLE_EQ(errors[0].mean, 0.5);
  EXPECT_DOUBLE_EQ(errors[0].deviation, 0);
  EXPECT_DOUBLE_EQ(errors[1].mean, 0);
  EXPECT_DOUBLE_EQ(errors[1].deviation, std::sqrt((1 + 4 + 1) / 2.0));
}

TEST(SampleMemory, MeansOverSamplesAndWhatNewcomersAreToldWith) {
  SampleMemory memory(1);
  const std::vector<ParetoPoint> population{{.x = {1}, .f = {0}}, {.x = {2}, .f = {0}}};
  // The first sample after the one that they were taken in by, which does not count.
  Values seen{{0.5}, {0.7}};
  memory.average(population, seen, 100);
  EXPECT_EQ(seen, (Values{{0.5}, {0.7}}));
  std::vector<double> newcomer{0.2};
  memory.correct(newcomer);
  EXPECT_DOUBLE_EQ(newcomer[0], 0.2);
  // The next one is 0.2 below it.
  seen = {{0.3}, {0.5}};
  memory.average(population, seen, 200);
  EXPECT_DOUBLE_EQ(seen[0][0], 0.4);
  EXPECT_DOUBLE_EQ(seen[1][0], 0.6);
  memory.correct(newcomer);
  EXPECT_DOUBLE_EQ(newcomer[0], 0.3);
  EXPECT_EQ(memory.state().known.size(), 2u);
  // A third one, by which the first is known thrice and a newcomer once.
  const std::vector<ParetoPoint> next{{.x = {1}, .f = {0}}, {.x = {4}, .f = {0}}};
  seen = {{0.4}, {0.3}};
  memory.average(next, seen, 300);
  EXPECT_DOUBLE_EQ(seen[0][0], 0.4);
  EXPECT_DOUBLE_EQ(seen[1][0], 0.3);
  // A first look is off by its own mean as well.
  memory.learn_looks({{{.mean = 0.125, .deviation = 0.5}}});
  std::vector<double> looked{0.25};
  memory.correct(looked, 0);
  EXPECT_DOUBLE_EQ(looked[0], 0.375);
}

// It holds the sample before, which must not count twice.
TEST(SampleMemory, ALargerSampleFromTheSamePlaceTakesThePlaceOfTheSmaller) {
  SampleMemory memory(1);
  const std::vector<ParetoPoint> population{{.x = {1}, .f = {0}}};
  for (const double value : {0.5, 0.3}) {
    Values seen{{value}};
    memory.average(population, seen, 100);
    EXPECT_DOUBLE_EQ(seen[0][0], value);
  }
}

TEST(SampleMemory, AllSamplesTogetherAtTheLevelOfTheLast) {
  SampleMemory memory(1);
  const std::vector<ParetoPoint> known{{.x = {1}, .f = {0}}};
  for (const double value : {0.5, 0.4, 0.6}) {
    Values seen{{value}};
    memory.average(known, seen, static_cast<std::uint64_t>(1000 * value));
  }
  Values other{{0.5}, {0.9}};  // a fourth, which another one is known by as well
  const std::vector<ParetoPoint> both{known[0], {.x = {3}, .f = {0}}};
  memory.average(both, other, 700);
  // Means of 0.5 and 0.9, which the last sample, four times as large, puts at 0.4 and 0.6: they are 0.2 too high.
  const std::vector<ParetoPoint> kept{both[0], both[1], {.x = {2}, .f = {0}}};
  const auto pooled = memory.pooled(kept, {{{0.4, 0.02}}, {{0.6, 0.02}}, {{0.2, 0.03}}}, 4);
  EXPECT_NEAR(pooled[0][0].value, (4 * 0.3 + 4 * 0.4) / 8, 1e-15);
  EXPECT_NEAR(pooled[1][0].value, (0.7 + 4 * 0.6) / 5, 1e-15);
  EXPECT_EQ(pooled[2][0].value, 0.2);
  EXPECT_EQ(pooled[0][0].standard_error, 0.02);
}

TEST(SampleMemory, TheSameNetworkTwiceIsMeasuredOnce) {
  SampleMemory memory(1);
  const ParetoPoint point{.x = {1}, .f = {0}};
  const std::vector<ParetoPoint> population{point, point};
  Values seen{{0.5}, {0.5}};
  memory.average(population, seen, 100);
  seen = {{0.25}, {0.25}};
  memory.average(population, seen, 200);
  EXPECT_EQ(seen, (Values{{0.375}, {0.375}}));
  EXPECT_EQ(memory.state().known.at(point.x).count, 2u);
}

}  // namespace
}  // namespace vantage
