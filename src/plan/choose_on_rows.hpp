// SPDX-License-Identifier: Apache-2.0
// Choosing stations on capture rows alone: arrays in, arrays out, any number of stations.
//
// What is maximised is F(S) = Σ_v weight_v · min(Σ_{k ∈ S} points_kv / goal, 1) / Σ_v weight_v, equation 8 of the
// sample. It grows with S and its gains shrink (it is submodular), which both algorithms rest on.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "vantage/candidates.hpp"

namespace vantage {

// What a growing and shrinking set of rows captures; rows may be taken more than once.
class RowCover {
 public:
  // Keeps a reference to `rows`.
  explicit RowCover(const CaptureRows& rows, std::span<const std::size_t> taken = {});
  void add(std::size_t row);
  void remove(std::size_t row);          // REQUIRES: added before
  double gain(std::size_t row) const;    // F(S + row) − F(S)
  double loss(std::size_t row) const;    // F(S) − F(S − row). REQUIRES: added before
  double value() const;                  // F(S), summed anew
  double fill(std::size_t voxel) const;  // min(points / goal, 1)
  double filled(std::uint64_t points) const;
  std::uint64_t points(std::size_t voxel) const { return points_[voxel]; }

 private:
  const CaptureRows& rows_;
  std::vector<std::uint64_t> points_;
};

// The same table by voxel: which rows see it, and how often. What a swap changes is then read where the station that
// leaves is needed, instead of all over every row.
class RowColumns {
 public:
  // Keeps a reference to `rows`.
  explicit RowColumns(const CaptureRows& rows);
  // To what each row gains with `leaving` there, F(S + row) − F(S), adds what makes it F(S − leaving + row) −
  // F(S − leaving). REQUIRES: S has `leaving`, gains.size() == rows.size().
  void add_gains_without(std::size_t leaving, const RowCover& cover, std::span<double> gains) const;

 private:
  struct Seen {
    std::uint32_t row, points;
  };
  const CaptureRows& rows_;
  std::vector<std::size_t> offsets_;
  std::vector<Seen> entries_;
};

// Whether a row may be taken besides the ones that are; empty: always, once.
using MayTake = std::function<bool(std::size_t row, std::span<const std::size_t> taken)>;

// Greedy with lazy evaluation (Minoux: Accelerated Greedy Algorithms for Maximizing Submodular Set Functions, 1978):
// `fixed`, then up to `count` further rows, each the one that adds most (the lower number where two add as much), no
// row twice. Stops before where no allowed row adds anything, or F reaches `enough`. Returns fixed and chosen rows in
// order. Within 1 − 1/e of the best set of `count` where all are allowed (Nemhauser, Wolsey, Fisher, 1978).
std::vector<std::size_t> choose_greedily(const CaptureRows& rows, std::size_t count,
                                         std::span<const std::size_t> fixed = {}, double enough = 1,
                                         const MayTake& may_take = {});

// Local search: while some chosen row (not one of the first `fixed`) can be changed for a row outside so that F grows
// by more than `least`, changes it, the best for each in turn. `may_take` is asked for the new row with the others as
// `taken`. Deterministic unless stopped; looks at `progress.stop` between rows, and reports nothing. Never loses.
std::vector<std::size_t> improve_by_swaps(const CaptureRows& rows, std::vector<std::size_t> chosen,
                                          std::size_t fixed = 0, double least = 1e-9, const MayTake& may_take = {},
                                          const Progress& progress = {});

// With F at `enough` or above, rows fewer: drops the one that takes least along (not one of the first `fixed`), and
// where that is too much makes up for it by swaps, until these cannot. F stays at `enough`. Deterministic unless
// stopped. REQUIRES: F(chosen) >= enough.
std::vector<std::size_t> drop_and_swap(const CaptureRows& rows, std::vector<std::size_t> chosen, std::size_t fixed,
                                       double enough, const Progress& progress = {});

}  // namespace vantage
