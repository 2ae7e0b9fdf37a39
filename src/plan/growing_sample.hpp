// SPDX-License-Identifier: Apache-2.0
// The voxels that a search goes by. Few show that a network cannot be kept, which is most of them; what might be kept
// is measured with more; and with more again once networks have come to differ by less than the sample can tell.
// Samples are nested, so a larger one goes on from all that was counted before. Now and then others are drawn, before
// the search has learnt what flatters by these.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "plan/network_evaluator.hpp"
#include "vantage/planner.hpp"

namespace vantage {

class GrowingSample {
 public:
  // Looks with `sample_from` voxels first, and goes by four times as many until it is outgrown, up to `sample_voxels`;
  // always by these where the former is 0.
  explicit GrowingSample(const PlanConfig& config);

  VoxelWindow window() const { return {sizes_[step_], from_}; }
  bool full() const { return step_ + 1 == sizes_.size(); }
  void fill() { step_ = sizes_.size() - 1; }
  // Smaller ones, rising, by which to look at a network before it is worth all of window().
  std::vector<VoxelWindow> first_looks() const;

  void grow(std::size_t lines) { ++step_, since_ = lines; }
  // Whether the hypervolume has come to grow by less than such a sample can tell: `error` is the standard error of a
  // scaled objective by it.
  bool outgrown(std::span<const PlanIteration> history, double error, std::size_t population) const;

  // Whether others are to be drawn after so many lines of the history.
  bool renews() const { return renew_ > 0; }
  bool stale(std::size_t lines) const { return renews() && lines >= renewed_ + renew_; }
  void renew(std::size_t lines) { from_ += sizes_.back(), renewed_ = lines; }

  // As a checkpoint keeps it.
  struct State {
    std::uint64_t step = 0, since = 0, from = 0, renewed = 0;
  };
  State state() const { return {step_, since_, from_, renewed_}; }
  void restore(const State& state);

 private:
  std::vector<std::uint64_t> sizes_;  // rising
  std::size_t step_ = 0;
  std::uint64_t since_ = 0;  // lines of the history when it last grew
  std::uint64_t from_ = 0;
  std::uint64_t renew_ = 0, renewed_ = 0;  // lines of the history: between two draws, and at the last one
};

}  // namespace vantage
