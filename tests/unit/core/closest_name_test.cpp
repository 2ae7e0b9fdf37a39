// SPDX-License-Identifier: Apache-2.0
#include "core/closest_name.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace vantage {
namespace {

TEST(ClosestName, EditDistanceCountsSingleMistakes) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);  // Wagner and Fischer's example
  EXPECT_EQ(edit_distance("statoins", "stations"), 1u) << "two neighbours swapped";
  EXPECT_EQ(edit_distance("CA", "abc"), 3u) << "a pair is swapped once: 2 without that rule";
  EXPECT_EQ(edit_distance("Min-Overlap", "min_overlap"), 0u);
}

TEST(ClosestName, FindsWhatWasMeantAndNothingElse) {
  const std::vector<std::string> options{"--station",   "--stations", "--start",   "--seed",
                                         "--seed-with", "--height",   "--heights", "--min-overlap"};
  EXPECT_EQ(closest_name("--statoins", options), "--stations");
  EXPECT_EQ(closest_name("--staion", options), "--station");
  EXPECT_EQ(closest_name("--min_overlp", options), "--min-overlap");
  EXPECT_EQ(closest_name("--hight", options), "--height");
  EXPECT_EQ(closest_name("--frobnicate", options), "");
  const std::vector<std::string> problems{"coverage-fix", "coverage-overlap-fix", "coverage-min"};
  EXPECT_EQ(closest_name("coverge-fix", problems), "coverage-fix");
  EXPECT_EQ(closest_name("overlap-fix", problems), "coverage-overlap-fix") << "its end";
  EXPECT_EQ(closest_name("fix", problems), "coverage-fix");
  EXPECT_EQ(closest_name("x", problems), "");
  EXPECT_EQ(did_you_mean("coverage_min", problems), "; did you mean coverage-min?");
  EXPECT_EQ(did_you_mean("best", problems), "");
  EXPECT_EQ(did_you_mean("best", {}), "");
}

}  // namespace
}  // namespace vantage
