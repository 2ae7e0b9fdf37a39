// SPDX-License-Identifier: Apache-2.0
// The rules that end a search from outside of its algorithm: limits, target, stagnation. They may change where a search
// goes on from a saved state, so what they are judged by is kept whether they are set or not.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "optimise/state_file.hpp"
#include "vantage/optimiser.hpp"

namespace vantage::optimise {

class StopRules {
 public:
  // To be asked after every tell(). `hypervolume` is called where a rule needs it, and once an iteration.
  StopReason judge(const OptimiserConfig& config, std::size_t evaluations, std::size_t iterations,
                   const std::function<double()>& hypervolume);

  // The hypervolumes so far do not compare with those to come.
  void begin_anew() { steps_.clear(); }

  void save(StateWriter& w) const;
  void load(StateReader& r);

 private:
  bool stagnated(const OptimiserConfig& config) const;

  // The hypervolume over the iterations, where it changed.
  struct Step {
    std::size_t iteration;
    double hypervolume;
  };
  std::vector<Step> steps_;
  std::size_t iterations_ = 0;  // of the last entry that was looked at
};

}  // namespace vantage::optimise
