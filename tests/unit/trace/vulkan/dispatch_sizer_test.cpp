// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/dispatch_sizer.hpp"

#include <gtest/gtest.h>

namespace vantage::vulkan {
namespace {

TEST(DispatchSizer, FollowsTheSpeedSeen) {
  DispatchSizer sizer(0.25, 1000, 100, 500);
  EXPECT_EQ(sizer.rays(), 1000);
  sizer.observe(4000, 0.5);  // 8000 rays per second
  EXPECT_EQ(sizer.rays(), 2000);
  sizer.observe(600, 6);
  EXPECT_EQ(sizer.rays(), 100) << "never fewer than the least";
}

TEST(DispatchSizer, SplitsSlowWorkAndRecovers) {
  constexpr double rays_a_second = 1e4, first = 1e6;
  DispatchSizer sizer(0.25, first, 1, first);
  sizer.observe(first, first / rays_a_second);
  EXPECT_LE(sizer.rays() / rays_a_second, 0.25) << "one was enough";
  // Work other than rays takes long and says nothing about their speed.
  DispatchSizer other(1, first, 1, first);
  for (int k = 0; k < 3; ++k) other.observe(10, 100);
  EXPECT_LT(other.rays(), first / 100);
  const double slow = other.rays();
  other.observe(1, 0.5);  // in time, but not fast enough to ask for more
  EXPECT_EQ(other.rays(), slow);
  for (int k = 0; k < 20; ++k) other.observe(1, 1e-3);
  EXPECT_EQ(other.rays(), first);
}

TEST(DispatchSizer, GrowsByStepsFromAFewRays) {
  DispatchSizer sizer(0.25, 1e6, 1, 1e9);
  double last = sizer.rays();
  for (int k = 0; k < 4; ++k, last = sizer.rays()) {
    sizer.observe(sizer.rays(), sizer.rays() / 1e10);
    EXPECT_GT(sizer.rays(), last);
    EXPECT_LE(sizer.rays(), 8 * last);
  }
  EXPECT_DOUBLE_EQ(sizer.rays(), 2.5e9);
}

TEST(DispatchSizer, IgnoresUninformativeSubmissions) {
  DispatchSizer sizer(1, 1000, 0, 500);
  sizer.observe(499, 1e-3);
  EXPECT_EQ(sizer.rays(), 1000);
  sizer.observe(5000, 0);  // a clock that stands still
  EXPECT_EQ(sizer.rays(), 1000);
}

}  // namespace
}  // namespace vantage::vulkan
