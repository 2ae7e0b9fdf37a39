// SPDX-License-Identifier: Apache-2.0
// The order of a round: nearest neighbour, then 2-opt (Croes: A Method for Solving Traveling-Salesman Problems, 1958)
// and Or-opt (Or: Traveling Salesman-Type Combinatorial Problems, 1976).
#include "vantage/on_site.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <utility>

#include "core/first_numbers.hpp"
#include "core/graph.hpp"
#include "core/parallel.hpp"
#include "core/parse.hpp"
#include "core/person.hpp"
#include "core/setting_list.hpp"
#include "core/site_reach.hpp"
#include "core/text.hpp"
#include "evaluate/check_day.hpp"
#include "evaluate/cut_round.hpp"
#include "evaluate/steep_checks.hpp"
#include "evaluate/timed_sessions.hpp"
#include "evaluate/ways.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

void check(const OnSiteOptions& options, const Vec3& origin) {
  check_settings(on_site_settings(), options);
  check_number(options.detour, "detour", {.low = 1, .high = 1000});
  if (options.entrance) require_in_reach(*options.entrance, origin, "the entrance is");
}

// The search area, and ground that is reached and too small to stand on: the treads of stairs.
SearchMesh walked_ground(const SearchArea& area) {
  SearchMesh ground = area.mesh();
  for (const LeftOut& out : area.left_out()) {
    if (out.reason != LeftOutReason::small) continue;
    const auto first = static_cast<std::uint32_t>(ground.positions.size());
    ground.positions.insert(ground.positions.end(), out.positions.begin(), out.positions.end());
    for (const auto& [a, b, c] : out.triangles) ground.triangles.push_back({first + a, first + b, first + c});
  }
  return ground;
}

using Matrix = std::vector<std::vector<double>>;

// A walk from the first point of a matrix to its last, over all others. The matrix is symmetric.
class Walk {
 public:
  explicit Walk(const Matrix& costs) : costs_(costs) {}

  // The round begins as the one to the nearest neighbour, and is improved.
  std::vector<std::size_t> order() {
    const std::size_t n = costs_.size();
    std::vector<bool> seen(n, false);
    order_.assign(1, 0);
    seen[0] = seen[n - 1] = true;
    while (order_.size() + 1 < n) {
      std::size_t next = n;
      for (std::size_t k = 0; k < n; ++k)
        if (!seen[k] && (next == n || costs_[order_.back()][k] < costs_[order_.back()][next])) next = k;
      seen[next] = true;
      order_.push_back(next);
    }
    order_.push_back(n - 1);
    return improved(std::move(order_));
  }

  std::vector<std::size_t> improved(std::vector<std::size_t> order) {
    order_ = std::move(order);
    while (turn_round() || move_elsewhere()) {
    }
    return std::move(order_);
  }

  // Improves it again and again after four parts of it, chosen at random, changed places (Martin, Otto and Felten:
  // Large-Step Markov Chains for the Traveling Salesman Problem, 1991),
  // and calls found(order) for each order on the way.
  template <class Found>
  std::vector<std::size_t> searched(std::vector<std::size_t> best, std::size_t times, Found&& found) {
    best = improved(std::move(best));
    found(best);
    std::mt19937_64 random(best.size());
    for (std::size_t k = 0; k < times && best.size() > 5; ++k) {
      std::array<std::size_t, 3> at{};
      for (std::size_t& one : at) one = 1 + random() % (best.size() - 2);
      std::ranges::sort(at);
      std::vector<std::size_t> changed = best;
      const auto place = [&](std::size_t i) { return changed.begin() + static_cast<std::ptrdiff_t>(i); };
      std::rotate(place(at[0]), place(at[1]), place(at[2]));
      changed = improved(std::move(changed));
      found(changed);
      if (shorter(length(changed), length(best))) best = std::move(changed);
    }
    return best;
  }

  double length(const std::vector<std::size_t>& order) const {
    double sum = 0;
    for (std::size_t k = 0; k + 1 < order.size(); ++k) sum += costs_[order[k]][order[k + 1]];
    return sum;
  }

 private:
  // True if a change gains more than rounding: else the search would not end.
  static bool shorter(double then, double now) {
    constexpr double kGain_m = 1e-9, kGain = 1e-12;
    return then + kGain_m + kGain * now < now;
  }

  double leg(std::size_t at) const { return costs_[order_[at]][order_[at + 1]]; }

