// SPDX-License-Identifier: Apache-2.0
#include "evaluate/timed_sessions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <random>

#include "evaluate/cut_round.hpp"

namespace vantage {
namespace {

// A small network in whole minutes, so that the reference below can try every minute.
struct Town {
  TimedStops stops;
  DayHours day;
};

Town town_of(std::mt19937& random) {
  const auto number = [&](int low, int high) {
    return static_cast<double>(low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1)));
  };
  const std::size_t n = 1 + random() % 5;
  Town town{.stops = {}, .day = {number(0, 20), 0}};
  town.day.to_min = town.day.from_min + number(20, 60);
  std::vector<std::array<double, 2>> places;
  for (std::size_t k = 0; k < n; ++k) places.push_back({number(-4, 4), number(-4, 4)});
  const auto walk = [](double x, double y) { return std::abs(x) + std::abs(y); };  // along streets
  for (std::size_t a = 0; a < n; ++a) {
    town.stops.stay_min.push_back(number(2, 8));
    town.stops.out_min.push_back(walk(places[a][0], places[a][1]));
    std::vector<double>& row = town.stops.walk_min.emplace_back();
    for (std::size_t b = 0; b < n; ++b) row.push_back(walk(places[a][0] - places[b][0], places[a][1] - places[b][1]));
    std::vector<DayHours>& hours = town.stops.hours.emplace_back();
    for (std::size_t many = random() % 3; many > 0; --many) {
      const double from = number(0, 70);
      hours.push_back({from, from + number(4, 25)});
    }
  }
  return town;
}

// True if a single one of the hours contains each minute of a stay, tested minute by minute.
bool open_for(const std::vector<DayHours>& hours, double begin, double stay) {
  return hours.empty() || std::ranges::any_of(hours, [&](const DayHours& one) {
           for (double t = begin; t < begin + stay; ++t)
             if (t < one.from_min || t + 1 > one.to_min) return false;
           return true;
         });
}

// Fewest minutes of a session in this order, by trying every minute to leave at and waiting where doors are closed.
double fewest_minutes(const Town& town, const std::vector<std::size_t>& order) {
  double fewest = std::numeric_limits<double>::infinity();
  for (double start = town.day.from_min; start <= town.day.to_min; ++start) {
    double now = start + town.stops.out_min[order[0]];
    for (std::size_t k = 0; k < order.size() && now <= town.day.to_min; ++k) {
      if (k > 0) now += town.stops.walk_min[order[k - 1]][order[k]];
      while (now <= town.day.to_min && !open_for(town.stops.hours[order[k]], now, town.stops.stay_min[order[k]])) ++now;
      now += town.stops.stay_min[order[k]];
    }
    now += town.stops.out_min[order.back()];
    if (now <= town.day.to_min) fewest = std::min(fewest, now - start);
  }
  return fewest;
}

struct Reference {
  std::size_t sessions = 0;
  double minutes = 0;
  bool operator<(const Reference& other) const {
    return std::pair(sessions, minutes) < std::pair(other.sessions, other.minutes);
  }
};

// The fewest sessions over the stops, then the fewest minutes, of all orders and all ways to share them.
Reference best_of_all(const Town& town, std::vector<std::size_t> stops) {
  std::ranges::sort(stops);  // the first of the permutations
  const std::size_t n = stops.size();
  std::vector<double> minutes(std::size_t{1} << n, std::numeric_limits<double>::infinity());
  for (std::size_t set = 1; set < minutes.size(); ++set) {
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < n; ++k)
      if (set >> k & 1) order.push_back(stops[k]);
    do minutes[set] = std::min(minutes[set], fewest_minutes(town, order));
    while (std::ranges::next_permutation(order).found);
  }
  std::vector<Reference> best(minutes.size(), {n + 1, 0});
  best[0] = {};
  for (std::size_t set = 1; set < best.size(); ++set)
    for (std::size_t one = set; one > 0; one = (one - 1) & set)
      if (minutes[one] < std::numeric_limits<double>::infinity())
        best[set] =
            std::min(best[set], Reference{best[set ^ one].sessions + 1, best[set ^ one].minutes + minutes[one]});
  return best.back();
}

