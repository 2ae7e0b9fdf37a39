// SPDX-License-Identifier: Apache-2.0
#include "vantage/bound.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

#include "core/setting_list.hpp"
#include "plan/capture_master.hpp"
#include "plan/choose_on_rows.hpp"
#include "plan/fewest_on_rows.hpp"
#include "plan/row_graph.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

using Rows = std::vector<std::size_t>;

// Of a bound that is rounded up: far below a station, far above rounding.
constexpr double whole = 1e-6;

void check(const CaptureRows& rows, std::span<const std::size_t> fixed) {
  for (const std::size_t k : fixed)
    if (k >= rows.size())
      throw Error(Errc::invalid_argument, "bound: there is no row " + std::to_string(k) + " of " +
                                              std::to_string(rows.size()) + " to be fixed");
  if (rows.size() == 0) throw Error(Errc::invalid_argument, "bound: there are no candidates");
}

std::vector<double> as_shares(const Rows& chosen, std::size_t candidates) {
  std::vector<double> y(candidates);
  for (const std::size_t k : chosen)
    if (k < candidates) y[k] = 1;
  return y;
}

// A choice that comes as near to its bound is the best: branch and bound has tolerances.
constexpr double closed = 1e-5;

// Whether a row may stand beside the taken ones and, with `graph`, leaves the network whole.
MayTake allowed_by(const RowGraph* graph, const ExcludedRows& excluded) {
  if (!graph && excluded.empty()) return {};
  return [graph, &excluded](std::size_t row, std::span<const std::size_t> taken) {
    if (std::ranges::any_of(taken, [&](std::size_t other) { return excluded.exclude(row, other); })) return false;
    if (!graph) return true;
    Rows all(taken.begin(), taken.end());
    all.push_back(row);
    return graph->connected(all);
  };
}

Rows choose_allowed(const CaptureRows& rows, std::size_t stations, std::span<const std::size_t> fixed,
                    const MayTake& may_take, const Progress& progress) {
  return improve_by_swaps(rows, choose_greedily(rows, stations, fixed, 1, may_take), fixed.size(), 1e-9, may_take,
                          progress);
}

ExcludedRows excluded_rows(const CaptureRows& rows, const BoundConfig& config) {
  for (const auto& [a, b] : config.exclude)
    if (a >= rows.size() || b >= rows.size())
      throw Error(Errc::invalid_argument, "bound: rows " + std::to_string(a) + " and " + std::to_string(b) +
                                              " exclude each other, of " + std::to_string(rows.size()));
  return {rows.size(), config.exclude};
}

// A good network of so many rows at most that hangs together; empty where none is met.
Rows choose_linked(const CaptureRows& rows, std::size_t stations, std::span<const std::size_t> fixed,
                   const RowGraph& graph, const ExcludedRows& excluded, const Progress& progress) {
  // Arrays of numbers for a choice that knows fixed rows by standing first.
  Rows order(fixed.begin(), fixed.end());
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (std::ranges::find(fixed, k) == fixed.end()) order.push_back(k);
  CaptureRows sorted(rows.weights(), rows.goal_density());
  std::vector<std::uint32_t> points;
  std::vector<float> overlaps(order.size() * order.size());
  std::vector<char> near(order.size() * order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    points.assign(rows.voxels().size(), 0);
    for (const CapturedVoxel& seen : rows.row(order[k])) points[seen.voxel] = seen.points;
    sorted.add(points);
    for (std::size_t l = 0; l < order.size(); ++l) {
      overlaps[k * order.size() + l] = graph.linked(order[k], order[l]);
      near[k * order.size() + l] = excluded.exclude(order[k], order[l]);
    }
  }
  const PairTable pairs(order.size(), std::move(overlaps), std::move(near));
  const RowAnswer answer = fewest_on_rows({.rows = sorted,
                                           .pairs = pairs,
                                           .coverage = 1,
                                           .link = 1,
                                           .fixed = fixed.size(),
                                           .fewest = stations,
                                           .most = stations},
                                          progress.stop);
  Rows chosen;
  for (const std::size_t k : answer.rows) chosen.push_back(order[k]);
  if (!graph.connected(chosen)) return {};
  return improve_by_swaps(rows, std::move(chosen), fixed.size(), 1e-9, allowed_by(&graph, excluded), progress);
}

// Branch and bound over the cuts, which are added where its choices turn out to hold less than the cuts say, until the
// choice holds what the bound allows.
void branch(CaptureMaster& master, const CaptureRows& rows, std::span<const std::size_t> fixed, const RowGraph* graph,
            const ExcludedRows& excluded, double seconds, CaptureBound& result, const Progress& progress) {
  using Clock = std::chrono::steady_clock;
  const auto begun = Clock::now();
  const MayTake may_take = allowed_by(graph, excluded);
  double reached = result.chosen.empty() ? -1 : RowCover(rows, result.chosen).value();
  while (!progress.stopped() && result.bound - reached > closed) {
    const double left = seconds - std::chrono::duration<double>(Clock::now() - begun).count();
    if (left <= 0) break;
    const CaptureMaster::Choice choice = master.choose(result.stations, left, std::max(reached, 0.0), graph, excluded);
    result.bound = std::min(result.bound, choice.bound);
    if (choice.rows.empty()) break;
    Rows chosen(fixed.begin(), fixed.end());
    chosen.insert(chosen.end(), choice.rows.begin(), choice.rows.end());
    master.cut_at(as_shares(choice.rows, rows.size()));
    chosen = improve_by_swaps(rows, std::move(chosen), fixed.size(), 1e-9, may_take, progress);
    master.cut_at(as_shares({chosen.begin() + static_cast<std::ptrdiff_t>(fixed.size()), chosen.end()}, rows.size()));
    if (const double value = RowCover(rows, chosen).value(); value > reached) {
      reached = value;
      result.chosen = std::move(chosen);
    }
  }
}

