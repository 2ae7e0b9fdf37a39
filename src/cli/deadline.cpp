// SPDX-License-Identifier: Apache-2.0
#include "cli/deadline.hpp"

#include <algorithm>

namespace vantage::cli {
namespace {

// What a search leaves to confirmation and cartography, which trace every ray of what it found.
constexpr double kSearchShare = 0.7;
constexpr double kMoment_s = 1e-3;

auto in(double seconds) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

Deadline::Deadline(double seconds, std::stop_token stop, std::stop_token abort)
    : limited_(seconds > 0),
      soft_(Clock::now() + in(kSearchShare * seconds)),
      hard_(Clock::now() + in(seconds)),
      user_stop_(stop, [this] { stop_.request_stop(); }),
      user_abort_(abort, [this] { abort_.request_stop(); }) {
  if (limited_) clock_ = std::jthread([this](std::stop_token done) { wait(done); });
}

Deadline::~Deadline() = default;

void Deadline::wait(std::stop_token done) {
  std::unique_lock lock(mutex_);
  const auto never = [] { return false; };
  changed_.wait_until(lock, done, soft_, never);
  if (done.stop_requested()) return;
  stop_.request_stop();
  changed_.wait_until(lock, done, hard_, never);
  if (!done.stop_requested()) abort_.request_stop();
}

double Deadline::seconds_to_search() const {
  if (!limited_) return 0;
  return std::max(kMoment_s, std::chrono::duration<double>(soft_ - Clock::now()).count());
}

bool Deadline::passed() const { return limited_ && Clock::now() >= soft_; }

}  // namespace vantage::cli
