// SPDX-License-Identifier: Apache-2.0
#include "core/deadline.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <semaphore>
#include <thread>

namespace vantage {
namespace {

void wait_for(const std::stop_token& token) {
  std::binary_semaphore stopped(0);
  const std::stop_callback call(token, [&] { stopped.release(); });
  stopped.acquire();
}

TEST(Deadline, StopsByTheClock) {
  const Deadline deadline(1e-3, {});
  wait_for(deadline.stop());
  EXPECT_TRUE(deadline.passed());
  EXPECT_EQ(deadline.seconds_left(), 0);
}

TEST(Deadline, FollowsTheOtherToken) {
  std::stop_source user;
  const Deadline limited(1e6, user.get_token()), unlimited(0, user.get_token());
  EXPECT_FALSE(limited.stop().stop_requested());
  EXPECT_GT(limited.seconds_left(), 9e5);
  EXPECT_LE(limited.seconds_left(), 1e6);
  EXPECT_TRUE(std::isinf(unlimited.seconds_left()));
  user.request_stop();
  for (const Deadline* deadline : {&limited, &unlimited}) {
    EXPECT_TRUE(deadline->stop().stop_requested());
    EXPECT_FALSE(deadline->passed());
  }
}

TEST(Deadline, IsMoved) {
  Deadline sooner(1e6, {}), later(0.05, {}), unlimited(0, {});
  sooner.move(1e-3);
  later.move(1e6);
  unlimited.move(1e-3);
  wait_for(sooner.stop());
  EXPECT_TRUE(sooner.passed());
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_FALSE(later.stop().stop_requested());
  EXPECT_GT(later.seconds_left(), 9e5);
  EXPECT_TRUE(std::isinf(unlimited.seconds_left()));
}

}  // namespace
}  // namespace vantage
