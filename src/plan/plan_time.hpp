// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>

#include "core/deadline.hpp"
#include "vantage/planner.hpp"

namespace vantage {

// The time limit of a plan. Its search ends early enough for the stages after it, whose time is estimated better once
// stations were counted with every ray.
class PlanTime {
 public:
  PlanTime(double max_seconds, const PlanWatch& given);

  // Returns a watch that also stops at the limits, and reports no longer times than they leave. Its `seconds_after` is
  // always set, and also learns the time of stations. Borrows this.
  PlanWatch watch();
  bool limited() const { return max_seconds_ > 0; }
  double seconds() const;  // without the caller's; 0: no limit
  // True if the clock ended the search.
  bool search_ended() const { return search_by_.passed(); }

 private:
  void learn(std::size_t stations, double seconds_a_station);

  double max_seconds_;
  const PlanWatch& given_;
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  double after_;  // seconds for the caller
  Deadline all_by_, search_by_;
};

}  // namespace vantage
