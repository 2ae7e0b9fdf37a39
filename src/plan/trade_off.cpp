// SPDX-License-Identifier: Apache-2.0
#include "plan/trade_off.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "core/parallel.hpp"
#include "cover/connected_growth.hpp"
#include "cover/network.hpp"
#include "cover/partial_cover.hpp"
#include "cover/swaps.hpp"
#include "plan/what_pays.hpp"

namespace vantage {
namespace {

// Points below the chosen number, and beyond it: up to half as many stations more. Half as many points if there are
// many stations, a quarter if there are hundreds: each takes seconds of swaps and of registration.
constexpr std::size_t kPointsBelow = 10, kPointsBeyond = 4, kManyStations = 100, kHundreds = 300;
constexpr double kBeyondShare = 0.5;
// Most networks tested for whether they pay, and the share of `pays.least_m2` below which a chosen station goes. A
// sample and swaps change the gains of the last stations of large networks a little.
constexpr std::size_t kPointsThatPay = 32;
constexpr double kClearly = 0.8;

// Removes the station with the least loss, of those without which the others are connected as before.
bool drop_one(const CoverProblem& problem, std::vector<std::size_t>& network) {
  const PartialCover cover(problem.matrix, network);
  const NetworkLinks links(problem, network, problem.link);
  const std::size_t parts = links.components().count;
  const std::vector<std::size_t> parts_without = links.trees().without;
  std::size_t least = network.size();
  double lost = std::numeric_limits<double>::infinity();
  for (std::size_t at = problem.existing.size(); at < network.size(); ++at) {
    const double loss = cover.loss(network[at]);
    if (loss >= lost || parts_without[at] > parts) continue;
    lost = loss, least = at;
  }
  if (least == network.size()) return false;
  network = without(network, least);
  return true;
}

}  // namespace

std::vector<std::size_t> trade_off_numbers(std::size_t chosen, std::size_t most) {
  std::vector<std::size_t> numbers;
  const auto add = [&](std::size_t number) {
    if (number >= 1 && number <= most && (numbers.empty() || number > numbers.back())) numbers.push_back(number);
  };
  const std::size_t parts = chosen > kHundreds       ? 4
                            : chosen > kManyStations ? 2
                                                     : 1,
                    below = kPointsBelow / parts, points = kPointsBeyond / parts;
  for (std::size_t k = 0; k < below; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(below);
    add(1 + static_cast<std::size_t>(share * static_cast<double>(chosen - 1)));
  }
  add(chosen);
  const double beyond = std::max(kBeyondShare * static_cast<double>(chosen), static_cast<double>(kPointsBeyond));
  for (std::size_t k = 1; k <= points; ++k)
    add(chosen + static_cast<std::size_t>(beyond * static_cast<double>(k) / static_cast<double>(points)));
  return numbers;
}

std::vector<CoverSolution> trade_off_networks(const FewestChoice& choice, const std::stop_token& unimproved,
                                              const std::stop_token& stop) {
  if (choice.placed() == 0) return {};
  CoverProblem problem = cover_problem(choice);
  problem.coverage = 1;  // as much as there is
  problem.link = choice.asked.link;
  const ColumnIndex columns(problem.matrix);
  const std::size_t existing = choice.asked.existing, visiting = problem.existing.size() - existing;
  const std::vector<std::size_t> numbers = trade_off_numbers(choice.placed(), std::numeric_limits<std::size_t>::max());
  const auto here = std::ranges::find(numbers, choice.placed());
  std::vector<CoverSolution> fewer, networks{evaluate_cover(problem, choice.network.chosen)};
  const auto drop = [&] {
    std::vector<std::size_t> now = choice.network.chosen;
    for (auto number = here; number != numbers.begin() && !stop.stop_requested();) {
      --number;
      bool dropped = true;
      while (dropped && now.size() > existing + *number) dropped = drop_one(problem, now);
      if (!dropped) break;
      now = improve_by_swaps(problem, columns, std::move(now), unimproved);
      fewer.push_back(evaluate_cover(problem, now));
    }
  };
  const auto grow = [&] {
    CoverProblem larger = problem;
    for (auto number = here + 1; number != numbers.end() && !stop.stop_requested(); ++number) {
      larger.most = larger.fewest = *number - visiting;
      CoverSolution more = grow_and_swap(larger, columns, networks.back().chosen, unimproved);
      if (more.chosen.size() == networks.back().chosen.size()) break;
      networks.push_back(std::move(more));
    }
  };
  parallel::beside(grow, drop);
  networks.insert(networks.begin(), std::make_move_iterator(fewer.rbegin()), std::make_move_iterator(fewer.rend()));
  return networks;
}

bool keep_what_pays(FewestChoice& choice, const StationsThatPay& pays, double asked_capture,
                    const std::stop_token& stop) {
  if (!choice.to_visit || choice.asked.minutes || choice.placed() <= pays.stations) return false;
  CoverProblem problem = cover_problem(choice);
  problem.coverage = 1;  // as much as there is
  const ColumnIndex columns(problem.matrix);
  const std::size_t beyond = choice.placed() - pays.stations, each = 1 + (beyond - 1) / kPointsThatPay;
  // Adds the best network for each of several falling numbers of stations.
  std::vector<std::vector<std::size_t>> networks{improve_by_swaps(problem, columns, choice.network.chosen, stop)};
  for (std::size_t left = beyond; left > 0 && !stop.stop_requested();) {
    std::vector<std::size_t> now = networks.back();
    bool dropped = true;
    for (std::size_t k = 0; k < each && left > 0 && dropped; ++k, --left) dropped = drop_one(problem, now);
    if (!dropped) break;
    networks.push_back(improve_by_swaps(problem, columns, std::move(now), stop));
  }
  if (stop.stop_requested()) return false;
  const auto worth_m2 = [&](const std::vector<std::size_t>& network) {
    return surface_m2(problem.matrix, network, choice.to_visit->element_m2) -
           kClearly * pays.least_m2 * static_cast<double>(network.size());
  };
  const auto best = std::ranges::max_element(networks, {}, worth_m2);
  if (best == networks.begin()) return false;
  choice.asked.coverage = std::max(asked_capture, std::min(choice.asked.coverage, problem.matrix.coverage(*best)));
  choice.one_fewer.reset();
  choice.network = evaluate_cover(cover_problem(choice), std::move(*best));
  strengthen(choice, stop);
  return true;
}

bool add_what_pays(FewestChoice& choice, const StationsThatPay& pays, const std::stop_token& stop) {
  if (!choice.to_visit || choice.asked.minutes) return false;
  CoverProblem problem = cover_problem(choice);
  problem.coverage = 1;  // as much as there is
  const CoverageMatrix even = with_even_weights(problem.matrix);
  std::optional<ColumnIndex> columns;
  bool any = false;
  while (choice.placed() < choice.asked.most && !stop.stop_requested()) {
    const FurtherStations more = further_stations(
        {.matrix = even, .graph = problem.graph, .existing = choice.network.chosen, .link = problem.link},
        choice.placed(), choice.to_visit->element_m2);
    if (more.candidates.empty() || more.each_m2 < pays.least_m2) break;
    std::vector<std::size_t> network = choice.network.chosen;
    network.push_back(more.candidates.front());
    if (!columns) columns.emplace(problem.matrix);
    CoverSolution larger =
        evaluate_cover(cover_problem(choice), improve_by_swaps(problem, *columns, std::move(network), stop));
    if (larger.violation > choice.network.violation) break;
    choice.network = std::move(larger);
    choice.one_fewer.reset();
    any = true;
  }
  if (any) choice.asked.coverage = std::max(choice.asked.coverage, choice.network.coverage - choice.margins.coverage);
  return any;
}

void mark_knee(std::vector<TradeOffPoint>& points) {
  if (points.size() < 3) return;
  const auto at = [&](const TradeOffPoint& point) {
    const TradeOffPoint &first = points.front(), &last = points.back();
    const auto share = [](double value, double from, double to) {
      return to > from ? (value - from) / (to - from) : 0;
    };
    const auto stations = [](const TradeOffPoint& p) { return static_cast<double>(p.stations.size()); };
    const auto captured = [](const TradeOffPoint& p) { return p.values.at("capture").value; };
    return share(captured(point), captured(first), captured(last)) -
           share(stations(point), stations(first), stations(last));
  };
  const auto knee = std::ranges::max_element(points, {}, at);
  if (at(*knee) > 0) knee->knee = true;
}

}  // namespace vantage