  bool turn_round() {
    const std::size_t n = order_.size();
    bool gained = false;
    for (std::size_t i = 0; i + 2 < n; ++i) {
      for (std::size_t j = i + 2; j + 1 < n; ++j) {
        const double now = leg(i) + leg(j);
        const double then = costs_[order_[i]][order_[j]] + costs_[order_[i + 1]][order_[j + 1]];
        if (!shorter(then, now)) continue;
        std::reverse(order_.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                     order_.begin() + static_cast<std::ptrdiff_t>(j) + 1);
        gained = true;
      }
    }
    return gained;
  }

  bool move_elsewhere() {
    const std::size_t n = order_.size();
    bool gained = false;
    for (std::size_t count = 1; count <= 3 && count + 2 < n; ++count)
      for (std::size_t from = 1; from + count < n; ++from) gained = move_elsewhere(from, count) || gained;
    return gained;
  }

  bool move_elsewhere(std::size_t from, std::size_t count) {
    const std::size_t left = order_.size() - count;  // stops without those that move
    const auto rest = [&](std::size_t at) { return order_[at < from ? at : at + count]; };
    const std::size_t before = order_[from - 1], first = order_[from], last = order_[from + count - 1],
                      after = order_[from + count];
    const double taken = costs_[before][first] + costs_[last][after];
    for (std::size_t to = 1; to < left; ++to) {
      const std::size_t a = rest(to - 1), b = rest(to);
      if (!shorter(costs_[a][first] + costs_[last][b] + costs_[before][after], taken + costs_[a][b])) continue;
      const auto at = [&](std::size_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
      if (to < from)
        std::rotate(at(to), at(from), at(from + count));
      else
        std::rotate(at(from), at(from + count), at(to + count));
      return true;
    }
    return false;
  }

  const Matrix& costs_;
  std::vector<std::size_t> order_;
};

// Ways between the stops of a round: stations from `first` on, and last the place where the round began.
struct Stops {
  Matrix metres;
  std::size_t first = 0;  // 1 after an entrance, which is no station
  std::size_t stations() const { return metres.size() - 1 - first; }
};

std::size_t unlinked_in(const std::vector<std::size_t>& order, const Matrix& link, std::size_t first) {
  std::size_t unlinked = 0;
  for (std::size_t k = first; k + 2 < order.size(); ++k)
    if (!(link[order[k] - first][order[k + 1] - first] > 0)) ++unlinked;
  return unlinked;
}

// The shortest order of few stations with at most `unlinked` steps without a link, by dynamic programming over the sets
// of those that were visited (Held and Karp: A Dynamic Programming Approach to Sequencing Problems, 1962); empty if
// there is none.
std::vector<std::size_t> shortest_with(const Stops& round, const Matrix& link, std::size_t unlinked) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const std::size_t n = round.stations(), sets = std::size_t{1} << n, states = sets * n, all = sets - 1;
  // Shortest path to `last` over the stations of `set` with so many unlinked steps, and the stop before.
  std::vector<double> least((unlinked + 1) * states, kNever);
  std::vector<std::uint8_t> before(least.size());
  const auto at = [&](std::size_t steps, std::size_t set, std::size_t last) { return steps * states + set * n + last; };
  const auto metres = [&](std::size_t a, std::size_t b) { return round.metres[a + round.first][b + round.first]; };
  if (round.first == 0) {
    least[at(0, 1, 0)] = 0;  // the round begins at the first station
  } else {
    for (std::size_t k = 0; k < n; ++k) least[at(0, std::size_t{1} << k, k)] = round.metres[0][k + round.first];
  }
  for (std::size_t set = 1; set < sets; ++set)
    for (std::size_t steps = 0; steps <= unlinked; ++steps)
      for (std::size_t last = 0; last < n; ++last) {
        const double here = least[at(steps, set, last)];
        if (here == kNever) continue;
        for (std::size_t next = 0; next < n; ++next) {
          const std::size_t then = steps + (link[last][next] > 0 ? 0 : 1);
          if ((set >> next & 1) != 0 || then > unlinked) continue;
          const std::size_t to = at(then, set | std::size_t{1} << next, next);
          if (const double way = here + metres(last, next); way < least[to])
            least[to] = way, before[to] = static_cast<std::uint8_t>(last);
        }
      }
  std::size_t last = n, steps = 0;
  double shortest = kNever;
  for (std::size_t s = 0; s <= unlinked; ++s)
    for (std::size_t k = 0; k < n; ++k)
      if (const double way = least[at(s, all, k)] + metres(k, n); way < shortest) shortest = way, last = k, steps = s;
  if (last == n) return {};
  std::vector<std::size_t> order{n + round.first};
  for (std::size_t set = all; set != 0;) {
    order.push_back(last + round.first);
    const std::size_t previous = before[at(steps, set, last)];
    set &= ~(std::size_t{1} << last);
    if (set == 0) break;
    if (!(link[previous][last] > 0)) --steps;
    last = previous;
  }
  if (round.first > 0) order.push_back(0);
  std::ranges::reverse(order);
  return order;
}

