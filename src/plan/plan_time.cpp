// SPDX-License-Identifier: Apache-2.0
#include "plan/plan_time.hpp"

#include <algorithm>

#include "core/seconds_since.hpp"

namespace vantage {
namespace {

// Share of the time until the search ends, before it is known how long every ray of the results takes.
constexpr double kSearchTimeShare = 0.8;
// After the search the answer may be counted twice, as a network and with its targets, 1.5 times as slowly each.
constexpr double kCountsAfterSearch = 3;
// Least share of the time for the search and its results, however long the caller's own work takes.
constexpr double kLeastTimeShare = 0.5;
constexpr double kMoment_s = 1e-9;  // 0 would be no limit

double seconds_after(const PlanWatch& watch, std::size_t stations, double seconds_a_station, double max_seconds) {
  if (max_seconds <= 0 || !watch.seconds_after) return 0;
  return std::clamp(watch.seconds_after(stations, seconds_a_station), 0.0, (1 - kLeastTimeShare) * max_seconds);
}

}  // namespace

PlanTime::PlanTime(double max_seconds, const PlanWatch& given)
    : max_seconds_(max_seconds),
      given_(given),
      after_(seconds_after(given, 0, 0, max_seconds)),
      all_by_(seconds(), given.abort),
      search_by_(kSearchTimeShare * seconds(), given.stop) {}

double PlanTime::seconds() const { return limited() ? std::max(max_seconds_ - after_, kMoment_s) : 0; }

PlanWatch PlanTime::watch() {
  PlanWatch own{.stop = search_by_.stop(), .abort = all_by_.stop()};
  own.seconds_after = [this](std::size_t stations, double seconds_a_station) {
    learn(stations, seconds_a_station);
    return after_;
  };
  if (given_.report) {
    own.report = [this](const PlanProgress& now) {
      PlanProgress told = now;
      const Deadline& end = now.phase == "confirm" ? all_by_ : search_by_;
      told.seconds_left = std::min(now.seconds_left, end.seconds_left());
      if (now.whole_seconds_left) told.whole_seconds_left = std::min(*now.whole_seconds_left, all_by_.seconds_left());
      given_.report(told);
    };
  }
  return own;
}

void PlanTime::learn(std::size_t stations, double seconds_a_station) {
  if (!limited()) return;
  after_ = seconds_after(given_, stations, seconds_a_station, max_seconds_);
  const double left = max_seconds_ - seconds_since(begun_) - after_;
  all_by_.move(left);
  const double counted = kCountsAfterSearch * static_cast<double>(stations) * seconds_a_station;
  const double share = kSearchTimeShare * seconds() - seconds_since(begun_);
  search_by_.move(std::min(share, left - counted));
}

}  // namespace vantage
