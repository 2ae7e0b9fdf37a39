// SPDX-License-Identifier: Apache-2.0
// A time limit that holds from the first second over all that a command does.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

namespace vantage::cli {

// Two tokens: one asks for an end after a part of the time, so that what was found can still be confirmed and drawn;
// the other ends that too. Both follow the user's own.
class Deadline {
 public:
  // Seconds from now; 0: no limit.
  Deadline(double seconds, std::stop_token stop, std::stop_token abort);
  ~Deadline();
  Deadline(const Deadline&) = delete;
  Deadline& operator=(const Deadline&) = delete;

  std::stop_token stop() const { return stop_.get_token(); }
  std::stop_token abort() const { return abort_.get_token(); }
  // Of the whole; 0: no limit, and never less than a moment where there is one.
  double seconds_to_search() const;
  // Whether the clock asked for an end, and not the user.
  bool passed() const;

 private:
  using Clock = std::chrono::steady_clock;
  void wait(std::stop_token done);

  bool limited_;
  Clock::time_point soft_, hard_;
  std::stop_source stop_, abort_;
  std::stop_callback<std::function<void()>> user_stop_, user_abort_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::jthread clock_;
};

}  // namespace vantage::cli
