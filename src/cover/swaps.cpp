// SPDX-License-Identifier: Apache-2.0
#include "cover/swaps.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "cover/network.hpp"

namespace vantage {
namespace {

// Local search over swaps.
class SwapSearch {
 public:
  SwapSearch(const CoverProblem& problem, const ColumnIndex& columns, std::vector<std::size_t> chosen)
      : problem_(problem),
        chosen_(std::move(chosen)),
        gains_(problem.matrix, columns, chosen_),
        joinable_(problem, chosen_),
        more_(problem.matrix.candidates(), 0) {
    if (problem.link > 0) parts_ = links_.emplace(problem, chosen_, problem.link).components().count;
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
    std::ranges::fill(more_, 0);
    gains_.for_gains_without(out, [&](std::size_t k, CoverUnits gain) { more_[k] += gain; });
    joinable_.remove(out);
    std::optional<Components> others;  // of the others; found when first needed
    std::size_t best = out;
    CoverUnits most = gains_.loss(out);
    for (std::size_t k = 0; k < more_.size(); ++k)
      if (gains_[k] + more_[k] > most && may_join(k, at, others)) most = gains_[k] + more_[k], best = k;
    joinable_.add(best);
    if (best == out) return false;
    gains_.replace(out, best);
    if (links_) links_->replace(at, best);
    chosen_[at] = best;
    return true;
  }

  bool may_join(std::size_t k, std::size_t leaving_at, std::optional<Components>& others) const {
    if (!joinable_.may_stand(k)) return false;
    if (!links_) return true;
    if (!others) others = links_->components_without(leaving_at, links_->trees());
    return others->count + 1 - links_->joined(*others, k, leaving_at) <= std::max<std::size_t>(parts_, 1);
  }

  const CoverProblem& problem_;
  std::vector<std::size_t> chosen_;
  CoverGains gains_;
  Joinable joinable_;
  std::optional<NetworkLinks> links_;  // none where the network need not be connected
  std::size_t parts_ = 1;              // components at the start; swaps leave no more
  std::vector<CoverUnits> more_;       // by candidate: its further gain without the leaving one
};

}  // namespace

std::vector<std::size_t> improve_by_swaps(const CoverProblem& problem, std::vector<std::size_t> chosen,
                                          std::stop_token stop) {
  check(problem);
  return improve_by_swaps(problem, ColumnIndex(problem.matrix), std::move(chosen), stop);
}

std::vector<std::size_t> improve_by_swaps(const CoverProblem& problem, const ColumnIndex& columns,
                                          std::vector<std::size_t> chosen, const std::stop_token& stop) {
  return SwapSearch(problem, columns, std::move(chosen)).run(stop);
}

std::vector<std::size_t> drop_and_swap(const CoverProblem& problem, std::vector<std::size_t> chosen,
                                       std::stop_token stop) {
  const std::size_t first = problem.existing.size();
  const ColumnIndex columns(problem.matrix);
  while (chosen.size() > first && !stop.stop_requested()) {
    const PartialCover cover(problem.matrix, chosen);
    std::size_t least = first;
    double lost = cover.loss(chosen[first]);
    for (std::size_t at = first + 1; at < chosen.size(); ++at)
      if (const double loss = cover.loss(chosen[at]); loss < lost) lost = loss, least = at;
    std::vector<std::size_t> fewer = without(chosen, least);
    if (problem.matrix.coverage(fewer) < problem.coverage) {
      fewer = improve_by_swaps(problem, columns, std::move(fewer), stop);
      if (problem.matrix.coverage(fewer) < problem.coverage) break;
    }
    chosen = std::move(fewer);
  }
  return chosen;
}

}  // namespace vantage
