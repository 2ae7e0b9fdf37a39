// SPDX-License-Identifier: Apache-2.0
#include "plan/fewest_choice.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

#include "core/first_numbers.hpp"
#include "core/graph.hpp"
#include "core/seconds_since.hpp"
#include "cover/connected_growth.hpp"
#include "cover/network.hpp"
#include "cover/partial_cover.hpp"
#include "evaluate/storey_ties.hpp"
#include "plan/limits.hpp"
#include "plan/what_pays.hpp"

namespace vantage {
namespace {

// Candidates that are traced even after the time is over, and time for more of them. A connected network is worth more
// than one chosen from many candidates, and a large site needs many for one.
constexpr std::size_t kLateCandidates = 96;
constexpr double kLate_s = 2;
// Candidates added around each chosen station, at most and at least, and about how many a round adds in all.
constexpr std::size_t kAround = 8, kLeastAround = 2, kAroundAll = 1400;

// Rounds of `look_along_ways`, candidates that each tries to link, and chosen stations that paths are sought to.
constexpr std::size_t kLooks = 4, kPartsAtOnce = 8, kNearest = 12;
// Candidates added at each end if no path is known, and their radius as a share of the distance.
constexpr std::size_t kAtEnds = 24;
constexpr double kEndsRadius = 0.25;

// Radius within which a station that is in the way gets another place, and candidates added within it.
constexpr double kAside_m = 3;
constexpr std::size_t kAsideAround = 12;

// Least number of stations that `grow_into_reach` may add; a large network may grow by half.
constexpr std::size_t kFurther = 4;

// Most rounds of adding stations to units of floor, or for meshes.
constexpr std::size_t kVisits = 4;
// Further stations, at both ends of a stair, for each tie past it.
constexpr std::size_t kForStair = 2;

// Points that stations leave in each element.
std::vector<double> points_of(const CoverageMatrix& matrix, std::span<const std::size_t> stations) {
  std::vector<double> points(matrix.elements(), 0.0);
  for (const std::size_t station : stations)
    for (const CoverageMatrix::Entry& entry : matrix.column(station)) points[entry.element] += entry.amount;
  return points;
}

double share_of(const AskedOfMeshes& asked, std::span<const double> attainable, std::span<const double> points) {
  double some = 0, all = 0;
  for (std::size_t e = 0; e < points.size(); ++e)
    some += asked.weight[e] * std::min(attainable[e], points[e]), all += asked.weight[e] * attainable[e];
  return all > 0 ? some / all : 1;
}

bool has_what_is_asked(const FewestChoice& choice, std::span<const std::size_t> stations) {
  const std::vector<double> points = points_of(choice.table.matrix(), stations);
  return std::ranges::all_of(choice.of_meshes, [&](const AskedOfMeshes& asked) {
    return share_of(asked, choice.attainable, points) >= asked.share + asked.margin;
  });
}

// Gain that a station adds to a share, up to a factor.
double gain_of(std::span<const CoverageMatrix::Entry> column, const AskedOfMeshes& asked,
               std::span<const double> attainable, std::span<const double> points) {
  double gain = 0;
  for (const CoverageMatrix::Entry& entry : column) {
    const std::size_t e = entry.element;
    if (asked.weight[e] > 0 && points[e] < attainable[e])
      gain += asked.weight[e] * (std::min(attainable[e], points[e] + entry.amount) - points[e]);
  }
  return gain;
}

// Stations with which the network meets the limits of `of_meshes`. Each adds most to the share that lacks most; linked
// ones go first.
std::vector<std::size_t> for_meshes(const FewestChoice& choice) {
  const CoverageMatrix& matrix = choice.table.matrix();
  const StationGraph& graph = choice.table.graph();
  std::vector<std::size_t> all = choice.network.chosen, found;
  std::vector<double> points = points_of(matrix, all);
  const CoverProblem problem = cover_problem(choice);
  Joinable joinable(problem, all);
  std::vector<const AskedOfMeshes*> open;
  for (const AskedOfMeshes& asked : choice.of_meshes) open.push_back(&asked);
  while (!open.empty()) {
    const auto lacks = [&](const AskedOfMeshes* asked) {
      return std::min(asked->share + asked->margin, 1.0) - share_of(*asked, choice.attainable, points);
    };
    const auto worst = std::ranges::max_element(open, {}, lacks);
    if (!(lacks(*worst) > 0)) break;
    std::optional<std::size_t> best;
    double most = 0;
    bool best_linked = false;
    for (std::size_t k = 0; k < matrix.candidates(); ++k) {
      const double gain = gain_of(matrix.column(k), **worst, choice.attainable, points);
      if (!(gain > 0) || (best_linked && gain <= most) || !joinable.may_stand(k)) continue;
      const bool linked = choice.asked.link <= 0 || std::ranges::any_of(all, [&](std::size_t other) {
                            return graph.linked(k, other, choice.asked.link);
                          });
      if (linked == best_linked ? gain > most : linked) best = k, most = gain, best_linked = linked;
    }
    if (!best) {  // nothing can add to it
      open.erase(worst);
      continue;
    }
    for (const CoverageMatrix::Entry& entry : matrix.column(*best)) points[entry.element] += entry.amount;
    joinable.add(*best);
    all.push_back(*best), found.push_back(*best);
  }
  return found;
}

// Finds the most coverage of as many stations as there is time for.
void fit_time(FewestChoice& choice, const VisitTime& visit, const std::stop_token& stop) {
  if (!choice.asked.minutes) return;
  const double limit = *choice.asked.minutes;
  std::size_t placed = choice.placed();
  if (visit.each_min > 0) placed = std::min(placed, static_cast<std::size_t>(std::max(1.0, limit / visit.each_min)));
  const std::size_t fewest = std::max<std::size_t>(choice.asked.fewest, 1);
  for (; visit.minutes(choice.placed_of(choice.network)) > limit && placed >= fewest; --placed) {
    choice.asked.most = placed;
    choice.one_fewer.reset();
    choice.network = min_connected_cover(cover_problem(choice), stop).best;
  }
}

std::size_t ties_past_stairs(const FewestChoice& choice) {
  const std::vector<std::size_t>& chosen = choice.network.chosen;
  return ties_past_stairs(choice.stations_of(choice.network), choice.past_stairs, [&](std::size_t a, std::size_t b) {
    return choice.table.graph().linked(chosen[a], chosen[b], choice.asked.link);
  });
}

bool takes_hardly_more(const FewestChoice& choice, const CoverSolution& before, std::size_t ties) {
  return choice.network.violation <= before.violation &&
         choice.network.chosen.size() <= before.chosen.size() + kForStair * ties;
}

double length_m(std::span<const Vec3> way) {
  double sum = 0;
  for (std::size_t k = 0; k + 1 < way.size(); ++k) {
    const Vec3 leg = way[k + 1] - way[k];
    sum += std::sqrt(dot(leg, leg));
  }
  return sum;
}

// The chosen stations of the component that has most of them; components are those of all candidates. `help`:
// candidates of other components with the largest gains, each after those before it.
struct Unlinked {
  std::vector<std::size_t> network, help;
};
Unlinked unlinked_help(const FewestChoice& choice) {
  const StationGraph& graph = choice.table.graph();
  const Components parts = linked_parts(graph, choice.asked.link);
  std::vector<std::size_t> stations(parts.count, 0);
  for (const std::size_t k : choice.network.chosen) ++stations[parts.of[k]];
  const auto main = static_cast<std::size_t>(std::ranges::max_element(stations) - stations.begin());
  Unlinked found;
  std::ranges::copy_if(choice.network.chosen, std::back_inserter(found.network),
                       [&](std::size_t k) { return parts.of[k] == main; });
  PartialCover cover(choice.table.matrix(), found.network);
  while (found.help.size() < kPartsAtOnce) {
    std::optional<std::size_t> best;
    double most = kLeastHelp;
    for (std::size_t k = 0; k < graph.size(); ++k)
      if (parts.of[k] != main)
        if (const double gain = cover.gain(k); gain >= most) best = k, most = gain;
    if (!best) break;
    cover.add(*best), found.help.push_back(*best);
  }
  return found;
}

// Allowed positions along the shortest path from a candidate to one of the nearest `ends`. If no path is known: around
// the candidate, and around the end that has the largest overlap with it.
std::vector<PlacedStation> on_the_way(const FewestChoice& choice, std::size_t from, std::vector<std::size_t> ends,
                                      const PlacementOracle& oracle) {
  const std::vector<PlacedStation>& stations = choice.table.stations();
  const auto away_m = [&](std::size_t k) {
    const Vec3 apart = stations[k].ground - stations[from].ground;
    return std::sqrt(dot(apart, apart));
  };
  std::ranges::sort(ends, {}, away_m);
  std::vector<Vec3> shortest;
  double least_m = std::numeric_limits<double>::infinity();
  for (const std::size_t end : std::span(ends).first(std::min(ends.size(), kNearest))) {
    std::vector<Vec3> way = choice.way(stations[from].ground, stations[end].ground);
    if (const double metres = length_m(way); !way.empty() && metres < least_m)
      shortest = std::move(way), least_m = metres;
  }
  if (!shortest.empty()) return positions_along(oracle, shortest, kAlong_m);
  const std::size_t nearest =
      *std::ranges::max_element(ends, {}, [&](std::size_t k) { return choice.table.graph().overlap(from, k); });
  const std::array both{stations[from], stations[nearest]};
  return positions_around(oracle, both, kAtEnds, kEndsRadius * away_m(nearest));
}

// True if the network is connected, and captures at least what the former one did without an average station.
bool holds_as_much(const FewestChoice& choice, const CoverSolution& before) {
  const auto placed = static_cast<double>(choice.placed());
  return choice.network.link >= choice.asked.link && choice.network.coverage >= (1 - 1 / placed) * before.coverage;
}

}  // namespace

FewestAsked fewest_asked(const SurveyProblem& problem) {
  const auto least = [&](Objective::Kind kind) {
    return std::max(0.0, limit_of(problem, kind, Requirement::Bound::at_least).value_or(0));
  };
  FewestAsked asked{.existing = problem.existing.size(),
                    .fewest = problem.stations_min,
                    .most = problem.stations_max,
                    .link = least(Objective::Kind::link),
                    .apart_m = least(Objective::Kind::distance),
                    .minutes = limit_of(problem, Objective::Kind::time, Requirement::Bound::at_most)};
  const bool searched = !problem.objectives.empty() && problem.objectives.front().kind == Objective::Kind::coverage;
  asked.captured = std::ranges::any_of(problem.requirements,
                                       [](const Requirement& r) { return requires_capture(r) && r.limit > 0; });
  const double limit = least(Objective::Kind::coverage);
  asked.most_coverage = limit == 0 && searched && asked.fewest == asked.most;
  if (asked.most_coverage) asked.captured = problem.objectives.front().needs.attainable;
  if (asked.captured) asked.whole = problem.attainable.value_or(1);
  asked.coverage = asked.most_coverage ? 1 : std::min(limit / asked.whole, 1.0);
  return asked;
}

std::vector<AskedOfMeshes> asked_of_meshes(const SurveyProblem& problem, const AttainableCounts& attainable,
                                           std::span<const std::uint32_t> weights) {
  std::vector<AskedOfMeshes> all;
  for (const Requirement& requirement : problem.requirements) {
    const Objective& objective = requirement.objective;
    if (objective.meshes.empty() || requirement.bound != Requirement::Bound::at_least) continue;
    const auto of = std::ranges::find(attainable.told_of(), objective.meshes, &AttainableCounts::OfMeshes::meshes);
    AskedOfMeshes& asked = all.emplace_back(AskedOfMeshes{.measure = objective.name, .share = requirement.limit});
    for (std::size_t e = 0; e < weights.size(); ++e) asked.weight.push_back(of->has[e] != 0 ? weights[e] : 0.0);
  }
  return all;
}

std::vector<PlacedStation> FewestChoice::stations_of(const CoverSolution& solution) const {
  std::vector<PlacedStation> stations;
  for (const std::size_t k : solution.chosen) stations.push_back(table.stations()[k]);
  return stations;
}

std::vector<PlacedStation> FewestChoice::placed_of(const CoverSolution& solution) const {
  std::vector<PlacedStation> stations;
  for (std::size_t at = asked.existing; at < solution.chosen.size(); ++at)
    stations.push_back(table.stations()[solution.chosen[at]]);
  return stations;
}

CoverProblem cover_problem(const FewestChoice& choice) {
  const FewestAsked& asked = choice.asked;
  const std::size_t visiting = choice.visiting.size();
  std::vector<std::size_t> existing = first_numbers(asked.existing);
  existing.insert(existing.end(), choice.visiting.begin(), choice.visiting.end());
  return {.matrix = choice.table.matrix(),
          .graph = &choice.table.graph(),
          .existing = std::move(existing),
          .fewest = asked.fewest - std::min(asked.fewest, visiting),
          .most = asked.most - visiting,
          .coverage = asked.coverage + (asked.coverage > 0 ? choice.margins.coverage : 0),
          .link = asked.link,
          .least_help = asked.least_help};
}

void look(CandidateTable& table, std::span<const PlacedStation> existing, std::span<const PlacedStation> candidates,
          const CoverageMatrix& known, const Progress& progress, const std::stop_token& abort) {
  const Progress at_once{.stop = abort};
  // Existing stations come first in every network, so they are traced even if time is short.
  if (!existing.empty()) table.add(existing, at_once);
  const auto begun = std::chrono::steady_clock::now();
  std::size_t first = 0;
  if (!progress.stopped() && !abort.stop_requested()) {
    const std::size_t before = table.stations().size();
    if (table.add(candidates, known, progress)) return;
    first = table.stations().size() - before;
  }
  while (first < candidates.size() && (first < kLateCandidates || seconds_since(begun) < kLate_s)) {
    const std::size_t here = std::min(kLateCandidates, candidates.size() - first);
    if (!table.add(candidates.subspan(first, here), known, at_once, first)) return;
    first += here;
  }
}

void choose_from(FewestChoice& choice, std::optional<CoverSolution> start, std::stop_token stop) {
  if (choice.asked.most_coverage) {
    const CoverProblem problem = cover_problem(choice);
    choice.network =
        grow_and_swap(problem, ColumnIndex(problem.matrix), start ? std::move(start->chosen) : problem.existing, stop);
    return;
  }
  ConnectedCover found = min_connected_cover(cover_problem(choice), std::move(stop), std::move(start));
  choice.network = std::move(found.best), choice.one_fewer = std::move(found.one_fewer);
}

bool out_of_reach(const FewestChoice& choice) { return choice.network.violation > 0 && !choice.asked.most_coverage; }

void choose_anew(FewestChoice& choice, double least_help, const std::stop_token& stop) {
  choice.asked.least_help = least_help;
  choose_from(choice, std::nullopt, stop);
}

void strengthen(FewestChoice& choice, const std::stop_token& stop) {
  if (choice.asked.most_coverage) return;  // coverage alone decides
  const double errors = std::max(kMostLinkErrors - choice.link_errors, 0.0);
  const double enough =
      choice.asked.link + errors * choice.table.overlap_error(choice.network.chosen, choice.asked.link);
  choice.network = improve_weakest_link(cover_problem(choice), std::move(choice.network), enough, stop);
}

void choose(FewestChoice& choice, const VisitTime& visit, std::stop_token stop) {
  choose_from(choice, {}, stop);
  fit_time(choice, visit, stop);
  strengthen(choice, stop);
}

bool grow_into_reach(FewestChoice& choice, const std::stop_token& stop) {
  if (!out_of_reach(choice) || choice.network.link < choice.asked.link || choice.asked.minutes) return false;
  CoverProblem larger = cover_problem(choice);
  const ColumnIndex columns(larger.matrix);
  const std::size_t before = choice.placed(), further = std::max(kFurther, before / 2);
  const std::size_t most = std::min(choice.asked.most, before + further) - choice.visiting.size();
  std::vector<std::size_t> network = choice.network.chosen;
  larger.coverage = 1;  // as much as there is, so that each number is reached
  for (larger.most = before - choice.visiting.size() + 1; larger.most <= most && !stop.stop_requested();
       ++larger.most) {
    larger.fewest = larger.most;
    const std::size_t stations = network.size();
    network = grow_and_swap(larger, columns, std::move(network), stop).chosen;
    if (network.size() == stations) break;
    CoverSolution grown = evaluate_cover(cover_problem(choice), network);
    if (grown.violation > 0) continue;
    choice.network = std::move(grown);
    choice.one_fewer.reset();
    strengthen(choice, stop);
    return true;
  }
  return false;
}

bool look_along_ways(FewestChoice& choice, const PlacementOracle& oracle, const std::stop_token& stop) {
  if (!choice.way || choice.asked.link <= 0) return false;
  const double before = choice.network.violation;
  for (std::size_t k = 0; k < kLooks && out_of_reach(choice) && !stop.stop_requested(); ++k) {
    std::vector<PlacedStation> along;
    const Unlinked unlinked = unlinked_help(choice);
    if (unlinked.network.empty()) break;
    for (const std::size_t part : unlinked.help) {
      const std::vector<PlacedStation> found = on_the_way(choice, part, unlinked.network, oracle);
      along.insert(along.end(), found.begin(), found.end());
    }
    if (along.empty() || !choice.table.add(along, {.stop = stop})) break;
    const double known = choice.network.violation;
    choose_from(choice, choice.network, stop);
    strengthen(choice, stop);
    if (choice.network.violation >= known) break;
  }
  return choice.network.violation < before;
}

namespace {

// Adds stations that stay, and chooses again with them.
void visit(FewestChoice& choice, std::span<const std::size_t> own, const std::stop_token& stop) {
  const CoverProblem before = cover_problem(choice);
  std::vector<std::size_t> network = choice.network.chosen;
  network.insert(network.begin() + static_cast<std::ptrdiff_t>(before.existing.size()), own.begin(), own.end());
  choice.visiting.insert(choice.visiting.end(), own.begin(), own.end());
  choice.one_fewer.reset();
  const std::size_t most = choice.asked.existing + choice.asked.most;
  if (network.size() > most) network.resize(most);
  choose_from(choice, evaluate_cover(cover_problem(choice), std::move(network)), stop);
  strengthen(choice, stop);
}

}  // namespace

bool visit_units(FewestChoice& choice, const std::stop_token& stop) {
  if (!choice.to_visit || choice.asked.minutes) return false;
  const auto& [units, least_m2, element_m2] = *choice.to_visit;
  const std::vector<std::vector<std::size_t>> candidates = units.stations_in(choice.table.stations());
  bool any = false;
  // A station that moves for one unit may leave another one without.
  for (std::size_t k = 0; k < kVisits && !stop.stop_requested(); ++k) {
    std::vector<std::size_t> own = for_empty_units(choice.table.matrix(), &choice.table.graph(), choice.network.chosen,
                                                   candidates, element_m2, least_m2);
    own.resize(std::min(own.size(), choice.asked.most - choice.visiting.size()));
    if (own.empty()) break;
    any = true;
    visit(choice, own, stop);
  }
  return any;
}

bool capture_meshes(FewestChoice& choice, const std::stop_token& stop) {
  std::vector<std::size_t> added;
  // The new choice may drop others that captured some of these meshes.
  for (std::size_t k = 0; k < kVisits && !choice.of_meshes.empty() && !stop.stop_requested(); ++k) {
    std::vector<std::size_t> own = for_meshes(choice);
    own.resize(std::min(own.size(), choice.asked.most - choice.visiting.size()));
    if (own.empty()) break;
    added.insert(added.end(), own.begin(), own.end());
    visit(choice, own, stop);
  }
  for (const std::size_t station : added) {
    if (out_of_reach(choice) || choice.placed() <= choice.asked.fewest) break;
    std::vector<std::size_t> network = choice.network.chosen, visiting = choice.visiting;
    std::erase(network, station), std::erase(visiting, station);
    if (!has_what_is_asked(choice, network)) continue;
    std::swap(choice.visiting, visiting);
    CoverSolution fewer = evaluate_cover(cover_problem(choice), std::move(network));
    if (fewer.violation > 0 || leaves_units(choice, choice.stations_of(choice.network), choice.stations_of(fewer)))
      std::swap(choice.visiting, visiting);
    else
      choice.network = std::move(fewer), choice.one_fewer.reset();
  }
  return !added.empty();
}

namespace {

// The network with another candidate in place of the station at `at`.
CoverSolution with_other(const FewestChoice& choice, std::size_t at, std::size_t other) {
  std::vector<std::size_t> network = choice.network.chosen;
  CoverProblem problem = cover_problem(choice);
  std::ranges::replace(problem.existing, network[at], other);
  network[at] = other;
  return evaluate_cover(problem, std::move(network));
}

// The network with the station at `at` replaced by a candidate nearby that stands well. Among those without more
// violation it takes the one with the largest gain over `others`, the cover of the other stations.
std::optional<CoverSolution> with_one_aside(const FewestChoice& choice, std::size_t at, const PartialCover& others,
                                            const PlacementOracle& oracle) {
  const std::vector<PlacedStation>& stations = choice.table.stations();
  const CoverProblem problem = cover_problem(choice);
  const Joinable joinable(problem, without(choice.network.chosen, at));
  std::vector<std::pair<double, std::size_t>> near;  // by gain, negative
  for (std::size_t k = choice.asked.existing; k < stations.size(); ++k)
    if (const Vec3 apart = stations[k].ground - stations[choice.network.chosen[at]].ground;
        dot(apart, apart) <= kAside_m * kAside_m && joinable.may_stand(k))
      near.emplace_back(-others.gain(k), k);
  std::ranges::sort(near);
  for (const auto& [gain, k] : near) {
    if (oracle.better_aside(stations[k].ground)) continue;
    CoverSolution network = with_other(choice, at, k);
    if (network.violation <= choice.network.violation &&
        !leaves_units(choice, choice.stations_of(choice.network), choice.stations_of(network)))
      return network;
  }
  return std::nullopt;
}

}  // namespace

bool stand_aside(FewestChoice& choice, const PlacementOracle& oracle, const std::stop_token& stop) {
  if (!oracle.better_aside || choice.asked.most_coverage) return false;
  bool any = false;
  for (std::size_t at = choice.asked.existing; at < choice.network.chosen.size() && !stop.stop_requested(); ++at) {
    const std::size_t station = choice.network.chosen[at];
    const PlacedStation placed = choice.table.stations()[station];
    if (!oracle.better_aside(placed.ground)) continue;
    const PartialCover others(choice.table.matrix(), without(choice.network.chosen, at));
    std::optional<CoverSolution> aside = with_one_aside(choice, at, others, oracle);
    if (!aside) {
      std::vector<PlacedStation> around = positions_around(oracle, std::span(&placed, 1), kAsideAround, kAside_m);
      std::erase_if(around, [&](const PlacedStation& one) { return oracle.better_aside(one.ground); });
      if (around.empty() || !choice.table.add(around, {.stop = stop})) continue;
      aside = with_one_aside(choice, at, others, oracle);
    }
    if (!aside) continue;
    std::ranges::replace(choice.visiting, station, aside->chosen[at]);
    choice.network = std::move(*aside);
    any = true;
  }
  return any;
}

bool leaves_units(const FewestChoice& choice, std::span<const PlacedStation> before,
                  std::span<const PlacedStation> after) {
  if (!choice.to_visit) return false;
  const std::vector<std::vector<std::size_t>> had = choice.to_visit->units.stations_in(before),
                                              has = choice.to_visit->units.stations_in(after);
  for (std::size_t unit = 0; unit < had.size(); ++unit)
    if (!had[unit].empty() && has[unit].empty()) return true;
  return false;
}

std::size_t ties_past_stairs(std::span<const PlacedStation> stations, const PastStairs& past_stairs,
                             const std::function<bool(std::size_t, std::size_t)>& linked) {
  const std::size_t all = components(stations.size(), linked).count;
  const Components level = components(stations.size(), [&](std::size_t a, std::size_t b) {
    return !crosses_storeys(stations[a], stations[b]) && linked(a, b);
  });
  if (level.count == all) return 0;
  std::vector<std::pair<std::size_t, std::size_t>> crossing;
  for (std::size_t a = 0; a < stations.size(); ++a)
    for (std::size_t b = a + 1; b < stations.size(); ++b)
      if (level.of[a] != level.of[b] && linked(a, b)) crossing.emplace_back(a, b);
  const std::vector<std::uint8_t> past = past_stairs(stations, crossing);
  std::set<std::pair<std::size_t, std::size_t>> along;
  for (std::size_t k = 0; k < crossing.size(); ++k)
    if (past[k] == 0) along.insert(std::minmax(level.of[crossing[k].first], level.of[crossing[k].second]));
  const auto joined = [&](std::size_t a, std::size_t b) { return along.contains(std::minmax(a, b)); };
  return components(level.count, joined).count - all;
}

bool keep_to_stairs(FewestChoice& choice, const std::stop_token& stop) {
  if (!choice.past_stairs || choice.along_stairs) return false;
  const std::size_t ties = ties_past_stairs(choice);
  if (ties == 0) return false;
  CoverSolution before = choice.network;
  std::optional<CoverSolution> one_fewer = std::move(choice.one_fewer);
  choice.one_fewer.reset();
  choice.table.keep_to_stairs(choice.past_stairs, choice.asked.link);
  CoverSolution now = evaluate_cover(cover_problem(choice), before.chosen);
  const bool any_other = now.link < choice.asked.link;
  if (any_other) {
    choose_from(choice, choice.asked.most_coverage ? std::nullopt : std::optional(std::move(now)), stop);
    strengthen(choice, stop);
    if (choice.asked.most_coverage ? holds_as_much(choice, before) : takes_hardly_more(choice, before, ties)) {
      choice.along_stairs = {.before = std::move(before), .unavoidable = ties_past_stairs(choice)};
      return true;
    }
  }
  choice.table.count_all_links();
  choice.past_stairs = nullptr;
  choice.network = std::move(before), choice.one_fewer = std::move(one_fewer);
  return false;
}

void leave_stairs(FewestChoice& choice, const std::stop_token& stop) {
  choice.table.count_all_links();
  choice.past_stairs = nullptr;
  const CoverProblem problem = cover_problem(choice);
  std::vector<std::size_t> network = problem.existing;  // with stations that units were given since
  for (const std::size_t k : choice.along_stairs->before.chosen)
    if (std::ranges::find(network, k) == network.end()) network.push_back(k);
  choice.along_stairs.reset();
  choose_from(choice, evaluate_cover(problem, std::move(network)), stop);
  strengthen(choice, stop);
}

void refine_around(FewestChoice& choice, const PlacementOracle& oracle, double radius_m, const Progress& progress) {
  std::vector<std::size_t> all = choice.network.chosen;
  if (choice.one_fewer)
    for (const std::size_t k : choice.one_fewer->chosen)
      if (std::ranges::find(all, k) == all.end()) all.push_back(k);
  const std::vector<PlacedStation> stations = choice.placed_of({.chosen = std::move(all)});
  const std::size_t each = std::clamp(kAroundAll / std::max<std::size_t>(stations.size(), 1), kLeastAround, kAround);
  choice.table.add(positions_around(oracle, stations, each, radius_m), progress);
  if (choice.asked.most_coverage) choose_from(choice, std::move(choice.network), progress.stop);
  if (choice.one_fewer) {
    CoverProblem fewer = cover_problem(choice);
    fewer.most = std::min(fewer.most, choice.one_fewer->chosen.size() - fewer.existing.size());
    choice.one_fewer = improve_weakest_link(fewer, std::move(*choice.one_fewer), choice.asked.link, progress.stop);
    if (choice.one_fewer->violation <= choice.network.violation)
      choose_from(choice, std::move(choice.one_fewer), progress.stop);
  }
  strengthen(choice, progress.stop);
}

}  // namespace vantage
