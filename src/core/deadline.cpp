// SPDX-License-Identifier: Apache-2.0
#include "core/deadline.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace vantage {
namespace {

constexpr double kNoLimit_s = 1e9;  // some thirty years: more than the clock could add

}  // namespace

Deadline::Deadline(double seconds, std::stop_token stop)
    : end_(Clock::time_point::max()), follow_(std::move(stop), [this] { stop_.request_stop(); }) {
  if (!(seconds > 0 && seconds < kNoLimit_s)) return;
  end_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  clock_ = std::jthread([this](const std::stop_token& ended) { wait(ended); });
}

double Deadline::seconds_left() const {
  const std::scoped_lock lock(mutex_);
  if (end_ == Clock::time_point::max()) return std::numeric_limits<double>::infinity();
  return std::max(0.0, std::chrono::duration<double>(end_ - Clock::now()).count());
}

void Deadline::move(double seconds) {
  {
    const std::scoped_lock lock(mutex_);
    if (end_ == Clock::time_point::max() || stop_.stop_requested()) return;
    end_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                              std::chrono::duration<double>(std::clamp(seconds, 0.0, kNoLimit_s)));
  }
  moved_.notify_all();
}

void Deadline::wait(const std::stop_token& ended) {
  std::unique_lock lock(mutex_);
  while (!ended.stop_requested() && Clock::now() < end_) {
    const Clock::time_point end = end_;
    moved_.wait_until(lock, ended, end, [&] { return end_ != end; });
  }
  lock.unlock();
  if (ended.stop_requested()) return;
  if (!stop_.stop_requested()) passed_ = true;
  stop_.request_stop();
}

}  // namespace vantage