// With `graph`, of networks that hang together.
CaptureBound bound_of(const CaptureRows& rows, std::size_t stations, std::span<const std::size_t> fixed,
                      const RowGraph* graph, const BoundConfig& config, const Progress& progress) {
  check(rows, fixed);
  if (stations < 1) throw Error(Errc::invalid_argument, "bound: of how many stations? At least 1");
  CaptureBound result;
  result.stations = stations;
  const Progress silent{{}, progress.stop};
  const ExcludedRows excluded = excluded_rows(rows, config);
  const MayTake may_take = allowed_by(nullptr, excluded);
  result.chosen = graph ? choose_linked(rows, stations, fixed, *graph, excluded, silent)
                        : choose_allowed(rows, stations, fixed, may_take, silent);
  const Rows free(result.chosen.begin() + static_cast<std::ptrdiff_t>(std::min(fixed.size(), result.chosen.size())),
                  result.chosen.end());
  const auto solve = [&](CaptureMaster& master, std::size_t candidates, double from) {
    master.cut_at(as_shares(free, candidates));
    const auto share = [&](double done) { progress(from + 0.5 * done); };
    return master.most(static_cast<double>(stations), config.tolerance, config.max_seconds, {share, progress.stop});
  };
  // The first half of the candidates, as evenly spread as all of them.
  const std::size_t half = std::max<std::size_t>(rows.size() / 2, 1);
  CaptureMaster coarse(rows, half, fixed), master(rows, rows.size(), fixed);
  const Relaxed before = solve(coarse, half, 0), after = solve(master, rows.size(), 0.5);
  result.bound = after.bound;
  result.relaxation = after.reached;
  result.complete = before.complete && after.complete;
  result.half_bound = before.bound;
  result.spacing_term = std::max(after.bound - before.bound, 0.0);
  if (config.exact_seconds > 0) branch(master, rows, fixed, graph, excluded, config.exact_seconds, result, progress);
  result.reached = rows.coverage(result.chosen);
  progress(1);
  return result;
}

}  // namespace

Settings settings(const BoundConfig& config) {
  return SettingList()
      .add("bound_tolerance", config.tolerance)
      .add("bound_max_seconds", config.max_seconds)
      .add("bound_exact_seconds", config.exact_seconds)
      .take();
}

Rows choose_rows(const CaptureRows& rows, std::size_t stations, std::span<const std::size_t> fixed,
                 const Progress& progress) {
  check(rows, fixed);
  return choose_allowed(rows, stations, fixed, {}, progress);
}

CaptureBound bound_capture(const CaptureRows& rows, std::size_t stations, std::span<const std::size_t> fixed,
                           const BoundConfig& config, const Progress& progress) {
  return bound_of(rows, stations, fixed, nullptr, config, progress);
}

CaptureBound bound_linked_capture(const CaptureRows& rows, std::size_t stations, std::span<const RowLink> links,
                                  std::span<const std::size_t> fixed, const BoundConfig& config,
                                  const Progress& progress) {
  if (stations + fixed.size() > max_stations)
    throw Error(Errc::invalid_argument, "bound: " + std::to_string(stations + fixed.size()) +
                                            " stations are asked to hang together, but " +
                                            std::to_string(max_stations) + " is the most of a network");
  for (const auto& [a, b] : links)
    if (a >= rows.size() || b >= rows.size())
      throw Error(Errc::invalid_argument, "bound: a link of rows " + std::to_string(a) + " and " + std::to_string(b) +
                                              ", of which there are " + std::to_string(rows.size()));
  const RowGraph graph(rows.size(), links);
  return bound_of(rows, stations, fixed, &graph, config, progress);
}

StationsBound bound_stations(const CaptureRows& rows, double capture, std::span<const std::size_t> fixed,
                             const BoundConfig& config, const Progress& progress) {
  check(rows, fixed);
  if (!(capture > 0 && capture <= 1))
    throw Error(Errc::invalid_argument,
                "bound: the wanted coverage is " + std::to_string(capture) + ", but must be above 0 and at most 1");
  StationsBound result;
  CaptureMaster master(rows, rows.size(), fixed);
  const Rows greedy = choose_greedily(rows, rows.size(), fixed, capture);
  if (RowCover(rows, greedy).value() >= capture) {
    result.chosen = drop_and_swap(rows, greedy, fixed.size(), capture, {{}, progress.stop});
    master.cut_at(as_shares({result.chosen.begin() + static_cast<std::ptrdiff_t>(fixed.size()), result.chosen.end()},
                            rows.size()));
  }
  const Relaxed relaxed = master.fewest(capture, config.tolerance, config.max_seconds, progress);
  result.possible = std::isfinite(relaxed.bound);
  result.complete = relaxed.complete;
  result.relaxation = relaxed.bound;
  if (result.possible) result.at_least = static_cast<std::size_t>(std::max(std::ceil(relaxed.bound - whole), 0.0));
  progress(1);
  return result;
}

}  // namespace vantage
