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
#include <cstdint>
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
  // Adds cuts: the supergradient at y bounds F everywhere, most tightly around y.
  void cut_at(std::span<const double> y);

  // θ_group <= constant + Σ_k of_k y_k.
  struct Cut {
    std::size_t group;
    double constant;
    std::vector<double> of;  // a coefficient for each candidate
    std::size_t idle = 0;    // rounds for which it was slack
  };
  // Candidates that are taken only with one of `doors`. Each member is a door, or is linked through one.
  struct Pocket {
    std::vector<std::uint32_t> members, doors;
  };
  // Returns a cut for each group. Pockets make cuts tighter: all candidates of a pocket add no more to an element than
  // the share to which its doors are taken. Half a station in a room and half a one in its door then do not add up.
  std::vector<Cut> supergradients(std::span<const double> y, std::span<const Pocket> pockets = {}) const;
  const std::vector<Cut>& cuts() const;  // so far
  std::size_t groups() const;
  double group_weight(std::size_t group) const;  // upper bound of θ_group

  // max F(y) subject to Σ y <= stations, to `tolerance`. `seconds`: gives up after; 0: never.
  Relaxed max_coverage(double stations, double tolerance, double seconds, const Progress& progress = {});
  // min Σ y subject to F(y) >= coverage, to `tolerance` in F. `bound` is a lower bound of the number; `reached` is Σ y
  // of a solution whose coverage is short by at most the tolerance. Infinite if all candidates have less.
  Relaxed min_stations(double coverage, double tolerance, double seconds, const Progress& progress = {});

  // Returns the best integer y of at most `stations` stations, by branch and bound over the cuts so far; empty if it
  // found none in time. `bound` is an upper bound for every such choice. Choices below `known` are ignored. Exclusions
  // of the problem apply, links do not.
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
