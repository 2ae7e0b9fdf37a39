// SPDX-License-Identifier: Apache-2.0
// Ranks and contributions of a population that changes by one member at a time.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vantage::optimise {

// The fitness vectors of μ members, all minimised, their ranks, and what each of the first front contributes against
// reach_over(). Ranks are exact. Contributions are handed over: who comes takes from its neighbours, who goes gives
// back. recount() sums them up anew, so that rounding does not add up.
class SteadyFront {
 public:
  SteadyFront(std::size_t objectives, std::span<const double> reference);

  // Takes a population, and its contributions where they are known (one a member, else empty).
  void assign(std::span<const double> fitness, std::span<const double> contributions = {});
  void recount();

  struct Verdict {
    std::size_t removed;      // the member that has to go; size() is the newcomer itself
    std::size_t rank;         // the newcomer's among all μ + 1
    std::size_t parent_rank;  // likewise; the newcomer's own where there is no parent
  };
  // Puts the newcomer in the place of the member that contributes least to the last front, the later one of equals.
  // `parent` is an index, or size().
  Verdict offer(std::span<const double> fitness, std::size_t parent);

  std::size_t size() const { return rank_.size(); }
  std::size_t rank(std::size_t i) const { return rank_[i]; }
  std::span<const double> fitness(std::size_t i) const { return std::span(values_).subspan(i * m_, m_); }
  std::span<const double> contributions() const { return contributions_; }  // 0 outside the first front

 private:
  // Ranks with the newcomer as the last: what it dominates falls back, and so does what that dominates.
  void rank_newcomer();
  std::size_t least_of(std::size_t rank) const;
  std::vector<double> reach() const;
  // The box around what p alone dominates in the first front, or what it and one other do, without `skipped` and p.
  void bound(std::size_t p, std::size_t skipped, bool second);
  double exclusive(std::size_t p, std::size_t skipped);
  // Fills near_ and gains_: who would gain what if p left the first front.
  void measure_heirs(std::size_t p, std::size_t skipped);
  void erase_last() { values_.resize(values_.size() - m_), rank_.pop_back(), contributions_.pop_back(); }

  std::size_t m_;
  std::vector<double> reference_, reach_, values_, contributions_;
  std::vector<std::size_t> rank_;

  std::vector<std::size_t> raised_, next_raised_, old_rank_, near_;
  std::vector<double> bound_, first_, local_, gains_;
};

}  // namespace vantage::optimise
