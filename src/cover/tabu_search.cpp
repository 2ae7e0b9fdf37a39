// SPDX-License-Identifier: Apache-2.0
#include "cover/tabu_search.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include "core/parallel.hpp"
#include "core/philox.hpp"

namespace vantage {
namespace {

// Swaps before a candidate that left may return, and before one that came may leave again: at least, and so many at
// random.
constexpr std::uint32_t kMayReturn = 8, kMayReturnAfter = 5, kMayLeave = 3, kMayLeaveAfter = 3;
// A first swap may lead to so much more violation than the least so far, divided by the number of members: about a
// twentieth of what one of them covers.
constexpr double kDeviation = 0.05;
// Coverage that a missing link is worth where the candidates for one place are compared: less than as a violation, so
// that a search passes through networks of two components.
constexpr double kLinkWorth = 0.05;
// Rounding of a sum of changes.
constexpr double kRounding = 1e-12, kNearlyNone = 1e-9;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

// The best candidate in place of a member.
struct TabuSearch::Swap {
  double violation = kInfinity, score = -kInfinity;
  std::size_t joining = 0;
  double loss = -1;  // of the member when it was tried; another one tells that something near it changed
};

struct TabuSearch::State {
  std::vector<std::size_t> chosen;
  double link;
  CoverGains gains;
  Joinable joinable;
  NetworkLinks links;
  std::vector<std::size_t> tabu_until;  // by candidate: may neither leave nor return before that swap
  std::vector<Swap> swaps;              // by place, as last tried
  double violation = 0, least = 0;      // of the network, and of the best one
  std::size_t swap = 1;
  std::vector<double> more = {};  // by candidate: its further gain without the member that was tried last

  bool is_tabu(std::size_t candidate) const { return tabu_until[candidate] > swap; }
};

TabuSearch::TabuSearch(const CoverProblem& problem, std::size_t patience, std::stop_token stop)
    : problem_(problem),
      patience_(patience),
      stop_(std::move(stop)),
      free_(free_candidates(problem)),
      columns_(problem.matrix) {}

// A tabu candidate counts if it leads to less violation than any network so far.
TabuSearch::Swap TabuSearch::best_swap_at(State& state, std::size_t at) const {
  const std::size_t leaving = state.chosen[at];
  Swap best{.loss = state.gains.loss(leaving)};
  state.gains.gains_without(leaving, state.more);
  state.joinable.remove(leaving);
  const Components parts = state.links.components_without(at);
  const double left = state.gains.value() - best.loss;
  for (const std::size_t k : free_) {
    const double gain = state.gains[k] + state.more[k];
    if (gain <= best.score || k == leaving || !state.joinable.may_stand(k)) continue;
    const std::size_t count = state.link > 0 ? parts.count + 1 - state.links.joined(parts, k, at) : 1;
    const double score = gain - kLinkWorth * static_cast<double>(count - 1);
    if (score <= best.score) continue;
    const double now = violation(problem_, left + gain, count);
    if (state.is_tabu(k) && now >= state.least - kRounding) continue;
    best.violation = now, best.score = score, best.joining = k;
  }
  state.joinable.add(leaving);
  return best;
}

TabuSearch::Found TabuSearch::run(std::vector<std::size_t> start, double link, double enough, std::uint64_t seed,
                                  const std::function<bool()>& stopped) const {
  const std::size_t first = problem_.existing.size(), size = start.size();
  State state{.chosen = start,
              .link = link,
              .gains = {problem_.matrix, columns_, start},
              .joinable = {problem_, start},
              .links = {problem_, start, link},
              .tabu_until = std::vector<std::size_t>(problem_.matrix.candidates(), 0),
              .swaps = std::vector<Swap>(size)};
  const auto measured = [&] {
    return violation(problem_, state.gains.cover().value(), state.links.components().count);
  };
  state.violation = state.least = measured();
  Found found{.network = std::move(start)};
  double coverage = state.gains.value();
  RandomStream random(seed);
  std::vector<std::size_t> untried;
  const std::size_t patience = patience_ + size;  // each member is tried at least once
  for (std::size_t idle = 0; size > first && state.least > enough && idle < patience && !stopped(); ++idle) {
    untried.clear();
    std::size_t at = size;
    for (std::size_t place = first; place < size; ++place) {
      if (state.is_tabu(state.chosen[place])) continue;
      if (state.swaps[place].loss != state.gains.loss(state.chosen[place])) untried.push_back(place);
      if (at == size || state.swaps[place].violation < state.swaps[at].violation) at = place;
    }
    // One member after the other, at random; the first swap within the deviation is made (Dueck: New Optimization
    // Heuristics, 1993), and if there is none, the best one. The deviation shrinks as time goes by without success.
    if (!untried.empty()) at = untried[random.bits() % static_cast<std::uint32_t>(untried.size())];
    if (at < size) state.swaps[at] = best_swap_at(state, at);
    const double left = 1 - static_cast<double>(idle) / static_cast<double>(patience);
    const double within = std::max(state.violation, state.least + left * kDeviation / static_cast<double>(size));
    if (!untried.empty() && state.swaps[at].violation > within) continue;
    ++state.swap;
    if (at == size || state.swaps[at].violation == kInfinity) continue;
    const std::size_t joining = std::exchange(state.swaps[at], {.violation = state.swaps[at].violation}).joining;
    state.violation = state.swaps[at].violation;
    const std::size_t leaving = std::exchange(state.chosen[at], joining);
    state.gains.remove(leaving, state.more), state.gains.add(joining);
    state.joinable.remove(leaving), state.joinable.add(joining);
    state.links.replace(at, joining);
    state.tabu_until[leaving] = state.swap + kMayReturn + random.bits() % kMayReturnAfter;
    state.tabu_until[joining] = state.swap + kMayLeave + random.bits() % kMayLeaveAfter;
    found.joined.push_back(joining);
    if (state.violation < enough + kNearlyNone) state.violation = measured();
    const bool better =
        state.violation < state.least - kRounding || (state.violation <= enough && state.least > enough);
    if (better) idle = 0;
    if (!better && (state.violation > state.least || state.gains.value() <= coverage)) continue;
    state.least = state.violation, coverage = state.gains.value();
    found.network = state.chosen;
  }
  found.violation = state.least;
  return found;
}

TabuSearch::Found TabuSearch::run(std::vector<std::size_t> start, double link, double enough) const {
  return run(std::move(start), link, enough, 0, [&] { return stop_.stop_requested(); });
}

std::vector<TabuSearch::Found> TabuSearch::run(std::span<const std::vector<std::size_t>> starts, double link,
                                               double enough) const {
  std::vector<Found> found(starts.size());
  // Later ones than the first that is good enough are given up, whenever that is known.
  std::atomic<std::size_t> first = starts.size() - 1;
  parallel::for_all(std::size_t{0}, starts.size(), [&](std::size_t k) {
    found[k] = run(starts[k], link, enough, k, [&] { return first < k || stop_.stop_requested(); });
    if (found[k].violation > enough) return;
    for (std::size_t known = first; k < known && !first.compare_exchange_weak(known, k);) {
    }
  });
  found.resize(starts.empty() ? 0 : first + 1);
  return found;
}

}  // namespace vantage
