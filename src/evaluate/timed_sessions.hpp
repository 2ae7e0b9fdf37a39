// SPDX-License-Identifier: Apache-2.0
// Sessions of stops that may be stayed at within some hours of the day alone.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace vantage {

// Minutes after midnight, of every day. An end at or before the start is of the next day; 0 to 1440 is all day.
struct DayHours {
  double from_min = 0, to_min = 0;
};

// Stops of a round, in its order.
struct TimedStops {
  std::vector<double> stay_min;               // at each
  std::vector<std::vector<double>> walk_min;  // between any two
  std::vector<double> out_min;                // between each and the entrance
  std::vector<std::vector<DayHours>> hours;   // of each stop: a stay is within one of them; none: at any time
  std::function<bool(std::size_t, std::size_t)> linked = {};  // two stops; empty: all are
};

// One crew's way from the entrance and back, in minutes after midnight.
struct TimedSession {
  std::vector<std::size_t> stops;
  std::vector<double> begin_min;  // of the stay at each
  double start_min = 0, end_min = 0;
};

// Least begin of a stay that is not before `from_min`; empty: it is longer than the hours.
std::optional<double> earliest_begin(std::span<const DayHours> hours, double from_min, double stay_min);

// A session over the stops in this order that returns as early as possible and, for that, starts as late as possible.
// `day`: minutes after midnight, its end after its start. Empty: the order takes longer, or hours are not kept.
std::optional<TimedSession> timed_session(const TimedStops& stops, const std::vector<std::size_t>& order,
                                          const DayHours& day);

// Returns sessions within a day that keep the hours of all stops which a session of their own could keep. Each takes
// stops with hours first, as many as fit, then others, to reduce waiting. The second list holds the stops without hours
// that no session needs to fill its day; those whose hours cannot be kept are in neither.
struct FilledSessions {
  std::vector<TimedSession> sessions;
  std::vector<std::size_t> rest;  // ascending
};
FilledSessions fill_sessions(const TimedStops& stops, const DayHours& day);

}  // namespace vantage
