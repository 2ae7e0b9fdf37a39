// SPDX-License-Identifier: Apache-2.0
// How many voxels a search goes by. Few show that a network cannot be kept, which is most of them; what might be kept
// is measured with more; and with more again once networks have come to differ by less than the sample can tell.
// Samples are nested, so a larger one goes on from all that was counted before.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vantage/planner.hpp"

namespace vantage {

class GrowingSample {
 public:
  // Looks with `sample_from` voxels first, and goes by four times as many until it is outgrown, up to `sample_voxels`;
  // always by these where the former is 0.
  explicit GrowingSample(const PlanConfig& config);

  std::uint64_t voxels() const { return sizes_[step_]; }
  bool full() const { return step_ + 1 == sizes_.size(); }
  void fill() { step_ = sizes_.size() - 1; }
  // Smaller ones, rising, by which to look at a network before it is worth all of voxels().
  std::span<const std::uint64_t> first_looks() const { return std::span(sizes_).first(step_); }

  void grow(std::size_t lines) { ++step_, since_ = lines; }
  // Whether the hypervolume has come to grow by less than such a sample can tell: `error` is the standard error of a
  // scaled objective by it.
  bool outgrown(std::span<const PlanIteration> history, double error, std::size_t population) const;

  // As a checkpoint keeps it.
  std::uint64_t step() const { return step_; }
  std::uint64_t since() const { return since_; }
  void restore(std::uint64_t step, std::uint64_t since);

 private:
  std::vector<std::uint64_t> sizes_;  // rising
  std::size_t step_ = 0;
  std::size_t since_ = 0;  // lines of the history when it last grew
};

}  // namespace vantage
