// SPDX-License-Identifier: Apache-2.0
// Schedule of the voxel samples of a search: each is replaced before the search has adapted to it.
#pragma once

#include <cstdint>

#include "search/network_evaluator.hpp"

namespace vantage {

class SampleSchedule {
 public:
  // Size of the last sample, in multiples of the others; it measures the front.
  static constexpr std::uint64_t kVerification = 4;

  // Samples of `voxels`, another one after every `period` iterations.
  SampleSchedule(std::uint64_t voxels, std::uint64_t period) : voxels_(voxels), period_(period) {}

  VoxelWindow window() const { return {voxels_, state_.from}; }
  VoxelWindow verification() const { return {kVerification * voxels_, state_.from}; }
  bool due(std::uint64_t iterations) const { return iterations >= state_.drawn_at + period_; }
  SampleSchedule redrawn(std::uint64_t iterations) const {
    SampleSchedule next = *this;
    next.state_ = {state_.from + voxels_, iterations};
    return next;
  }

  // State in a checkpoint.
  struct State {
    std::uint64_t from = 0;      // where the sample begins in the draw
    std::uint64_t drawn_at = 0;  // iterations
  };
  const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }

 private:
  std::uint64_t voxels_, period_;
  State state_;
};

}  // namespace vantage