// Field software registers each scan to the one before, so a step between unlinked stations costs like a long path. The
// search tries several such lengths, and returns the order with the fewest unlinked steps that is not much longer than
// the shortest. `link`: strengths of the stations' links. `most_m`: longest walk that is accepted for links.
std::vector<std::size_t> order_along_links(const Stops& round, std::vector<std::size_t> shortest, const Matrix& link,
                                           double most_m) {
  constexpr double kMostLonger = 1.3;         // of the shortest walk that is found
  constexpr double kStrength = 0.1;           // of the mean leg, for the strongest link instead of the weakest
  constexpr double kWork = 2e6, kMost = 100;  // changes of each order
  const double n = static_cast<double>(round.metres.size());
  const Walk plain(round.metres);
  const double least_m = plain.length(shortest);
  most_m = std::max(least_m, std::min(most_m, kMostLonger * least_m));
  const auto times = static_cast<std::size_t>(std::clamp(kWork / (n * n), 1.0, kMost));
  std::vector<std::size_t> best = shortest, last = std::move(shortest);
  std::size_t unlinked = unlinked_in(best, link, round.first);
  double best_cost = std::numeric_limits<double>::infinity();
  for (double unlinked_m = least_m; unlinked_m > 1e-3 * least_m; unlinked_m /= 2) {
    Matrix costs = round.metres;
    for (std::size_t i = 0; i < round.stations(); ++i)
      for (std::size_t j = 0; j < round.stations(); ++j)
        if (i != j)
          costs[i + round.first][j + round.first] +=
              link[i][j] > 0 ? kStrength * least_m / n * (1 - link[i][j]) : unlinked_m;
    Walk walk(costs);
    last = walk.searched(std::move(last), times, [&](const std::vector<std::size_t>& order) {
      const std::size_t left = unlinked_in(order, link, round.first);
      if (left > unlinked || plain.length(order) > most_m * (1 + 1e-9) + 1e-9) return;
      const double cost = walk.length(order) - unlinked_m * static_cast<double>(left);
      if (left == unlinked && cost >= best_cost) return;
      best = order, best_cost = cost, unlinked = left;
    });
    if (unlinked == 0 && unlinked_m < least_m) break;
  }
  // Every order of few stations is known.
  constexpr std::size_t kFew = 15, kMostUnlinked = 3;
  if (round.stations() > kFew) return best;
  for (std::size_t fewer = 0; fewer < std::min(unlinked, kMostUnlinked); ++fewer)
    if (std::vector<std::size_t> order = shortest_with(round, link, fewer);
        !order.empty() && plain.length(order) <= most_m * (1 + 1e-9) + 1e-9)
      return order;
  return best;
}

// True if both use batteries that fit the same instrument.
bool shared(const BatteryUse& a, const BatteryUse& b) {
  return std::tie(a.instrument, a.battery_min, a.battery_scans) ==
         std::tie(b.instrument, b.battery_min, b.battery_scans);
}

constexpr double kRounding = 1e-9;  // of sums of minutes

}  // namespace

struct OnSite::Impl {
  // A path between two ground points.
  struct Leg {
    double metres = 0;
    bool connected = true;
    std::vector<Vec3> path = {};
  };

  // Data of a scanner that matter on site.
  struct Instrument {
    double scan_min = 0;
    BatteryUse battery = {};  // what is known before a round
  };

