// SPDX-License-Identifier: Apache-2.0
// Cheapest insertion (Solomon: Algorithms for the Vehicle Routing and Scheduling Problems with Time Window Constraints,
// 1987), from several first stops. A session's start is put off without delay of its end by going backwards from that
// (Savelsbergh: The Vehicle Routing Problem with Time Windows: Minimizing Route Duration, 1992).
#include "evaluate/timed_sessions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace vantage {
namespace {

constexpr double kWholeDay_min = 24 * 60;
constexpr double kRounding_min = 1e-9;  // of sums of a day's minutes

// Calls found(from, to) for the hours of the day before a time, of its day and of the next: a stay that begins at the
// time or next after it is within one of them.
template <class Found>
void for_each_near(const DayHours& hours, double at_min, Found&& found) {
  double length = hours.to_min - hours.from_min;
  if (length <= 0) length += kWholeDay_min;
  const double days = std::floor((at_min - hours.from_min) / kWholeDay_min);
  for (const double day : {days - 1, days, days + 1}) {
    const double from = hours.from_min + day * kWholeDay_min;
    found(from, from + length);
  }
}

bool all_day(const DayHours& hours) { return hours.to_min - hours.from_min >= kWholeDay_min; }

// Greatest begin of a stay that is not after `by_min`; REQUIRES: some stay is before that.
double latest_begin(std::span<const DayHours> hours, double by_min, double stay_min) {
  if (hours.empty()) return by_min;
  double latest = -std::numeric_limits<double>::infinity();
  for (const DayHours& one : hours) {
    if (all_day(one)) return by_min;
    for_each_near(one, by_min, [&](double from, double to) {
      const double begin = std::min(by_min, to - stay_min);
      if (begin >= from - kRounding_min) latest = std::max(latest, begin);
    });
  }
  return latest;
}

// A session that grows by single stops.
class GrowingSession {
 public:
  GrowingSession(const TimedStops& stops, const DayHours& day) : stops_(&stops), day_(day) {}

  // Takes in as many of `some` as it can, each time the one and the place that add the fewest minutes, those first that
  // are linked to a stop in it. They leave `some`.
  void take_in(std::vector<std::size_t>& some) {
    for (;;) {
      std::optional<TimedSession> best;
      std::tuple<bool, double> least;
      std::size_t taken = 0;
      double busy_then = 0;
      for (std::size_t k = 0; k < some.size(); ++k) {
        const bool apart = !now_.stops.empty() && stops_->linked &&
                           std::ranges::none_of(now_.stops, [&](std::size_t s) { return stops_->linked(s, some[k]); });
        if (best && std::tuple(apart, 0.0) > least) continue;
        for (std::size_t at = 0; at <= now_.stops.size(); ++at) {
          // A session is no shorter than its stays and walks, which rules most places out.
          const double busy = busy_min_ + added(some[k], at);
          if (busy > day_.to_min - day_.from_min + kRounding_min) continue;
          if (best && std::tuple(apart, busy) >= least) continue;
          std::vector<std::size_t> order = now_.stops;
          order.insert(order.begin() + static_cast<std::ptrdiff_t>(at), some[k]);
          std::optional<TimedSession> tried = timed_session(*stops_, order, day_);
          if (!tried) continue;
          const std::tuple cost{apart, tried->end_min - tried->start_min};
          if (best && cost >= least) continue;
          least = cost, best = std::move(tried), taken = k, busy_then = busy;
        }
      }
      if (!best) return;
      busy_min_ = busy_then;
      now_ = std::move(*best);
      some.erase(some.begin() + static_cast<std::ptrdiff_t>(taken));
    }
  }
  const TimedSession& now() const { return now_; }

