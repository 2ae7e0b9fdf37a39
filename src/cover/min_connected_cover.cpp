// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "cover/connected_growth.hpp"
#include "cover/network.hpp"
#include "cover/partial_cover.hpp"
#include "cover/tabu_search.hpp"

namespace vantage {
namespace {

// Number of networks of one station fewer that a search starts from: those with the least loss.
constexpr std::size_t kBeginnings = 3;
// Largest network that is grown station by station: each addition takes swaps of all.
constexpr std::size_t kOneByOne = 128;
// Step by which the required weakest link grows.
constexpr double kLinkStep = 0.02;

// A feasible network beats any other; among feasible ones, the one of fewer stations wins. Among infeasible ones each
// station must lower the violation by `least_help`.
bool is_better(const CoverSolution& a, const CoverSolution& b, double least_help) {
  const auto cost = [least_help](const CoverSolution& one) {
    return one.violation == 0 ? 0 : one.violation + least_help * static_cast<double>(one.chosen.size());
  };
  return std::pair(cost(a), a.chosen.size()) < std::pair(cost(b), b.chosen.size());
}

// Places of the chosen candidates that may leave; the one with the least violation first.
std::vector<std::size_t> places_by_loss(const CoverProblem& problem, const std::vector<std::size_t>& chosen) {
  struct Loss {
    double violation, coverage;
    std::size_t at;
  };
  const PartialCover cover(problem.matrix, chosen);
  const double whole = cover.value();
  const std::vector<std::size_t> components = NetworkLinks(problem, chosen, problem.link).trees().without;
  std::vector<Loss> losses;
  for (std::size_t at = problem.existing.size(); at < chosen.size(); ++at) {
    const double coverage = whole - cover.loss(chosen[at]);
    losses.push_back({violation(problem, coverage, components[at]), coverage, at});
  }
  std::ranges::stable_sort(losses, [](const Loss& a, const Loss& b) {
    return a.violation != b.violation ? a.violation < b.violation : a.coverage > b.coverage;
  });
  std::vector<std::size_t> places;
  for (const Loss& loss : losses) places.push_back(loss.at);
  return places;
}

// Adds one candidate at a time, with swaps after each, until the network is feasible. Growth alone can get stuck: if
// candidates keep a distance, a chosen one may block the only way to the rest.
CoverSolution grow_one_by_one(CoverProblem problem, const ColumnIndex& columns, const std::stop_token& stop) {
  const std::size_t fewest = problem.fewest,
                    most = std::min({problem.most, problem.matrix.candidates() - problem.existing.size(), kOneByOne});
  CoverSolution best = evaluate_cover(problem, problem.existing);
  for (std::size_t placed = 1; placed <= most && !stop.stop_requested(); ++placed) {
    problem.most = placed, problem.fewest = std::min(fewest, placed);
    const std::size_t before = best.chosen.size();
    best = grow_and_swap(problem, columns, std::move(best.chosen), stop);
    if (best.violation == 0 || best.chosen.size() == before) break;
  }
  return best;
}

}  // namespace

ConnectedCover min_connected_cover(const CoverProblem& problem, std::stop_token stop,
                                   std::optional<CoverSolution> start) {
  check(problem);
  const ColumnIndex columns(problem.matrix);
  const TabuSearch tabu(problem, columns, stop);
  const bool from_start = start.has_value();
  ConnectedCover found{.best = from_start
                                   ? std::move(*start)
                                   : evaluate_cover(problem, grow_connected(problem, columns, problem.existing))};
  CoverSolution& best = found.best;
  const auto placed = [&] { return best.chosen.size() - problem.existing.size(); };
  const auto swap = [&] {
    if (best.violation > 0 && !stop.stop_requested())
      best = evaluate_cover(problem, tabu.run(best.chosen, problem.link));
  };
  swap();
  if (from_start && best.violation > 0 && placed() < problem.most && !stop.stop_requested()) {
    CoverSolution before = std::exchange(best, evaluate_cover(problem, grow_connected(problem, columns, best.chosen)));
    swap();
    if (is_better(before, best, problem.least_help)) best = std::move(before);
  }
  if (best.violation > 0 && problem.graph && best.chosen.size() <= kOneByOne && !stop.stop_requested()) {
    CoverSolution other = grow_one_by_one(problem, columns, stop);
    if (is_better(other, best, problem.least_help)) best = std::move(other);
  }
  if (best.violation > 0 && problem.graph && !stop.stop_requested()) {
    CoverSolution other =
        evaluate_cover(problem, grow_connected(problem, columns, problem.existing, Links::left_for_gain));
    if (other.violation > 0 && !stop.stop_requested())
      other = evaluate_cover(problem, tabu.run(other.chosen, problem.link));
    if (is_better(other, best, problem.least_help)) best = std::move(other);
  }
  // Removes stations one by one while that is no worse, even if the network is not feasible.
  while (placed() > std::max<std::size_t>(problem.fewest, 1) && !stop.stop_requested()) {
    const std::vector<std::size_t> places = places_by_loss(problem, best.chosen);
    std::optional<CoverSolution> fewer;
    // Most often the first start will do. The others are tried at once.
    for (std::size_t first = 0, end = 1; first < places.size() && first < kBeginnings && !fewer;
         first = std::exchange(end, kBeginnings)) {
      std::vector<std::vector<std::size_t>> starts;
      for (std::size_t k = first; k < std::min(end, places.size()); ++k)
        starts.push_back(without(best.chosen, places[k]));
      for (std::vector<std::size_t>& network : tabu.run(starts, problem.link)) {
        CoverSolution now = evaluate_cover(problem, std::move(network));
        std::optional<CoverSolution>& nearest = found.one_fewer;
        if (now.violation <= best.violation) {
          fewer = std::move(now);
          break;
        }
        if (!nearest || nearest->chosen.size() > now.chosen.size() || nearest->violation > now.violation)
          nearest = std::move(now);
      }
    }
    if (!fewer) break;
    best = std::move(*fewer);
  }
  return found;
}

CoverSolution improve_weakest_link(const CoverProblem& problem, CoverSolution from, double enough,
                                   std::stop_token stop) {
  check(problem);
  const auto is_weak = [&](const CoverSolution& one) {
    return problem.graph && one.link < enough && one.chosen.size() > 1;
  };
  CoverSolution best = std::move(from);
  if (best.violation == 0 && !is_weak(best)) return best;
  const ColumnIndex columns(problem.matrix);
  const TabuSearch tabu(problem, columns, stop);
  if (best.violation > 0) {
    CoverSolution found = evaluate_cover(problem, tabu.run(best.chosen, problem.link));
    if (found.violation < best.violation) best = std::move(found);
  }
  while (best.violation == 0 && is_weak(best) && !stop.stop_requested()) {
    CoverSolution found = evaluate_cover(problem, tabu.run(best.chosen, std::min(best.link + kLinkStep, enough)));
    if (found.violation > 0 || found.link <= best.link) break;
    best = std::move(found);
  }
  return best;
}

}  // namespace vantage
