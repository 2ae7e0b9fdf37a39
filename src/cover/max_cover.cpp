// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include "core/part_of.hpp"
#include "core/seconds_since.hpp"
#include "core/setting_list.hpp"
#include "cover/benders_master.hpp"
#include "cover/connected_branch.hpp"
#include "cover/network.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

using Candidates = std::vector<std::size_t>;

// Difference in coverage up to which a network counts as optimal: branch and bound has tolerances.
constexpr double kClosed = 1e-5;

std::vector<double> as_shares(std::span<const std::size_t> chosen, std::size_t candidates) {
  std::vector<double> y(candidates);
  for (const std::size_t k : chosen)
    if (k < candidates) y[k] = 1;
  return y;
}

// The best network of the heuristics; empty if it must be connected and none was found.
Candidates heuristic_choice(const CoverProblem& problem, const std::stop_token& stop) {
  if (problem.link <= 0) return improve_by_swaps(problem, greedy(problem), stop);
  CoverProblem all = problem;
  all.fewest = problem.most;
  Candidates chosen = min_connected_cover(all, stop).best.chosen;
  if (components_of(problem, chosen, problem.link).count > 1) return {};
  return improve_by_swaps(problem, std::move(chosen), stop);
}

// Branch and bound over the cuts. Adds cuts while a choice has less coverage than the cuts predict, until one has the
// coverage of the bound.
void branch_and_bound(const CoverProblem& problem, BendersMaster& master, double seconds, CoverSolution& result,
                      const std::stop_token& stop) {
  const auto begun = std::chrono::steady_clock::now();
  const std::size_t existing = problem.existing.size(), candidates = problem.matrix.candidates();
  double reached = result.chosen.empty() ? -1 : problem.matrix.coverage(result.chosen);
  while (!stop.stop_requested() && result.bound - reached > kClosed) {
    const double left = seconds - seconds_since(begun);
    if (left <= 0) break;
    const BendersMaster::Choice choice = master.choose(problem.most, left, std::max(reached, 0.0));
    result.bound = std::min(result.bound, choice.bound);
    if (choice.candidates.empty()) break;
    Candidates chosen = problem.existing;
    chosen.insert(chosen.end(), choice.candidates.begin(), choice.candidates.end());
    master.cut_at(as_shares(choice.candidates, candidates));
    chosen = improve_by_swaps(problem, std::move(chosen), stop);
    master.cut_at(as_shares(std::span(chosen).subspan(existing), candidates));
    if (const double coverage = problem.matrix.coverage(chosen); coverage > reached) {
      reached = coverage;
      result.chosen = std::move(chosen);
    }
  }
}

// The same for connected networks.
void branch_connected(const CoverProblem& problem, const BendersMaster& master, double seconds, CoverSolution& result,
                      const std::stop_token& stop) {
  const double known = result.chosen.empty() ? 0 : problem.matrix.coverage(result.chosen);
  ConnectedBranch found = branch_connected(problem, master, known, result.bound, seconds, stop);
  result.bound = found.bound;
  if (found.chosen.empty()) return;
  result.chosen = problem.existing;
  result.chosen.insert(result.chosen.end(), found.chosen.begin(), found.chosen.end());
}

}  // namespace

Settings settings(const BoundConfig& config) {
  return SettingList()
      .add("bound_tolerance", config.tolerance)
      .add("bound_max_seconds", config.max_seconds)
      .add("bound_exact_seconds", config.exact_seconds)
      .take();
}

CoverSolution max_cover(const CoverProblem& asked, const BoundConfig& config, const Progress& progress) {
  check(asked), check(config);
  const std::size_t candidates = asked.matrix.candidates();
  if (candidates == 0) throw Error(Errc::invalid_argument, "cover: there are no candidates");
  if (asked.most < 1 || asked.most == std::numeric_limits<std::size_t>::max())
    throw Error(Errc::invalid_argument, "cover: give the number of stations, 1 or more");
  CoverProblem problem = asked;
  problem.coverage = 1;  // as high as possible
  CoverSolution result;
  result.chosen = heuristic_choice(problem, progress.stop);
  const Candidates found(
      result.chosen.begin() + static_cast<std::ptrdiff_t>(std::min(problem.existing.size(), result.chosen.size())),
      result.chosen.end());
  const auto solve = [&](BendersMaster& master, std::size_t first, double from) {
    master.cut_at(as_shares(found, first));
    return master.max_coverage(static_cast<double>(problem.most), config.tolerance, config.max_seconds,
                               between(progress, from, from + 0.5));
  };
  const std::size_t half = std::max<std::size_t>(candidates / 2, 1);
  BendersMaster coarse(problem, half), master(problem, candidates);
  const Relaxed before = solve(coarse, half, 0), after = solve(master, candidates, 0.5);
  result.bound = after.bound;
  result.relaxation = after.reached;
  result.complete = before.complete && after.complete;
  result.half_bound = before.bound;
  result.spacing_term = std::max(after.bound - before.bound, 0.0);
  if (config.exact_seconds > 0 && problem.link > 0)
    branch_connected(problem, master, config.exact_seconds, result, progress.stop);
  else if (config.exact_seconds > 0)
    branch_and_bound(problem, master, config.exact_seconds, result, progress.stop);
  const CoverSolution best = evaluate_cover(problem, result.chosen);
  result.coverage = best.coverage, result.link = best.link, result.violation = best.violation;
  progress(1);
  return result;
}

}  // namespace vantage