  Impl(const SearchArea& area, const ClashChecker& clash, const OnSiteOptions& o, std::vector<Instrument> given,
       const Vec3& centre, WindowsAt rooms)
      : options(o),
        origin(centre),
        windows_at(std::move(rooms)),
        scanners(std::move(given)),
        entered(area.entries().begin(), area.entries().end()),
        ways(walked_ground(area), [clash](const Vec3& a, const Vec3& b) {
          const Vec3 hip{0, 0, person::kHip_m}, knee{0, 0, person::kKnee_m};
          return clash.sees(a + hip, b + hip) && clash.sees(a + knee, b + knee);
        }) {}
  double stay_min(const PlacedStation& station) const {
    return scanners.at(station.setup.scanner).scan_min + options.set_up_min + options.photos_min;
  }
  // `way`: of the search area, if it connects them.
  Leg leg(const Vec3& from, const Vec3& to, const std::optional<double>& way) const {
    const Vec3 apart = to - from;
    return {.metres = way ? *way : options.detour * std::sqrt(dot(apart, apart)), .connected = way.has_value()};
  }
  double walk_min(double metres) const { return metres / options.walking_m_per_s / 60; }

  // Sums by scanner, so that equal stations make a product, without rounding of a sum.
  void stand(Round& round, std::span<const PlacedStation> stations, const std::vector<std::size_t>& at) const {
    std::vector<double> scans(scanners.size());
    for (const std::size_t i : at) scans.at(stations[i].setup.scanner) += 1;
    for (std::size_t k = 0; k < scans.size(); ++k) round.scan_min += scans[k] * scanners[k].scan_min;
    const auto count = static_cast<double>(at.size());
    round.set_up_min = count * options.set_up_min;
    round.photos_min = count * options.photos_min;
    round.minutes = round.scan_min + round.set_up_min + round.photos_min;
  }
  // The stations in their order, and a leg before each and after the last. `wait_min`: before each stay, or none.
  void walk(Round& round, std::span<const PlacedStation> stations, std::vector<std::size_t> order,
            std::vector<Leg> legs, std::span<const double> wait_min = {}) const {
    round.order = std::move(order);
    double minutes = 0;
    for (std::size_t k = 0; k < legs.size(); ++k) {
      minutes += walk_min(legs[k].metres);
      if (k < round.order.size()) {
        if (!wait_min.empty()) minutes += wait_min[k];
        const double stay = stay_min(stations[round.order[k]]);
        round.arrive_min.push_back(minutes), round.stay_min.push_back(stay);
        minutes += stay;
      }
      round.legs_m.push_back(legs[k].metres), round.paths.push_back(std::move(legs[k].path));
      round.walk_m += legs[k].metres;
      if (!legs[k].connected) ++round.unconnected;
    }
    round.walk_min = walk_min(round.walk_m);
    round.minutes += round.walk_min;
    round.batteries = batteries_over(round, stations);
  }
  std::vector<BatteryUse> batteries_over(const Round& round, std::span<const PlacedStation> stations) const;

  struct Part;
  std::vector<DayHours> hours_at(const Vec3& ground) const;
  DayHours day() const;
  TimedStops timed_stops(std::span<const PlacedStation> stations, const Visit& visit, const RoundTimes& times) const;
  std::vector<Part> parts_within(const TimedStops& stops) const;
  RoundTimes times_of(std::span<const PlacedStation> stations, const Visit& visit) const;
  // Sets the minutes that a session waits.
  void wait(Session& session, const Part& part, const std::vector<double>& stay_min,
            const std::vector<Leg>& legs) const;
  // Ground where sessions of a visit begin and end. REQUIRES: a stop.
  Vec3 entrance(std::span<const PlacedStation> stations, const Visit& visit) const {
    return options.entrance.value_or(stations[visit.order.front()].ground);
  }
  Leg leg(const Vec3& from, const Vec3& to) const { return from == to ? Leg() : leg(from, to, ways.between(from, to)); }

  OnSiteOptions options;
  Vec3 origin;  // of the scene
  WindowsAt windows_at;
  std::vector<Instrument> scanners;
  std::vector<Vec3> entered;  // where the search area is entered, as far as is known
  Ways ways;
};

static double minutes_of_scan(const Scanner& scanner) { return scanner.seconds() / 60; }

void check_day(const OnSiteOptions& options, std::span<const Scanner> scanners) {
  if (options.crews > 1 && !options.day_min)
    throw Error(Errc::invalid_argument,
                "crews: only a round that is split is shared by crews; give the length of a day too");
  if (!options.windows.empty() && !options.day_min)
    throw Error(Errc::invalid_argument, "window: hours are kept by the sessions of a day; give its length too");
  if (!options.day_min) return;
  double least_min = std::numeric_limits<double>::infinity();
  for (const Scanner& scanner : scanners) least_min = std::min(least_min, minutes_of_scan(scanner));
  least_min += options.set_up_min + options.photos_min;
  if (*options.day_min < least_min)
    throw Error(Errc::invalid_argument, "day: " + fixed(*options.day_min, 2) +
                                            " min are too short for one station, which takes " + fixed(least_min, 2) +
                                            " min with setting up. Give a longer day");
}

