// SPDX-License-Identifier: Apache-2.0
#include "plan/fewest_choice.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "cover/partial_cover.hpp"
#include "plan/limits.hpp"

namespace vantage {
namespace {

// Candidates that are traced even after the time is over: a connected network is worth more than one chosen from many.
constexpr std::size_t kLateCandidates = 96;
// Further candidates around each chosen station.
constexpr std::size_t kAround = 8;
// Length of the second short list, in multiples of the first.
constexpr std::size_t kLongerList = 4;

void stronger(FewestChoice& choice, const std::stop_token& stop) {
  choice.network = improve_weakest_link(cover_problem(choice), std::move(choice.network), stop);
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

// Candidates that may improve the network, in ascending order: the network itself, the best one of a station fewer, and
// `times` the usual numbers of the best replacements and additions.
std::vector<std::size_t> short_list(const FewestChoice& choice, std::size_t times) {
  const CoverageMatrix& matrix = choice.table.matrix();
  const std::vector<std::size_t>& chosen = choice.network.chosen;
  std::vector<char> listed(matrix.candidates(), 0);
  // One after the other: those with the largest gains at first are near each other.
  for (const std::size_t k :
       greedy({.matrix = matrix, .graph = &choice.table.graph(), .existing = chosen, .most = times * kBestAdditions}))
    listed[k] = 1;
  const ColumnIndex columns(matrix);
  const PartialCover cover(matrix, chosen);
  std::vector<double> gains(matrix.candidates());
  for (std::size_t k = 0; k < gains.size(); ++k) gains[k] = cover.gain(k);
  std::vector<std::size_t> order(gains.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t at = choice.asked.existing; at < chosen.size(); ++at) {
    std::vector<double> without = gains;
    columns.add_gains_without(chosen[at], cover, without);
    std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t k) { return without[k]; });
    for (std::size_t i = 0; i < std::min(times * kBestReplacements, order.size()); ++i) listed[order[i]] = 1;
  }
  if (choice.one_fewer)
    for (const std::size_t k : choice.one_fewer->chosen) listed[k] = 1;
  std::vector<std::size_t> list;
  for (std::size_t k = choice.asked.existing; k < listed.size(); ++k)
    if (listed[k]) list.push_back(k);
  return list;
}

}  // namespace

FewestAsked fewest_asked(const SurveyProblem& problem) {
  const auto least = [&](Objective::Kind kind) {
    return std::max(0.0, limit_of(problem, kind, Requirement::Bound::at_least).value_or(0));
  };
  return {.existing = problem.kept.size(),
          .fewest = problem.stations_min,
          .most = problem.stations_max,
          .coverage = least(Objective::Kind::coverage),
          .link = least(Objective::Kind::link),
          .apart_m = least(Objective::Kind::distance),
          .minutes = limit_of(problem, Objective::Kind::time, Requirement::Bound::at_most)};
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

CoverProblem cover_problem(const FewestAsked& asked, const CandidateTable& table, const Margins& margins) {
  std::vector<std::size_t> existing(asked.existing);
  std::iota(existing.begin(), existing.end(), std::size_t{0});
  return {.matrix = table.matrix(),
          .graph = &table.graph(),
          .existing = std::move(existing),
          .fewest = asked.fewest,
          .most = asked.most,
          .coverage = asked.coverage + (asked.coverage > 0 ? margins.coverage : 0),
          .link = asked.link > 0 ? asked.link + margins.link : 0};
}

void look(CandidateTable& table, std::span<const PlacedStation> existing, std::span<const PlacedStation> candidates,
          const CoverageMatrix& known, const Progress& progress, const std::stop_token& abort) {
  const Progress at_once{.report = {}, .stop = abort};
  // Existing stations come first in every network, so they are traced even if time is short.
  if (!existing.empty()) table.add(existing, at_once);
  if (progress.stopped() || abort.stop_requested())
    table.add(candidates.first(std::min(candidates.size(), kLateCandidates)), known, at_once);
  else
    table.add(candidates, known, progress);
}

void choose_from(FewestChoice& choice, std::optional<CoverSolution> start, std::stop_token stop) {
  ConnectedCover found = min_connected_cover(cover_problem(choice), std::move(stop), std::move(start));
  choice.network = std::move(found.best), choice.one_fewer = std::move(found.one_fewer);
}

void choose(FewestChoice& choice, const VisitTime& visit, std::stop_token stop) {
  choose_from(choice, {}, stop);
  fit_time(choice, visit, stop);
  stronger(choice, stop);
}

void refine_around(FewestChoice& choice, const PlacementOracle& oracle, double radius_m, const Progress& progress) {
  std::vector<PlacedStation> around;
  const auto add_around = [&](const CoverSolution& network) {
    const auto more = positions_around(oracle, choice.placed_of(network), kAround, radius_m);
    around.insert(around.end(), more.begin(), more.end());
  };
  add_around(choice.network);
  if (choice.one_fewer) add_around(*choice.one_fewer);
  choice.table.add(around, progress);
  if (choice.one_fewer) {
    CoverProblem fewer = cover_problem(choice);
    fewer.most = std::min(fewer.most, choice.one_fewer->chosen.size() - choice.asked.existing);
    choice.one_fewer = improve_weakest_link(fewer, std::move(*choice.one_fewer), progress.stop);
    if (choice.one_fewer->violation <= choice.network.violation)
      choose_from(choice, std::move(choice.one_fewer), progress.stop);
  }
  stronger(choice, progress.stop);
}

std::size_t refine_on_larger_sample(FewestChoice& choice, CandidateTable larger, double coverage_margin,
                                    const Progress& progress, const std::stop_token& abort) {
  const auto stopped = [&] { return progress.stopped() || abort.stop_requested(); };
  const std::vector<PlacedStation>& stations = choice.table.stations();
  const std::size_t existing = choice.asked.existing, none = stations.size();
  if (existing > 0 && !larger.add(std::span(stations).first(existing), {.report = {}, .stop = abort})) return 0;
  std::vector<std::size_t> in_larger(stations.size(), none);  // the number of each candidate there
  std::iota(in_larger.begin(), in_larger.begin() + static_cast<std::ptrdiff_t>(existing), std::size_t{0});
  const Margins margins{.coverage = coverage_margin, .link = choice.margins.link};
  std::size_t traced = 0;
  for (const std::size_t times : {std::size_t{1}, kLongerList}) {
    if (stopped()) break;
    std::vector<PlacedStation> listed;
    for (const std::size_t k : short_list(choice, times)) {
      if (in_larger[k] < none) continue;
      in_larger[k] = larger.stations().size() + listed.size();
      listed.push_back(stations[k]);
    }
    if (!larger.add(listed, progress)) break;
    traced += listed.size();
    std::vector<std::size_t> chosen;
    for (const std::size_t k : choice.network.chosen) chosen.push_back(in_larger[k]);
    const CoverProblem problem = cover_problem(choice.asked, larger, margins);
    ConnectedCover found = min_connected_cover(problem, progress.stop, evaluate_cover(problem, std::move(chosen)));
    if (found.best.violation > choice.network.violation && times < kLongerList && !stopped()) continue;
    choice.table = std::move(larger);
    choice.margins = margins;
    choice.network = std::move(found.best), choice.one_fewer = std::move(found.one_fewer);
    stronger(choice, progress.stop);
    break;
  }
  return traced;
}

}  // namespace vantage
