// SPDX-License-Identifier: Apache-2.0
// The linear relaxation of choosing stations on capture rows, as a master problem over the candidates alone.
//
// With y_k in [0, 1] how much of candidate k is taken, F(y) = Σ_v w_v min(b_v + Σ_k a_kv y_k, 1) is concave; a_kv is
// min(points_kv / goal, 1), b_v what fixed stations give. A supergradient at any ŷ bounds F everywhere: for each group
// g of voxels θ_g <= Σ_{v full at ŷ} w_v + Σ_{v not full} w_v (b_v + Σ_k a_kv y_k). So the voxels never enter the
// linear program, only such cuts do (Cordeau, Furini, Ljubić: Benders decomposition for very large scale partial set
// covering and maximal covering location problems, European Journal of Operational Research 275, 2019). Whatever cuts
// there are, the master's value is an upper bound.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "plan/row_graph.hpp"
#include "vantage/candidates.hpp"
#include "vantage/progress.hpp"

namespace vantage {

// Of a linear program that was solved to some tolerance: the wanted value lies between the two.
struct Relaxed {
  double bound = 1;       // no y has more (or, of the number of stations, less)
  double reached = 0;     // by `y`
  std::vector<double> y;  // a candidate each
  std::size_t rounds = 0;
  bool complete = false;  // came to its tolerance
};

class CaptureMaster {
 public:
  // Of the first `candidates` rows. Keeps a reference to `rows`. REQUIRES: candidates <= rows.size().
  CaptureMaster(const CaptureRows& rows, std::size_t candidates, std::span<const std::size_t> fixed = {});
  CaptureMaster(CaptureMaster&&) noexcept;
  ~CaptureMaster();

  // F(y) as a share of all weight. REQUIRES: one value a candidate.
  double value(std::span<const double> y) const;
  // Bounds F where it matters by its supergradient at y.
  void cut_at(std::span<const double> y);

  // max F(y) subject to Σ y <= stations, to `tolerance` (a share of all weight). `seconds`: give up after; 0: never.
  Relaxed most(double stations, double tolerance, double seconds, const Progress& progress = {});
  // min Σ y subject to F(y) >= capture, to `tolerance` in F: `bound` is a lower bound of the number, `reached` Σ y of
  // one that falls short of the capture by no more than the tolerance. Infinite where all candidates do not suffice.
  Relaxed fewest(double capture, double tolerance, double seconds, const Progress& progress = {});

  // The best integer y of so many stations at most, by branch and bound over the cuts so far; empty where none was
  // found in time. `bound` is an upper bound for any choice of so many candidates. `known`: what some choice is known
  // to have; worse ones are not looked at. With `graph`, of choices that hang together with the fixed rows; in all
  // cases of rows that `excluded` lets stand beside each other and the fixed ones, if it is of any.
  struct Choice {
    std::vector<std::size_t> rows;
    double bound = 1;
  };
  Choice choose(std::size_t stations, double seconds, double known, const RowGraph* graph,
                const ExcludedRows& excluded) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
