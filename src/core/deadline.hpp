// SPDX-License-Identifier: Apache-2.0
// A stop token that follows another token and the clock.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

namespace vantage {

class Deadline {
 public:
  // Stops after `seconds` seconds, or when `stop` does. 0: only when `stop` does.
  Deadline(double seconds, std::stop_token stop);
  Deadline(const Deadline&) = delete;
  Deadline& operator=(const Deadline&) = delete;

  std::stop_token stop() const { return stop_.get_token(); }
  // Returns true if the clock stopped it first.
  bool passed() const { return passed_; }
  // Returns infinity without a limit.
  double seconds_left() const;
  // Ends `seconds` from now instead. Has no effect without a limit, or once it has ended.
  void move(double seconds);

 private:
  using Clock = std::chrono::steady_clock;
  void wait(const std::stop_token& ended);

  Clock::time_point end_;  // max(): none; behind `mutex_`
  std::atomic<bool> passed_ = false;
  std::stop_source stop_;
  std::stop_callback<std::function<void()>> follow_;
  mutable std::mutex mutex_;
  std::condition_variable_any moved_;
  std::jthread clock_;
};

}  // namespace vantage