OnSite::OnSite(const SearchArea& area, const ClashChecker& clash, std::span<const Scanner> scanners,
               const OnSiteOptions& options, const Vec3& origin, WindowsAt windows_at) {
  check(options, origin);
  if (scanners.empty()) throw Error(Errc::invalid_argument, "on site: no scanner given");
  std::vector<Impl::Instrument> instruments;
  for (const Scanner& scanner : scanners)
    instruments.push_back({.scan_min = minutes_of_scan(scanner),
                           .battery = {.instrument = instrument_of(scanner),
                                       .battery_min = scanner.battery_min,
                                       .battery_scans = scanner.battery_scans}});
  check_day(options, scanners);
  impl_ = std::make_shared<const Impl>(area, clash, options, std::move(instruments), origin, std::move(windows_at));
}

std::optional<double> OnSite::way_m(const Vec3& from, const Vec3& to) const {
  for (const Vec3& end : {from, to}) require_in_reach(end, impl_->origin, "the end of a way is");
  return impl_->ways.between(from, to);
}
std::vector<Vec3> OnSite::way(const Vec3& from, const Vec3& to) const {
  return way_m(from, to) ? impl_->ways.path(from, to) : std::vector<Vec3>{};
}
std::vector<std::uint8_t> OnSite::longer(std::span<const Vec3> points, std::span<const Way> than) const {
  for (const Vec3& point : points) require_in_reach(point, impl_->origin, "the end of a way is");
  return impl_->ways.longer(points, than);
}
double OnSite::minutes_per_scan(std::uint32_t scanner) const { return impl_->scanners.at(scanner).scan_min; }
const OnSiteOptions& OnSite::options() const noexcept { return impl_->options; }

Visit OnSite::visit(std::span<const PlacedStation> stations, const LinkStrength& link, double most_min) const {
  Visit visit;
  std::vector<Vec3> stops;
  std::vector<std::size_t> station_of;
  const OnSiteOptions& options = impl_->options;
  if (options.entrance) stops.push_back(*options.entrance);
  for (std::size_t i = 0; i < stations.size(); ++i) {
    if (!active(stations[i])) continue;
    require_in_reach(stations[i].ground, impl_->origin, "station " + std::to_string(i + 1) + " stands");
    stops.push_back(stations[i].ground);
    station_of.push_back(i);
  }
  if (station_of.empty()) return visit;
  if (!options.entrance && !impl_->entered.empty()) {
    const auto away = [&](const Vec3& stop) {
      return dot(stop - impl_->entered.front(), stop - impl_->entered.front());
    };
    const auto nearest = std::ranges::min_element(stops, {}, away) - stops.begin();
    std::swap(stops.front(), stops[static_cast<std::size_t>(nearest)]);
    std::swap(station_of.front(), station_of[static_cast<std::size_t>(nearest)]);
  }
  impl_->stand(visit, stations, station_of);
  const double standing_min = visit.minutes;

  const std::size_t n = stops.size();
  Stops round{.metres = Matrix(n + 1, std::vector<double>(n + 1, 0)), .first = options.entrance ? 1u : 0u};
  std::vector<std::vector<bool>> connected(n + 1, std::vector<bool>(n + 1, true));
  const auto ways = impl_->ways.between_all(stops);
  const auto put = [&](std::size_t i, std::size_t j, double metres, bool known) {
    round.metres[i][j] = round.metres[j][i] = metres;
    connected[i][j] = connected[j][i] = known;
  };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      const auto [metres, known, path] = impl_->leg(stops[i], stops[j], ways[i][j]);
      put(i, j, metres, known);
      if (i == 0) put(n, j, metres, known);
    }
  }
  std::vector<std::size_t> order = Walk(round.metres).order();
  if (link) {
    Matrix strengths(station_of.size(), std::vector<double>(station_of.size(), 0));
    for (std::size_t i = 0; i < station_of.size(); ++i)
      for (std::size_t j = 0; j < station_of.size(); ++j)
        if (i != j) strengths[i][j] = std::clamp(link(station_of[i], station_of[j]), 0.0, 1.0);
    order =
        order_along_links(round, std::move(order), strengths, 60 * options.walking_m_per_s * (most_min - standing_min));
    visit.unlinked = unlinked_in(order, strengths, round.first);
  }
  // The scanner is carried out of the site at last, so that the round is the same backwards.
  if (options.entrance && round.metres[0][order[n - 1]] < round.metres[0][order[1]])
    std::reverse(order.begin() + 1, order.end() - 1);

  std::vector<std::size_t> visited;
  for (std::size_t k = round.first; k < n; ++k) visited.push_back(station_of[order[k] - round.first]);
  const std::size_t skipped = 1 - round.first;  // without an entrance there is no way to the first station
  std::vector<Impl::Leg> legs(n + skipped);
  parallel::for_all(std::size_t{0}, n, [&](std::size_t k) {
    const std::size_t a = order[k], b = order[k + 1];
    legs[k + skipped] = {round.metres[a][b], connected[a][b], impl_->ways.path(stops[a], stops[b % n])};
  });
  impl_->walk(visit, stations, std::move(visited), std::move(legs));
  return visit;
}

