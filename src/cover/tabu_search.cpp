// SPDX-License-Identifier: Apache-2.0
#include "cover/tabu_search.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "core/parallel.hpp"

namespace vantage {
namespace {

thread_local std::uint64_t swaps_of_this_thread = 0;

}  // namespace

std::uint64_t swaps_made() noexcept { return swaps_of_this_thread; }

struct TabuSearch::Swap {
  double violation = std::numeric_limits<double>::infinity(), coverage = -1;
  std::size_t at = 0, in = 0;
  bool better_than(const Swap& other) const {
    return violation < other.violation || (violation == other.violation && coverage > other.coverage);
  }
};

// The loss of the network without one of its members, and what candidates then gain more than now. A swap changes both
// for few members: those that share an element with one of the two.
struct TabuSearch::Leaving {
  bool known = false;
  double loss = 0;
  std::vector<std::pair<std::uint32_t, double>> gained;
};

struct TabuSearch::State {
  std::vector<std::size_t> chosen;
  double link;
  CoverGains gains;
  Joinable joinable;
  NetworkLinks links;
  Swap best;                            // quality of the best network found
  std::vector<std::size_t> tabu_until;  // by candidate: may neither leave nor return before that swap
  std::vector<Leaving> leaving;         // by place; made when first needed
  std::size_t swap = 1;
};

// Candidates that may join the present network, by falling gain, then rising number. A swap changes the gain of few of
// them; the others' best is the first one of this list.
class TabuSearch::Ranking {
 public:
  struct Ranked {
    double gain;
    std::uint32_t candidate;
    std::uint32_t next = 0;  // place of the first one with a smaller gain
  };
  void add(double gain, std::size_t candidate) { ranked_.push_back({gain, static_cast<std::uint32_t>(candidate)}); }
  void sort() {
    std::ranges::sort(ranked_, [](const Ranked& a, const Ranked& b) {
      return a.gain != b.gain ? a.gain > b.gain : a.candidate < b.candidate;
    });
    auto next = static_cast<std::uint32_t>(ranked_.size());
    for (std::size_t k = ranked_.size(); k-- > 0;) {
      if (k + 1 < ranked_.size() && ranked_[k + 1].gain < ranked_[k].gain) next = static_cast<std::uint32_t>(k + 1);
      ranked_[k].next = next;
    }
  }
  // The candidate with the largest left + gain, the lowest number among equals, of those that pass.
  template <class Pass>
  std::optional<Ranked> best(double left, const Pass& pass) const {
    std::optional<Ranked> best;
    for (std::size_t k = 0; k < ranked_.size();) {
      if (best && left + ranked_[k].gain < left + best->gain) break;
      if (!pass(ranked_[k].candidate)) {
        ++k;
        continue;
      }
      if (!best || ranked_[k].candidate < best->candidate) best = ranked_[k];
      k = ranked_[k].next;
    }
    return best;
  }

 private:
  std::vector<Ranked> ranked_;
};

// The present network as all places of a swap see it.
struct TabuSearch::Round {
  double coverage;
  const NetworkLinks& links;
  Components components = {};
  std::vector<std::size_t> components_without = {};  // their number, by place
  std::vector<Ranking> rankings = {};                // by the number of components that a candidate is linked to
  std::vector<std::size_t> tabu = {};                // candidates that may not return
};

// Candidates that one place looks at by themselves, with their gains there.
struct TabuSearch::Scratch {
  std::vector<std::uint32_t> marked;  // by candidate: the last visit that marked it
  std::vector<double> gained;         // by candidate: what it gains more without the leaving one
  std::vector<std::size_t> candidates;
  std::uint32_t visit = 0;

