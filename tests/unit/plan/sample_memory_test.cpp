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
  memory.add(population[0].x, {0.5});
  memory.add(population[1].x, {0.7});
  memory.add(std::vector{3.0}, {0.9});  // not kept
  Values seen{{0.3}, {0.5}};            // the next sample is 0.2 below the first
  memory.average(population, seen, 100);
  EXPECT_DOUBLE_EQ(seen[0][0], 0.4);
  EXPECT_DOUBLE_EQ(seen[1][0], 0.6);
  std::vector<double> newcomer{0.2};
  memory.correct(newcomer);
  EXPECT_DOUBLE_EQ(newcomer[0], 0.3);
  EXPECT_EQ(memory.state().known.size(), 2u);
  // A third one, by which the first is known thrice and a newcomer twice.
  const std::vector<ParetoPoint> next{{.x = {1}, .f = {0}}, {.x = {4}, .f = {0}}};
  memory.add(next[1].x, newcomer);
  seen = {{0.4}, {0.3}};
  memory.average(next, seen, 200);
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
  memory.add(population[0].x, {0.5});
  Values seen{{0.3}};
  memory.average(population, seen, 0);
  EXPECT_DOUBLE_EQ(seen[0][0], 0.3);
}

TEST(SampleMemory, TheSameNetworkTwiceIsMeasuredOnce) {
  SampleMemory memory(1);
  const ParetoPoint point{.x = {1}, .f = {0}};
  const std::vector<ParetoPoint> population{point, point};
  memory.add(point.x, {0.5});
  Values seen{{0.25}, {0.25}};
  memory.average(population, seen, 100);
  EXPECT_EQ(seen, (Values{{0.375}, {0.375}}));
  EXPECT_EQ(memory.state().known.at(point.x).count, 2u);
}

}  // namespace
}  // namespace vantage