 private:
  // Minutes that a further stop at a place of the order adds, with the ways to it and on.
  double added(std::size_t stop, std::size_t at) const {
    const std::vector<std::size_t>& order = now_.stops;
    const auto leg = [&](std::size_t from) {
      return at < order.size() ? stops_->walk_min[from][order[at]] : stops_->out_min[from];
    };
    if (order.empty()) return stops_->stay_min[stop] + 2 * stops_->out_min[stop];
    if (at == 0) return stops_->stay_min[stop] + stops_->out_min[stop] + leg(stop) - stops_->out_min[order[0]];
    const std::size_t before = order[at - 1];
    return stops_->stay_min[stop] + stops_->walk_min[before][stop] + leg(stop) - leg(before);
  }

  const TimedStops* stops_;
  DayHours day_;
  TimedSession now_;
  double busy_min_ = 0;  // stays and walks
};

}  // namespace

std::optional<double> earliest_begin(std::span<const DayHours> hours, double from_min, double stay_min) {
  if (hours.empty()) return from_min;
  std::optional<double> earliest;
  for (const DayHours& one : hours) {
    if (all_day(one)) return from_min;
    for_each_near(one, from_min, [&](double from, double to) {
      const double begin = std::max(from_min, from);
      if (begin + stay_min <= to + kRounding_min && (!earliest || begin < *earliest)) earliest = begin;
    });
  }
  return earliest;
}

std::optional<TimedSession> timed_session(const TimedStops& stops, const std::vector<std::size_t>& order,
                                          const DayHours& day) {
  TimedSession made{.stops = order, .begin_min = {}, .start_min = day.from_min, .end_min = day.from_min};
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t here = order[k];
    const double walk = k == 0 ? stops.out_min[here] : stops.walk_min[order[k - 1]][here];
    const auto begin = earliest_begin(stops.hours[here], made.end_min + walk, stops.stay_min[here]);
    if (!begin) return std::nullopt;
    made.begin_min.push_back(*begin);
    made.end_min = *begin + stops.stay_min[here];
    if (made.end_min > day.to_min) return std::nullopt;  // what follows takes time, too
  }
  if (order.empty()) return made;
  made.end_min += stops.out_min[order.back()];
  if (made.end_min > day.to_min + kRounding_min) return std::nullopt;
  for (std::size_t k = order.size() - 1; k-- > 0;) {
    const double by = made.begin_min[k + 1] - stops.walk_min[order[k]][order[k + 1]] - stops.stay_min[order[k]];
    made.begin_min[k] = std::max(made.begin_min[k], latest_begin(stops.hours[order[k]], by, stops.stay_min[order[k]]));
  }
  made.start_min = made.begin_min.front() - stops.out_min[order.front()];
  return made;
}

FilledSessions fill_sessions(const TimedStops& stops, const DayHours& day) {
  constexpr std::size_t kMostSeeds = 16;
  FilledSessions filled;
  std::vector<std::size_t> bound;  // stops with hours
  for (std::size_t k = 0; k < stops.stay_min.size(); ++k)
    if (stops.hours[k].empty())
      filled.rest.push_back(k);
    else if (timed_session(stops, {k}, day))
      bound.push_back(k);
  while (!bound.empty()) {
    // More stops with hours are better, then fewer minutes.
    std::optional<std::tuple<std::size_t, double>> least;
    std::optional<GrowingSession> best;
    std::vector<std::size_t> best_left;
    const std::size_t seeds = std::min(kMostSeeds, bound.size());
    for (std::size_t s = 0; s < seeds; ++s) {
      GrowingSession session(stops, day);
      std::vector<std::size_t> seed{bound[s * bound.size() / seeds]}, left = bound;
      std::erase(left, seed.front());
      session.take_in(seed), session.take_in(left);
      const std::tuple cost{left.size(), session.now().end_min - session.now().start_min};
      if (least && cost >= *least) continue;
      least = cost, best = std::move(session), best_left = std::move(left);
    }
    best->take_in(filled.rest);
    filled.sessions.push_back(best->now());
    bound = std::move(best_left);
  }
  return filled;
}

}  // namespace vantage