std::vector<BatteryUse> OnSite::Impl::batteries_over(const Round& round,
                                                     std::span<const PlacedStation> stations) const {
  std::vector<BatteryUse> uses;
  for (const Instrument& one : scanners) {
    const BatteryUse& battery = one.battery;
    const auto same = [&](const BatteryUse& other) { return shared(battery, other); };
    if ((battery.battery_min == 0 && battery.battery_scans == 0) || std::ranges::any_of(uses, same)) continue;
    BatteryUse use = battery;
    const auto empty = [](double used, double lasts) { return lasts > 0 && used > lasts * (1 + kRounding); };
    double on_min = 0, charged_min = 0, scans = 0;  // minutes at which the battery in use was new, and its scans
    for (std::size_t k = 0; k < round.order.size(); ++k) {
      const double stay = round.stay_min[k];
      const bool own = shared(battery, scanners[stations[round.order[k]].setup.scanner].battery);
      if (use.scans > 0) on_min += walk_min(round.legs_m[k]);
      if (own) {
        if (use.scans == 0 || empty(on_min + stay - charged_min, battery.battery_min) ||
            empty(scans + 1, battery.battery_scans))
          ++use.batteries, charged_min = on_min, scans = 0;
        if (empty(on_min + stay - charged_min, battery.battery_min)) {  // a stay that takes several
          const double more = std::ceil(stay / battery.battery_min * (1 - kRounding)) - 1;
          use.batteries += static_cast<std::size_t>(more), charged_min += more * battery.battery_min;
        }
        ++scans, ++use.scans, use.on_min = on_min + stay;
      }
      if (use.scans > 0) on_min += stay;
    }
    if (use.scans == 0) continue;
    use.in_a_day = use.batteries;
    uses.push_back(std::move(use));
  }
  return uses;
}

std::vector<BatteryUse> batteries_of(const Visit& visit) {
  if (visit.sessions.empty()) return visit.batteries;
  std::vector<BatteryUse> all;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> by_day;  // of an instrument, on a day
  for (const Session& session : visit.sessions)
    for (const BatteryUse& use : session.batteries) {
      auto found = std::ranges::find_if(all, [&](const BatteryUse& other) { return shared(use, other); });
      if (found == all.end())
        found = all.insert(all.end(), use), found->in_a_day = 0;
      else
        found->on_min += use.on_min, found->scans += use.scans, found->batteries += use.batteries;
      std::size_t& today = by_day[{static_cast<std::size_t>(found - all.begin()), session.day}];
      today += use.batteries;
      found->in_a_day = std::max(found->in_a_day, today);
    }
  return all;
}

// A session before its legs are known.
struct OnSite::Impl::Part {
  std::vector<std::size_t> stops;  // by their places in the visit
  std::size_t parts = 1;
  bool linked = true;
  double start_min = 0;
  std::vector<double> begin_min = {};  // of the stay at each, minutes after midnight; empty: none waits
};

std::vector<DayHours> OnSite::Impl::hours_at(const Vec3& ground) const {
  std::vector<DayHours> hours;
  if (!options.windows.empty())
    for (const std::size_t k : windows_at(ground))
      hours.push_back({options.windows[k].from_min, options.windows[k].to_min});
  return hours;
}

