// SPDX-License-Identifier: Apache-2.0
#include "cover/swaps.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/parallel.hpp"
#include "cover/network.hpp"
#include "cover/partial_cover.hpp"

namespace vantage {
namespace {

// Least gain of a swap, so that rounding does not keep a search going.
constexpr double kLeastGain = 1e-9;
// Candidates whose gains are computed side by side.
constexpr std::size_t kAtOnce = 64;

// Local search over swaps. An upper bound of each candidate's gain, kept from swap to swap, spares most evaluations.
class SwapSearch {
 public:
  SwapSearch(const CoverProblem& problem, std::vector<std::size_t> chosen)
      : problem_(problem),
        chosen_(std::move(chosen)),
        cover_(problem.matrix, chosen_),
        joinable_(problem, chosen_),
        in_(problem.matrix.candidates(), 0),
        bound_(in_.size()),
        known_(in_.size()) {
    for (const std::size_t k : chosen_) in_[k] = 1;
    if (problem.link > 0) links_.emplace(problem, chosen_, problem.link);
    parallel::for_all(std::size_t{0}, bound_.size(), [&](std::size_t k) { bound_[k] = cover_.gain(k); });
  }

  // Runs until no candidate can be replaced, or stopped.
  std::vector<std::size_t> run(const std::stop_token& stop) {
    const std::size_t first = problem_.existing.size();
    std::size_t unchanged = 0;  // consecutive candidates that were not replaced
    for (std::size_t at = first;
         chosen_.size() > first && unchanged < chosen_.size() - first && !stop.stop_requested();) {
      unchanged = replace(at) ? 0 : unchanged + 1;
      at = at + 1 < chosen_.size() ? at + 1 : first;
    }
    return std::move(chosen_);
  }

 private:
  // Replaces the candidate at `at` by the one with the largest gain. False if none gains.
  bool replace(std::size_t at) {
    const std::size_t out = chosen_[at];
    const double lost = cover_.loss(out);
    cover_.remove(out);
    joinable_.remove(out);
    const std::vector<std::size_t> order = by_bound();
    std::optional<Components> others;  // of the network without the leaving one; made when first needed
    std::size_t best = out, looked_at = 0;
    double most = lost + kLeastGain;
    // F(S − out + k) − F(S − out) is at most F(S + k) − F(S − out): the gain of k and the loss of `out`.
    for (; looked_at < order.size() && bound_[order[looked_at]] + lost > most; ++looked_at) {
      if (looked_at % kAtOnce == 0)
        parallel::for_all(looked_at, std::min(looked_at + kAtOnce, order.size()), [&](std::size_t i) {
          if (bound_[order[i]] + lost > most) known_[order[i]] = cover_.gain(order[i]);
        });
      const std::size_t k = order[looked_at];
      if (known_[k] > most && may_join(k, at, others)) most = known_[k], best = k;
    }
    cover_.add(best);
    joinable_.add(best);
    if (best != out) {
      in_[out] = 0, in_[best] = 1;
      chosen_[at] = best;
      if (links_) links_->replace(at, best);
      for (double& one : bound_) one += lost;
      bound_[out] = lost;
    }
    // Gains shrink when another candidate is added.
    for (std::size_t i = 0; i < looked_at; ++i) bound_[order[i]] = std::min(bound_[order[i]], known_[order[i]]);
    return best != out;
  }

  bool may_join(std::size_t k, std::size_t leaving_at, std::optional<Components>& others) const {
    if (!joinable_.may_stand(k)) return false;
    if (!links_) return true;
    if (!others) others = links_->components_without(leaving_at);
    return others->count + 1 - links_->joined(*others, k, leaving_at) == 1;
  }

  std::vector<std::size_t> by_bound() const {
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < in_.size(); ++k)
      if (!in_[k]) order.push_back(k);
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return bound_[a] != bound_[b] ? bound_[a] > bound_[b] : a < b; });
    return order;
  }

  const CoverProblem& problem_;
  std::vector<std::size_t> chosen_;
  PartialCover cover_;
  Joinable joinable_;
  std::optional<NetworkLinks> links_;  // none where the network need not be connected
  std::vector<char> in_;
  std::vector<double> bound_, known_;  // of each candidate's gain: an upper bound, and the last computed value
};

}  // namespace

std::vector<std::size_t> improve_by_swaps(const CoverProblem& problem, std::vector<std::size_t> chosen,
                                          std::stop_token stop) {
  check(problem);
  return SwapSearch(problem, std::move(chosen)).run(stop);
}

std::vector<std::size_t> drop_and_swap(const CoverProblem& problem, std::vector<std::size_t> chosen,
                                       std::stop_token stop) {
  const std::size_t first = problem.existing.size();
  while (chosen.size() > first && !stop.stop_requested()) {
    const PartialCover cover(problem.matrix, chosen);
    std::size_t least = first;
    double lost = cover.loss(chosen[first]);
    for (std::size_t at = first + 1; at < chosen.size(); ++at)
      if (const double loss = cover.loss(chosen[at]); loss < lost) lost = loss, least = at;
    std::vector<std::size_t> fewer = without(chosen, least);
    if (problem.matrix.coverage(fewer) < problem.coverage) {
      fewer = improve_by_swaps(problem, std::move(fewer), stop);
      if (problem.matrix.coverage(fewer) < problem.coverage) break;
    }
    chosen = std::move(fewer);
  }
  return chosen;
}

}  // namespace vantage