// No session of the other list may end later, begin earlier or stay longer than it may.
void expect_kept(const Town& town, const TimedSession& one) {
  constexpr double kSame = 1e-9;
  ASSERT_EQ(one.begin_min.size(), one.stops.size());
  EXPECT_GE(one.start_min, town.day.from_min - kSame);
  EXPECT_LE(one.end_min, town.day.to_min + kSame);
  double now = one.start_min;
  for (std::size_t k = 0; k < one.stops.size(); ++k) {
    const std::size_t stop = one.stops[k];
    now += k == 0 ? town.stops.out_min[stop] : town.stops.walk_min[one.stops[k - 1]][stop];
    EXPECT_GE(one.begin_min[k], now - kSame) << "nobody is in two places";
    EXPECT_TRUE(open_for(town.stops.hours[stop], one.begin_min[k], town.stops.stay_min[stop])) << one.begin_min[k];
    now = one.begin_min[k] + town.stops.stay_min[stop];
  }
  EXPECT_NEAR(one.end_min, now + town.stops.out_min[one.stops.back()], kSame);
}

TEST(TimedSessions, AreAsShortAsEveryMinuteThatIsTriedInTheirOrder) {
  std::mt19937 random(3);
  int possible = 0, waited = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const Town town = town_of(random);
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < town.stops.stay_min.size(); ++k) order.push_back(k);
    std::ranges::shuffle(order, random);
    const double fewest = fewest_minutes(town, order);
    const auto found = timed_session(town.stops, order, town.day);
    ASSERT_EQ(found.has_value(), fewest < std::numeric_limits<double>::infinity()) << trial;
    if (!found) continue;
    expect_kept(town, *found);
    double busy = town.stops.out_min[order.front()] + town.stops.out_min[order.back()];
    for (std::size_t k = 0; k < order.size(); ++k)
      busy += town.stops.stay_min[order[k]] + (k > 0 ? town.stops.walk_min[order[k - 1]][order[k]] : 0);
    EXPECT_GE(found->end_min - found->start_min, busy - 1e-9);
    // Several hours of one stop may make a later end shorter; one may not.
    if (std::ranges::none_of(town.stops.hours, [](const auto& hours) { return hours.size() > 1; })) {
      EXPECT_NEAR(found->end_min - found->start_min, fewest, 1e-9) << trial;
    }
    ++possible, waited += fewest > busy;
  }
  EXPECT_GT(possible, 200);
  EXPECT_GT(waited, 20);
}