DayHours OnSite::Impl::day() const { return {options.day_start_min, options.day_start_min + *options.day_min}; }

TimedStops OnSite::Impl::timed_stops(std::span<const PlacedStation> stations, const Visit& visit,
                                     const RoundTimes& times) const {
  const std::size_t n = visit.order.size();
  TimedStops stops{.stay_min = times.stay_min,
                   .walk_min = std::vector<std::vector<double>>(n, std::vector<double>(n, 0)),
                   .out_min = times.out_min,
                   .hours = {},
                   .linked = times.linked};
  std::vector<Vec3> grounds;
  for (const std::size_t station : visit.order) grounds.push_back(stations[station].ground);
  const auto apart = ways.between_all(grounds);
  for (std::size_t a = 0; a < n; ++a) {
    stops.hours.push_back(hours_at(grounds[a]));
    for (std::size_t b = 0; b < n; ++b)
      if (a != b) stops.walk_min[a][b] = walk_min(leg(grounds[a], grounds[b], apart[a][b]).metres);
  }
  return stops;
}

void OnSite::Impl::wait(Session& session, const Part& part, const std::vector<double>& stay_min,
                        const std::vector<Leg>& legs) const {
  constexpr double kRounding_min = 1e-6;
  session.wait_min.assign(part.stops.size(), 0);
  double now = part.start_min;
  for (std::size_t k = 0; k < part.begin_min.size(); ++k) {
    now += walk_min(legs[k].metres);
    if (const double waits = part.begin_min[k] - now; waits > kRounding_min) {
      session.wait_min[k] = waits, session.waiting_min += waits;
      now = part.begin_min[k];
    }
    now += stay_min[part.stops[k]];
  }
  session.minutes += session.waiting_min;
}

// Returns sessions that keep the access windows, then those of the other stations, cut as without windows.
std::vector<OnSite::Impl::Part> OnSite::Impl::parts_within(const TimedStops& stops) const {
  const FilledSessions filled = fill_sessions(stops, day());
  std::vector<Part> parts;
  for (const TimedSession& one : filled.sessions)
    parts.push_back({.stops = one.stops, .start_min = one.start_min, .begin_min = one.begin_min});
  RoundTimes rest;
  for (std::size_t k = 0; k < filled.rest.size(); ++k) {
    const std::size_t stop = filled.rest[k];
    rest.stay_min.push_back(stops.stay_min[stop]), rest.out_min.push_back(stops.out_min[stop]);
    if (k > 0) rest.step_min.push_back(stops.walk_min[filled.rest[k - 1]][stop]);
  }
  if (stops.linked)
    rest.linked = [&](std::size_t a, std::size_t b) { return stops.linked(filled.rest[a], filled.rest[b]); };
  for (const RoundPiece& piece : cut_round(rest, *options.day_min))
    parts.push_back({.stops = {filled.rest.begin() + static_cast<std::ptrdiff_t>(piece.first),
                               filled.rest.begin() + static_cast<std::ptrdiff_t>(piece.end)},
                     .start_min = options.day_start_min});
  // A piece of the rest is linked to stops before it, too.
  const std::size_t n = stops.stay_min.size();
  for (Part& part : parts) {
    if (!stops.linked) break;
    const auto own = [&](std::size_t stop) { return std::ranges::find(part.stops, stop) != part.stops.end(); };
    part.parts = components(part.stops.size(), [&](std::size_t a, std::size_t b) {
                   return stops.linked(part.stops[a], part.stops[b]);
                 }).count;
    part.linked = part.stops.size() == n;
    for (std::size_t other = 0; other < n && !part.linked; ++other)
      part.linked =
          !own(other) && std::ranges::any_of(part.stops, [&](std::size_t s) { return stops.linked(s, other); });
  }
  return parts;
}

RoundTimes OnSite::Impl::times_of(std::span<const PlacedStation> stations, const Visit& visit) const {
  const std::vector<std::size_t>& order = visit.order;
  const Vec3 gate = entrance(stations, visit);
  RoundTimes times;
  times.stay_min = visit.stay_min;
  for (std::size_t k = 0; k < order.size(); ++k) {
    times.out_min.push_back(walk_min(leg(gate, stations[order[k]].ground).metres));
    if (k > 0) times.step_min.push_back(walk_min(visit.legs_m[k]));
  }
  return times;
}

