// SPDX-License-Identifier: Apache-2.0
#include "optimise/stop_rules.hpp"

#include <algorithm>
#include <optional>

namespace vantage::optimise {

StopReason StopRules::judge(const OptimiserConfig& config, std::size_t evaluations, std::size_t iterations,
                            const std::function<double()>& hypervolume) {
  std::optional<double> now;
  if (iterations != iterations_) {
    now = hypervolume();
    if (steps_.empty() || steps_.back().hypervolume != *now) steps_.push_back({iterations, *now});
    iterations_ = iterations;
  }
  if (config.max_evaluations != 0 && evaluations >= config.max_evaluations) return StopReason::max_evaluations;
  if (config.max_iterations != 0 && iterations >= config.max_iterations) return StopReason::max_iterations;
  if (config.target_hypervolume && evaluations > 0) {
    if (!now) now = hypervolume();
    if (*now >= *config.target_hypervolume) return StopReason::target_reached;
  }
  return stagnated(config) ? StopReason::stagnated : StopReason::running;
}

bool StopRules::stagnated(const OptimiserConfig& config) const {
  const std::size_t wanted = config.stagnation_iterations;
  if (wanted == 0 || iterations_ <= wanted) return false;
  const auto after = std::upper_bound(steps_.begin(), steps_.end(), iterations_ - wanted,
                                      [](std::size_t iteration, const Step& s) { return iteration < s.iteration; });
  if (after == steps_.begin()) return false;  // the first batch was longer than an iteration
  const double now = steps_.back().hypervolume, then = std::prev(after)->hypervolume;
  return now - then <= config.stagnation_tolerance * now;
}

void StopRules::save(StateWriter& w) const {
  w.put(std::uint64_t{iterations_});
  w.put(std::uint64_t{steps_.size()});
  for (const Step& s : steps_) {
    w.put(std::uint64_t{s.iteration});
    w.put(s.hypervolume);
  }
}

void StopRules::load(StateReader& r) {
  constexpr std::size_t kMany = std::size_t{1} << 62;
  iterations_ = r.size(kMany);
  steps_.resize(r.length(9));
  for (Step& s : steps_) s = {r.size(kMany), r.finite()};
}

}  // namespace vantage::optimise
