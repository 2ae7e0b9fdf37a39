// SPDX-License-Identifier: Apache-2.0
#include "cover/tabu_search.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "core/parallel.hpp"
#include "cover/swap_gains.hpp"

namespace vantage {
namespace {

thread_local std::uint64_t swaps_of_this_thread = 0;

// Larger than the rounding of a share.
constexpr double kRounding = 1e-12;

}  // namespace

std::uint64_t swaps_made() noexcept { return swaps_of_this_thread; }

struct TabuSearch::Swap {
  double violation = std::numeric_limits<double>::infinity();
  CoverUnits coverage = -1;
  std::size_t at = 0, in = 0;
  bool better_than(const Swap& other) const {
    return violation < other.violation || (violation == other.violation && coverage > other.coverage);
  }
};

struct TabuSearch::State {
  std::vector<std::size_t> chosen;
  double link;
  SwapGains gains;
  Joinable joinable;
  NetworkLinks links;
  Swap best;                            // quality of the best network found
  std::vector<std::size_t> tabu_until;  // by candidate: may neither leave nor return before that swap
  std::size_t swap = 1;

  bool is_tabu(std::size_t candidate) const { return tabu_until[candidate] > swap; }
};

// Finds the best swap of a network, the first one among equals. Most swaps are rejected by an upper bound: their
// coverage, with as few components as the joining candidate may leave.
class TabuSearch::BestSwap {
 public:
  BestSwap(const CoverProblem& problem, double whole, const State& state)
      : problem_(problem),
        state_(state),
        now_(state.gains.now()),
        whole_(whole),
        trees_(state.links.trees()),
        components_(state.links.components_without(state.chosen.size(), trees_)),
        coverage_(state.gains.now().value()),
        least_(state.best.violation),
        for_links_(problem.matrix.candidates(), 0) {
    if (state.link <= 0) return;
    // A leaving member takes away one component at most, and only if it was alone.
    const bool any_alone = std::ranges::any_of(state.chosen, [&](std::size_t k) { return state.links.of(k).empty(); });
    const double link = violation(problem, problem.coverage, 2) * problem.coverage * whole_;
    for (std::size_t k = 0; k < for_links_.size(); ++k)
      if (const std::size_t count = state.links.count_with(components_, k) - (any_alone ? 1 : 0); count > 1)
        for_links_[k] = link * static_cast<double>(count - 1);
  }

  Swap find() {
    const std::size_t first = problem_.existing.size(), size = state_.chosen.size();
    CoverUnits most_left = 0;
    for (std::size_t at = first; at < size; ++at) {
      leave(at);
      most_left = std::max(most_left, left_);
      for (const SwapGains::More& other : state_.gains.without(at))
        consider(other.candidate, now_[other.candidate] + other.gain);
    }
    // Candidates whose gain does not grow without the leaving one, most promising first. Others are included: their
    // gain is a lower bound here, which does no harm.
    std::vector<std::pair<double, std::size_t>> promising;
    for (std::size_t k = 0; k < problem_.matrix.candidates(); ++k)
      if (is_enough(most_left + now_[k], k) && state_.joinable.against(k) < 2)
        promising.emplace_back(for_links_[k] - static_cast<double>(now_[k]), k);
    std::ranges::sort(promising);
    for (std::size_t at = first; at < size && !promising.empty(); ++at) {
      leave(at);
      for (const auto& [missing, k] : promising) {
        if (static_cast<double>(left_) - missing < enough_) break;
        consider(k, now_[k]);
      }
    }
    return best_;
  }

 private:
  void leave(std::size_t at) {
    at_ = at;
    left_ = coverage_ - state_.gains.loss(at);
    cut_.reset();
  }

  bool is_enough(CoverUnits coverage, std::size_t joining) const {
    return static_cast<double>(coverage) >= enough_ + for_links_[joining];
  }