  void begin(std::size_t candidates_in_all) {
    marked.resize(candidates_in_all, 0), gained.resize(candidates_in_all, 0);
    candidates.clear();
    ++visit;
  }
  void mark(std::size_t k) {
    if (marked[k] == visit) return;
    marked[k] = visit, gained[k] = 0;
    candidates.push_back(k);
  }
};

TabuSearch::TabuSearch(const CoverProblem& problem, std::stop_token stop)
    : problem_(problem), stop_(std::move(stop)), free_(free_candidates(problem)) {}

// The best swap of one chosen candidate. A tabu one counts if it leads to less violation than any network so far. Only
// candidates near the leaving one, and near parts that it cuts off, are looked at one by one: whether the others may
// join, what they gain and how many components they link is as in the present network.
TabuSearch::Swap TabuSearch::best_swap_at(State& state, const Round& round, std::size_t at, Scratch& scratch) const {
  const std::size_t leaving = state.chosen[at], count_without = round.components_without[at];
  const bool may_leave = state.tabu_until[leaving] <= state.swap, connected = state.link > 0;
  scratch.begin(problem_.matrix.candidates());
  Leaving& without = state.leaving[at];
  if (without.known) {
    for (const auto& [k, gained] : without.gained) scratch.mark(k), scratch.gained[k] = gained;
  } else {
    state.gains.for_gains_without(leaving, [&](std::size_t k, double gained) {
      scratch.mark(k);
      scratch.gained[k] += gained;
    });
    without.gained.clear();
    for (const std::size_t k : scratch.candidates)
      without.gained.emplace_back(static_cast<std::uint32_t>(k), scratch.gained[k]);
    without.loss = state.gains.cover().loss(leaving);
    without.known = true;
  }
  const double left = round.coverage - without.loss;
  const auto mark_linked = [&](std::size_t candidate) {
    for (const StationGraph::Overlap& other : problem_.graph->overlaps(candidate))
      if (static_cast<double>(other.share) >= state.link) scratch.mark(other.candidate);
  };
  if (problem_.graph)
    for (const std::uint32_t k : problem_.graph->excluded(leaving)) scratch.mark(k);
  std::optional<Components> cut;  // the components without the leaving one, where these are more
  if (connected) {
    mark_linked(leaving);
    if (count_without > round.components.count) {
      cut = round.links.components_without(at);
      const auto beside = [&](std::size_t other) {
        return other != at && round.components.of[other] == round.components.of[at];
      };
      std::vector<std::size_t> members(cut->count, 0);
      for (std::size_t other = 0; other < state.chosen.size(); ++other)
        if (beside(other)) ++members[cut->of[other]];
      const auto largest = static_cast<std::size_t>(std::ranges::max_element(members) - members.begin());
      for (std::size_t other = 0; other < state.chosen.size(); ++other)
        if (beside(other) && cut->of[other] != largest) mark_linked(state.chosen[other]);
    }
  }
  for (const std::size_t k : round.tabu) scratch.mark(k);

  Swap best;
  const auto consider = [&](std::size_t k, double gain, std::size_t count) {
    const Swap now{violation(problem_, left + gain, count), left + gain, at, k};
    if ((!may_leave || state.tabu_until[k] > state.swap) && now.violation >= state.best.violation) return;
    if (now.better_than(best) || (!best.better_than(now) && k < best.in)) best = now;
  };
  const auto count_with = [&](std::size_t joined) { return connected ? count_without + 1 - joined : 1; };
  for (const std::size_t k : scratch.candidates) {
    if (k == leaving || !state.joinable.may_stand_without(k, problem_.graph && problem_.graph->excluded(leaving, k)))
      continue;
    const std::size_t joined = connected ? round.links.joined(cut ? *cut : round.components, k, at) : 0;
    consider(k, state.gains[k] + scratch.gained[k], count_with(joined));
  }
  const auto unmarked = [&](std::size_t k) { return scratch.marked[k] != scratch.visit; };
  for (std::size_t joined = 0; joined < round.rankings.size(); ++joined)
    if (const auto other = round.rankings[joined].best(left, unmarked))
      consider(other->candidate, other->gain, count_with(joined));
  return best;
}

TabuSearch::Swap TabuSearch::best_swap(State& state) const {
  const std::size_t first = problem_.existing.size();
  Round round{.coverage = state.gains.cover().value(), .links = state.links};
  round.components = round.links.components();
  round.components_without = round.links.counts_without();
  for (const std::size_t k : free_) {
    if (!state.joinable.may_stand(k)) continue;
    if (state.tabu_until[k] > state.swap) round.tabu.push_back(k);
    const std::size_t joined = state.link > 0 ? round.links.joined(round.components, k, state.chosen.size()) : 0;
    if (round.rankings.size() <= joined) round.rankings.resize(joined + 1);
    round.rankings[joined].add(state.gains[k], k);
  }
  for (Ranking& ranking : round.rankings) ranking.sort();
  std::vector<Swap> swaps(state.chosen.size());
  tbb::enumerable_thread_specific<Scratch> scratch;
  parallel::for_all(first, state.chosen.size(),
                    [&](std::size_t at) { swaps[at] = best_swap_at(state, round, at, scratch.local()); });
  Swap best;
  for (std::size_t at = first; at < swaps.size(); ++at)
    if (swaps[at].better_than(best)) best = swaps[at];
  return best;
}

void TabuSearch::replace(State& state, std::size_t at, std::size_t joining) const {
  const std::size_t leaving = std::exchange(state.chosen[at], joining);
  state.gains.replace(leaving, joining);
  state.joinable.remove(leaving), state.joinable.add(joining);
  state.links.replace(at, joining);
  std::vector<char> touched(problem_.matrix.candidates(), 0);
  for (const std::size_t k : {leaving, joining})
    for (const CoverageMatrix::Entry& one : problem_.matrix.column(k))
      for (const ColumnIndex::Column& other : columns_->of(one.element)) touched[other.candidate] = 1;
  for (std::size_t other = 0; other < state.chosen.size(); ++other)
    if (touched[state.chosen[other]]) state.leaving[other].known = false;
  state.leaving[at].known = false;
}

std::vector<std::size_t> TabuSearch::run(std::vector<std::size_t> start, double link) {
  if (!columns_) columns_.emplace(problem_.matrix);
  std::vector<std::size_t> best = start;
  State state{.chosen = std::move(start),
              .link = link,
              .gains = {problem_.matrix, *columns_, best},
              .joinable = {problem_, best},
              .links = {problem_, best, link},
              .best = {},
              .tabu_until = std::vector<std::size_t>(problem_.matrix.candidates(), 0),
              .leaving = std::vector<Leaving>(best.size())};
  state.best.coverage = state.gains.cover().value();
  state.best.violation = violation(problem_, state.best.coverage, state.links.components().count);
  for (std::size_t idle = 0; state.best.violation > 0 && idle < kPatience && !stop_.stop_requested();
       ++state.swap, ++idle) {
    const Swap swap = best_swap(state);
    if (swap.violation == std::numeric_limits<double>::infinity()) break;
    const std::size_t leaving = state.chosen[swap.at];
    replace(state, swap.at, swap.in);
    ++swaps_of_this_thread;
    state.tabu_until[leaving] = state.swap + kTabu + 1, state.tabu_until[swap.in] = state.swap + kTabu / 2 + 1;
    if (!swap.better_than(state.best)) continue;
    if (swap.violation < state.best.violation) idle = 0;
    best = state.chosen, state.best = swap;
  }
  return best;
}

}  // namespace vantage
