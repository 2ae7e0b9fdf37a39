// SPDX-License-Identifier: Apache-2.0
#include "cover/tabu_search.hpp"

#include <tbb/parallel_for.h>

#include <limits>
#include <utility>

namespace vantage {
namespace {

// Swaps without a network of less violation before a search gives up, and swaps before a candidate that left may
// return. A candidate that came may leave again after half as many.
constexpr std::size_t kPatience = 40, kTabu = 7;

}  // namespace

struct TabuSearch::Swap {
  double violation = std::numeric_limits<double>::infinity(), coverage = -1;
  std::size_t at = 0, in = 0;
  bool better_than(const Swap& other) const {
    return violation < other.violation || (violation == other.violation && coverage > other.coverage);
  }
};

struct TabuSearch::State {
  std::vector<std::size_t> chosen;
  PartialCover cover;
  double link;
  Swap best;                            // quality of the best network found
  std::vector<std::size_t> tabu_until;  // by candidate: may neither leave nor return before that swap
  std::vector<double> gains = {};       // by candidate, to the chosen
  std::size_t swap = 1;
};

TabuSearch::TabuSearch(const CoverProblem& problem, std::stop_token stop)
    : problem_(problem), stop_(std::move(stop)), free_(free_candidates(problem)) {}

// The best swap of one chosen candidate. A tabu one counts if it leads to less violation than any network so far.
TabuSearch::Swap TabuSearch::best_swap_at(const State& state, std::size_t at, double coverage) const {
  const std::size_t leaving = state.chosen[at];
  const bool may_leave = state.tabu_until[leaving] <= state.swap;
  const std::vector<std::size_t> others = without(state.chosen, at);
  const Components components = components_of(problem_, others, state.link);
  const double left = coverage - state.cover.loss(leaving);
  std::vector<double> gains = state.gains;
  columns_->add_gains_without(leaving, state.cover, gains);
  Swap best;
  for (const std::size_t k : free_) {
    if (k == leaving || !may_stand(problem_, k, others)) continue;
    const std::size_t count = components_with(problem_, others, components, k, state.link);
    const Swap now{violation(problem_, left + gains[k], count), left + gains[k], at, k};
    if ((!may_leave || state.tabu_until[k] > state.swap) && now.violation >= state.best.violation) continue;
    if (now.better_than(best)) best = now;
  }
  return best;
}

TabuSearch::Swap TabuSearch::best_swap(const State& state) const {
  const std::size_t first = problem_.existing.size();
  const double coverage = state.cover.value();
  std::vector<Swap> swaps(state.chosen.size());
  tbb::parallel_for(first, state.chosen.size(), [&](std::size_t at) { swaps[at] = best_swap_at(state, at, coverage); });
  Swap best;
  for (std::size_t at = first; at < swaps.size(); ++at)
    if (swaps[at].better_than(best)) best = swaps[at];
  return best;
}

std::vector<std::size_t> TabuSearch::run(std::vector<std::size_t> start, double link) {
  if (!columns_) columns_.emplace(problem_.matrix);
  std::vector<std::size_t> best = start;
  State state{.chosen = std::move(start),
              .cover = PartialCover(problem_.matrix, best),
              .link = link,
              .best = {},
              .tabu_until = std::vector<std::size_t>(problem_.matrix.candidates(), 0)};
  state.best.coverage = state.cover.value();
  state.best.violation = violation(problem_, state.best.coverage, components_of(problem_, best, link).count);
  state.gains.resize(problem_.matrix.candidates());
  for (std::size_t idle = 0; state.best.violation > 0 && idle < kPatience && !stop_.stop_requested();
       ++state.swap, ++idle) {
    tbb::parallel_for(std::size_t{0}, state.gains.size(), [&](std::size_t k) { state.gains[k] = state.cover.gain(k); });
    const Swap swap = best_swap(state);
    if (swap.violation == std::numeric_limits<double>::infinity()) break;
    const std::size_t leaving = std::exchange(state.chosen[swap.at], swap.in);
    state.cover.remove(leaving), state.cover.add(swap.in);
    state.tabu_until[leaving] = state.swap + kTabu + 1, state.tabu_until[swap.in] = state.swap + kTabu / 2 + 1;
    if (!swap.better_than(state.best)) continue;
    if (swap.violation < state.best.violation) idle = 0;
    best = state.chosen, state.best = swap;
  }
  return best;
}

}  // namespace vantage
