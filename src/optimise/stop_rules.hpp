// SPDX-License-Identifier: Apache-2.0
// Rules that end a search from outside its algorithm: limits, target, stagnation. They may change when a search
// continues from a saved state, so their inputs are kept whether they are set or not.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "optimise/state_file.hpp"
#include "vantage/optimiser.hpp"

namespace vantage::optimise {

class StopRules {
 public:
  // To be called after every tell(). `hypervolume` is called if a rule needs it, and once per iteration.
  StopReason judge(const OptimiserConfig& config, std::size_t evaluations, std::size_t iterations,
                   const std::function<double()>& hypervolume);

  // Discards the hypervolumes so far, which do not compare with later ones.
  void begin_anew() { steps_.clear(); }

  void save(StateWriter& w) const;
  void load(StateReader& r);

 private:
  bool stagnated(const OptimiserConfig& config) const;

  // Changes of the hypervolume over the iterations.
  struct Step {
    std::size_t iteration;
    double hypervolume;
  };
  std::vector<Step> steps_;
  std::size_t iterations_ = 0;  // of the last entry examined
};

}  // namespace vantage::optimise
