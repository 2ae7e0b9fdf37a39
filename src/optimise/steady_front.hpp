// SPDX-License-Identifier: Apache-2.0
// Ranks and contributions of a population that changes by one member at a time.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vantage::optimise {

// Fitness vectors of μ members, all minimised, their ranks, and contributions in the first front against reach_over().
// Ranks are exact. Contributions are handed over: a newcomer takes from its neighbours, a leaving member returns its
// own. recount() computes them anew, so that rounding does not accumulate.
class SteadyFront {
 public:
  SteadyFront(std::size_t objectives, std::span<const double> reference);

  // Takes a population and, if known, its contributions (one per member, else empty).
  void assign(std::span<const double> fitness, std::span<const double> contributions = {});
  void recount();

  struct Verdict {
    std::size_t removed;      // the member to remove; size() is the newcomer itself
    std::size_t rank;         // of the newcomer among all μ + 1
    std::size_t parent_rank;  // of the parent among all μ + 1; the newcomer's own without a parent
  };
  // Replaces the least contributor of the last front, the later one of equals, by the newcomer. `parent` is an index,
  // or size().
  Verdict offer(std::span<const double> fitness, std::size_t parent);

  std::size_t size() const { return rank_.size(); }
  std::size_t rank(std::size_t i) const { return rank_[i]; }
  std::span<const double> fitness(std::size_t i) const { return std::span(values_).subspan(i * m_, m_); }
  std::span<const double> contributions() const { return contributions_; }  // 0 outside the first front

 private:
  // Ranks with the newcomer as the last member: what it dominates falls back, and so does what that dominates.
  void rank_newcomer();
  std::size_t least_of(std::size_t rank) const;
  std::vector<double> reach() const;
  // The box around the volume that p alone dominates in the first front, or, if `second`, p and one other point;
  // without `skipped`.
  void bound(std::size_t p, std::size_t skipped, bool second);
  double exclusive(std::size_t p, std::size_t skipped);
  // Fills near_ and gains_: which points would gain how much if p left the first front.
  void measure_heirs(std::size_t p, std::size_t skipped);
  void erase_last() { values_.resize(values_.size() - m_), rank_.pop_back(), contributions_.pop_back(); }

  std::size_t m_;
  std::vector<double> reference_, reach_, values_, contributions_;
  std::vector<std::size_t> rank_;

  std::vector<std::size_t> raised_, next_raised_, old_rank_, near_;
  std::vector<double> bound_, first_, local_, gains_;
};

}  // namespace vantage::optimise