TEST(TimedSessions, KeepTheirHoursAndTakeLittleMoreThanTheBestOfAll) {
  // Upper limits on the minutes, relative to the best of all sessions, waiting included.
  constexpr double kMostMinutes = 1.5, kMeanMinutes = 1.02;
  std::mt19937 random(11);
  int bound_trials = 0, more_sessions = 0, alone = 0;
  double sum = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const Town town = town_of(random);
    std::vector<std::size_t> bound, free;
    for (std::size_t k = 0; k < town.stops.stay_min.size(); ++k) {
      const bool possible = fewest_minutes(town, {k}) < std::numeric_limits<double>::infinity();
      if (!town.stops.hours[k].empty()) {
        if (possible) bound.push_back(k);
        alone += possible ? 0 : 1;
      } else if (possible) {
        free.push_back(k);
      }
    }
    const FilledSessions filled = fill_sessions(town.stops, town.day);
    std::vector<std::size_t> visited, unbound = filled.rest;
    for (const TimedSession& one : filled.sessions) {
      expect_kept(town, one);
      for (const std::size_t stop : one.stops) (town.stops.hours[stop].empty() ? unbound : visited).push_back(stop);
    }
    std::ranges::sort(visited), std::ranges::sort(unbound);
    EXPECT_EQ(visited, bound) << trial << ": every stop whose hours can be kept, once";
    std::erase_if(unbound, [&](std::size_t stop) { return std::ranges::find(free, stop) == free.end(); });
    EXPECT_EQ(unbound, free) << trial;
    if (bound.empty()) {
      EXPECT_TRUE(filled.sessions.empty());
      continue;
    }
    // The remaining stops are cut as a round.
    RoundTimes rest;
    std::vector<std::size_t> left = filled.rest;
    std::erase_if(left, [&](std::size_t stop) { return std::ranges::find(free, stop) == free.end(); });
    for (std::size_t k = 0; k < left.size(); ++k) {
      rest.stay_min.push_back(town.stops.stay_min[left[k]]), rest.out_min.push_back(town.stops.out_min[left[k]]);
      if (k > 0) rest.step_min.push_back(town.stops.walk_min[left[k - 1]][left[k]]);
    }
    Reference made{filled.sessions.size(), 0};
    for (const TimedSession& one : filled.sessions) made.minutes += one.end_min - one.start_min;
    for (const RoundPiece& piece : cut_round(rest, town.day.to_min - town.day.from_min))
      ++made.sessions, made.minutes += piece.minutes;
    std::vector<std::size_t> all = bound;
    all.insert(all.end(), free.begin(), free.end());
    const Reference best = best_of_all(town, all);
    ASSERT_LE(best.sessions, made.sessions) << trial << ": the reference tries everything";
    EXPECT_LE(made.sessions, best.sessions + 1) << trial;
    ++bound_trials, more_sessions += made.sessions > best.sessions;
    if (made.sessions > best.sessions) continue;
    EXPECT_GE(made.minutes, best.minutes - 1e-9) << trial;
    EXPECT_LE(made.minutes, kMostMinutes * best.minutes) << trial;
    sum += made.minutes / best.minutes;
  }
  EXPECT_GT(bound_trials, 500);
  EXPECT_GT(alone, 100) << "hours that no day keeps are there, too";
  EXPECT_LE(more_sessions, bound_trials / 50);
  EXPECT_LE(sum / (bound_trials - more_sessions), kMeanMinutes);
}

TEST(TimedSessions, HoursGoOverMidnightAndComeAgainEveryDay) {
  const std::vector<DayHours> night{{22 * 60, 2 * 60}}, whole{{0, 24 * 60}}, early{{6 * 60, 8 * 60}};
  EXPECT_EQ(earliest_begin(night, 20 * 60, 30), 22 * 60);
  EXPECT_EQ(earliest_begin(night, 23 * 60, 30), 23 * 60);
  EXPECT_EQ(earliest_begin(night, 60, 30), 60) << "of the evening before";
  EXPECT_EQ(earliest_begin(night, 25 * 60 + 50, 30), 46 * 60) << "ten minutes are too few: the next evening";
  EXPECT_EQ(earliest_begin(whole, 23 * 60 + 50, 30), 23 * 60 + 50);
  EXPECT_EQ(earliest_begin(early, 9 * 60, 30), 30 * 60);
  EXPECT_FALSE(earliest_begin(early, 0, 121));
  EXPECT_EQ(earliest_begin(early, 0, 120), 6 * 60);
  EXPECT_EQ(earliest_begin({}, 77, 30), 77);
  // A night's day: two stops an hour apart, of which one is open before midnight.
  const TimedStops stops{.stay_min = {30, 30},
                         .walk_min = {{0, 60}, {60, 0}},
                         .out_min = {10, 10},
                         .hours = {{{22 * 60, 23 * 60}}, {{1 * 60, 2 * 60}}}};
  const auto session = timed_session(stops, {0, 1}, {20 * 60, 28 * 60});
  ASSERT_TRUE(session);
  EXPECT_EQ(session->begin_min, (std::vector<double>{22.5 * 60, 25 * 60}));
  EXPECT_EQ(session->start_min, 22.5 * 60 - 10);
  EXPECT_EQ(session->end_min, 25.5 * 60 + 10);
  EXPECT_FALSE(timed_session(stops, {1, 0}, {20 * 60, 28 * 60}));
}

}  // namespace
}  // namespace vantage
