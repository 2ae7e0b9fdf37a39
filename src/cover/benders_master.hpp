// SPDX-License-Identifier: Apache-2.0
// The linear relaxation of a covering problem, as a Benders master over the candidates alone.
//
// With y_k in [0, 1] the taken share of candidate k, F(y) = Σ_e w_e min(b_e + Σ_k a_ke y_k, 1) is concave; a_ke is
// min(amount / goal, 1), b_e the share from existing candidates. A supergradient at any ŷ bounds F everywhere: for each
// group g of elements θ_g <= Σ_{e covered at ŷ} w_e + Σ_{e not covered} w_e (b_e + Σ_k a_ke y_k). Only such cuts enter
// the linear program, never the elements (Cordeau, Furini, Ljubić: Benders decomposition for very large scale partial
// set covering and maximal covering location problems, European Journal of Operational Research 275, 2019). With any
// set of cuts the master's value is an upper bound.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "vantage/cover.hpp"

namespace vantage {

// A linear program solved to some tolerance: the wanted value lies between `bound` and `reached`.
struct Relaxed {
  double bound = 1;       // upper bound on coverage (for min_stations(), lower bound on the number)
  double reached = 0;     // value of `y`
  std::vector<double> y;  // one for each candidate
  std::size_t rounds = 0;
  bool complete = false;  // reached its tolerance
};

class BendersMaster {
 public:
  // Uses the first `candidates` of the problem. Keeps a reference to it. REQUIRES: candidates <= matrix.candidates().
  BendersMaster(const CoverProblem& problem, std::size_t candidates);
  BendersMaster(BendersMaster&&) noexcept;
  ~BendersMaster();

  // F(y). REQUIRES: one value for each candidate.
  double value(std::span<const double> y) const;
  // Bounds F around y by its supergradient there.
  void cut_at(std::span<const double> y);

  // max F(y) subject to Σ y <= stations, to `tolerance`. `seconds`: gives up after; 0: never.
  Relaxed max_coverage(double stations, double tolerance, double seconds, const Progress& progress = {});
  // min Σ y subject to F(y) >= coverage, to `tolerance` in F. `bound` is a lower bound of the number; `reached` is Σ y
  // of a solution whose coverage is short by at most the tolerance. Infinite if all candidates have less.
  Relaxed min_stations(double coverage, double tolerance, double seconds, const Progress& progress = {});

  // The best integer y of at most `stations` stations, by branch and bound over the cuts so far; empty if none was
  // found in time. `bound` is an upper bound for every such choice. Choices below `known` are ignored. Links and
  // exclusions of the problem apply; links also among existing candidates.
  struct Choice {
    std::vector<std::size_t> candidates;
    double bound = 1;
  };
  Choice choose(std::size_t stations, double seconds, double known) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
