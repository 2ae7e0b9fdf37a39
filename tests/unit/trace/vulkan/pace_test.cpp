// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/pace.hpp"

#include <gtest/gtest.h>

namespace vantage::vulkan {
namespace {

TEST(Pace, FollowsTheSpeedSeen) {
  Pace pace(0.25, 1000, 100, 500);
  EXPECT_EQ(pace.rays(), 1000);
  pace.saw(4000, 0.5);  // 8000 rays a second
  EXPECT_EQ(pace.rays(), 2000);
  pace.saw(600, 6);
  EXPECT_EQ(pace.rays(), 100) << "never fewer than the least";
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
