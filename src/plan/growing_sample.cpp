// SPDX-License-Identifier: Apache-2.0
#include "plan/growing_sample.hpp"

#include <algorithm>

namespace vantage {
namespace {

constexpr std::uint64_t kGrowth = 4;
// The hypervolume is watched over so many evaluations, and has to gain so much of the standard error.
constexpr std::size_t kWatched = 600;
constexpr double kLeastGain = 0.1;

}  // namespace

GrowingSample::GrowingSample(const PlanConfig& config)
    : renew_(config.sample_voxels > 0 ? config.renew_iterations.value_or(0) : 0) {
  if (config.sample_from > 0)
    for (std::uint64_t size = config.sample_from; size < config.sample_voxels; size *= kGrowth) sizes_.push_back(size);
  sizes_.push_back(config.sample_voxels);
  step_ = std::min<std::size_t>(1, sizes_.size() - 1);
}

bool GrowingSample::outgrown(std::span<const PlanIteration> history, double error, std::size_t population) const {
  const std::size_t watched = (kWatched + population - 1) / population;
  if (full() || history.size() <= since_ + watched) return false;
  const double now = history.back().hypervolume, then = history[history.size() - 1 - watched].hypervolume;
  return now > 0 && now - then < kLeastGain * error;
}

std::vector<VoxelWindow> GrowingSample::first_looks() const {
  std::vector<VoxelWindow> looks;
  for (std::size_t k = 0; k < step_; ++k) looks.push_back({sizes_[k], from_});
  return looks;
}

void GrowingSample::restore(const State& state) {
  step_ = std::min<std::size_t>(state.step, sizes_.size() - 1);
  since_ = state.since, from_ = state.from, renewed_ = state.renewed;
}

}  // namespace vantage
