// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/pace.hpp"

#include <gtest/gtest.h>

namespace vantage::vulkan {
namespace {

TEST(Pace, FollowsTheSpeedSeen) {
  Pace pace(0.25, 1000, 100, 500);
  EXPECT_EQ(pace.rays(), 1000);
  pace.saw(4000, 0.5);  // 8000 rays per second
  EXPECT_EQ(pace.rays(), 2000);
  pace.saw(600, 6);
  EXPECT_EQ(pace.rays(), 100) << "never fewer than the least";
}

TEST(Pace, SplitsWhatTakesTooLongAndRecovers) {
  constexpr double rays_a_second = 1e4, first = 1e6;
  Pace pace(0.25, first, 1, first);
  pace.saw(first, first / rays_a_second);
  EXPECT_LE(pace.rays() / rays_a_second, 0.25) << "one was enough";
  // Work other than rays takes long and says nothing about their speed.
  Pace other(1, first, 1, first);
  for (int k = 0; k < 3; ++k) other.saw(10, 100);
  EXPECT_LT(other.rays(), first / 100);
  const double slow = other.rays();
  other.saw(1, 0.5);  // in time, but not fast enough to ask for more
  EXPECT_EQ(other.rays(), slow);
  for (int k = 0; k < 20; ++k) other.saw(1, 1e-3);
  EXPECT_EQ(other.rays(), first);
}

TEST(Pace, GrowsByStepsFromAFewRays) {
  Pace pace(0.25, 1e6, 1, 1e9);
  double last = pace.rays();
  for (int k = 0; k < 4; ++k, last = pace.rays()) {
    pace.saw(pace.rays(), pace.rays() / 1e10);
    EXPECT_GT(pace.rays(), last);
    EXPECT_LE(pace.rays(), 8 * last);
  }
  EXPECT_DOUBLE_EQ(pace.rays(), 2.5e9);
}

TEST(Pace, HeedsNothingThatTellsNothing) {
  Pace pace(1, 1000, 0, 500);
  pace.saw(499, 1e-3);
  EXPECT_EQ(pace.rays(), 1000);
  pace.saw(5000, 0);  // a clock that stands still
  EXPECT_EQ(pace.rays(), 1000);
}

}  // namespace
}  // namespace vantage::vulkan