  // A tabu swap counts if it leads to less violation than any network so far.
  void consider(std::size_t joining, CoverUnits gain) {
    const CoverUnits coverage = left_ + gain;
    if (!is_enough(coverage, joining)) return;
    const std::size_t leaving = state_.chosen[at_];
    if (!state_.joinable.may_stand_without(joining, problem_.graph && problem_.graph->excluded(leaving, joining)))
      return;
    const Swap now{violation(problem_, now_.share(coverage), components_with(joining)), coverage, at_, joining};
    if ((state_.is_tabu(leaving) || state_.is_tabu(joining)) && now.violation >= least_) return;
    const bool first = now.at == best_.at ? now.in < best_.in : now.at < best_.at;
    if (!now.better_than(best_) && (best_.better_than(now) || !first)) return;
    best_ = now;
    enough_ = (problem_.coverage * (1 - best_.violation) - kRounding) * whole_;
  }

  std::size_t components_with(std::size_t joining) {
    if (state_.link <= 0) return 1;
    const std::size_t count = trees_.without[at_];
    if (count > components_.count && !cut_) cut_ = state_.links.components_without(at_, trees_);
    return count + 1 - state_.links.joined(cut_ ? *cut_ : components_, joining, at_);
  }

  const CoverProblem& problem_;
  const State& state_;
  const CoverGains& now_;
  double whole_;
  NetworkLinks::Trees trees_;
  Components components_;
  CoverUnits coverage_;
  double least_;  // violation of the best network so far
  Swap best_;
  // In units: least coverage of a swap that can be the best, and by candidate the further coverage that makes up for
  // the links that it leaves missing.
  double enough_ = -std::numeric_limits<double>::infinity();
  std::vector<double> for_links_;
  std::size_t at_ = 0;
  CoverUnits left_ = 0;            // coverage without the leaving one
  std::optional<Components> cut_;  // components without it, if these are more
};

TabuSearch::TabuSearch(const CoverProblem& problem, const ColumnIndex& columns, std::stop_token stop)
    : problem_(problem), columns_(columns), stop_(std::move(stop)) {}

TabuSearch::Found TabuSearch::search(const std::vector<std::size_t>& start, double link) const {
  Found found{.network = start};
  State state{.chosen = start,
              .link = link,
              .gains = {problem_.matrix, columns_, start},
              .joinable = {problem_, start},
              .links = {problem_, start, link},
              .best = {},
              .tabu_until = std::vector<std::size_t>(problem_.matrix.candidates(), 0)};
  const CoverGains& now = state.gains.now();
  state.best.coverage = now.value();
  state.best.violation = violation(problem_, now.share(now.value()), state.links.components().count);
  for (std::size_t idle = 0; state.best.violation > 0 && idle < kPatience && !stop_.stop_requested();
       ++state.swap, ++idle) {
    const Swap swap = BestSwap(problem_, columns_.whole(), state).find();
    if (swap.violation == std::numeric_limits<double>::infinity()) break;
    const std::size_t leaving = std::exchange(state.chosen[swap.at], swap.in);
    state.gains.replace(swap.at, swap.in);
    state.joinable.remove(leaving), state.joinable.add(swap.in);
    state.links.replace(swap.at, swap.in);
    ++found.swaps;
    state.tabu_until[leaving] = state.swap + kTabu + 1, state.tabu_until[swap.in] = state.swap + kTabu / 2 + 1;
    if (!swap.better_than(state.best)) continue;
    if (swap.violation < state.best.violation) idle = 0;
    found.network = state.chosen, state.best = swap;
  }
  return found;
}

std::vector<std::size_t> TabuSearch::run(const std::vector<std::size_t>& start, double link) const {
  return std::move(run(std::span(&start, 1), link).front());
}

std::vector<std::vector<std::size_t>> TabuSearch::run(std::span<const std::vector<std::size_t>> starts,
                                                      double link) const {
  std::vector<Found> found(starts.size());
  parallel::for_all(std::size_t{0}, starts.size(), [&](std::size_t k) { found[k] = search(starts[k], link); });
  std::vector<std::vector<std::size_t>> networks;
  for (Found& one : found) {
    networks.push_back(std::move(one.network));
    swaps_of_this_thread += one.swaps;  // other threads searched for this one
  }
  return networks;
}

}  // namespace vantage