std::vector<Session> OnSite::sessions(std::span<const PlacedStation> stations, const Visit& visit,
                                      const LinkStrength& link) const {
  const OnSiteOptions& options = impl_->options;
  if (!options.day_min || visit.order.empty()) return {};
  const std::vector<std::size_t>& order = visit.order;
  const auto ground = [&](std::size_t k) { return stations[order[k]].ground; };
  const Vec3 entrance = impl_->entrance(stations, visit);
  RoundTimes times = impl_->times_of(stations, visit);
  for (std::size_t k = 0; k < order.size(); ++k)
    if (const double alone = visit.stay_min[k] + 2 * times.out_min[k]; alone > *options.day_min)
      throw Error(Errc::invalid_argument, "day: station " + std::to_string(order[k] + 1) + " takes " + fixed(alone, 2) +
                                              " min from the entrance and back, " + fixed(visit.stay_min[k], 2) +
                                              " of them at the station; a day has " + fixed(*options.day_min, 2) +
                                              ". Give a longer day");
  if (link) times.linked = [&](std::size_t a, std::size_t b) { return link(order[a], order[b]) > 0; };
  std::vector<Impl::Part> parts;
  if (options.windows.empty())
    for (const RoundPiece& piece : cut_round(times, *options.day_min))
      parts.push_back({.stops = first_numbers(piece.end - piece.first, piece.first),
                       .parts = piece.parts,
                       .linked = piece.linked,
                       .start_min = options.day_start_min});
  else
    parts = impl_->parts_within(impl_->timed_stops(stations, visit, times));
  std::vector<Session> sessions;
  for (const Impl::Part& part : parts) {
    Session& session = sessions.emplace_back();
    const std::size_t number = sessions.size() - 1, size = part.stops.size();
    session.day = number / options.crews + 1, session.crew = number % options.crews + 1;
    session.parts = part.parts, session.linked = part.linked, session.start_min = part.start_min;
    std::vector<std::size_t> own;
    for (const std::size_t stop : part.stops) own.push_back(order[stop]);
    for (std::size_t k = 1; k < size && times.linked; ++k)
      if (!times.linked(part.stops[k - 1], part.stops[k])) ++session.unlinked;
    std::vector<Impl::Leg> legs(size + 1);
    parallel::for_all(std::size_t{0}, legs.size(), [&](std::size_t k) {
      const Vec3 from = k == 0 ? entrance : ground(part.stops[k - 1]);
      const Vec3 to = k == size ? entrance : ground(part.stops[k]);
      legs[k] = impl_->leg(from, to);
      if (!(from == to)) legs[k].path = impl_->ways.path(from, to);
    });
    impl_->stand(session, stations, own);
    impl_->wait(session, part, visit.stay_min, legs);
    impl_->walk(session, stations, std::move(own), std::move(legs), session.wait_min);
  }
  return sessions;
}

void OnSite::add_windows(std::span<const PlacedStation> stations, Visit& visit) const {
  visit.closed.clear(), visit.bound = 0;
  const OnSiteOptions& options = impl_->options;
  if (!options.day_min || options.windows.empty()) return;
  const RoundTimes times = impl_->times_of(stations, visit);
  const DayHours day = impl_->day();
  for (std::size_t k = 0; k < visit.order.size(); ++k) {
    const Vec3& ground = stations[visit.order[k]].ground;
    const std::vector<DayHours> hours = impl_->hours_at(ground);
    if (hours.empty()) continue;
    ++visit.bound;
    const double stay = visit.stay_min[k], out = times.out_min[k];
    const TimedStops alone{.stay_min = {stay}, .walk_min = {{0}}, .out_min = {out}, .hours = {hours}};
    if (timed_session(alone, {0}, day)) continue;
    std::string windows;
    for (const std::size_t w : impl_->windows_at(ground))
      windows += (windows.empty() ? "" : " or ") + to_string(options.windows[w]);
    const bool fits = earliest_begin(hours, 0, stay).has_value();
    visit.closed.push_back(
        {.station = visit.order[k],
         .why = "takes " + fixed(stay, 1) + " min within " + windows +
                (fits ? ", and a day from " + clock_text(day.from_min) + " to " + clock_text(day.to_min) + " with " +
                            fixed(out, 1) +
                            " min from the entrance has no such time: begin the day at another time, "
                            "make it longer or the window wider"
                      : ", which is shorter: make the window wider")});
  }
}

}  // namespace vantage
