// SPDX-License-Identifier: Apache-2.0
/// Types by which a plan and an optimiser (vantage/optimiser.hpp) tell each other what they find.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vantage {

class Optimiser;
struct OptimiserConfig;

/// Why an optimiser stopped, or `running`.
enum class StopReason {
  running,            ///< It has not ended.
  max_evaluations,    ///< `OptimiserConfig::max_evaluations` is reached.
  max_iterations,     ///< `OptimiserConfig::max_iterations` is reached.
  target_reached,     ///< The target or the hypervolume that was asked for is reached.
  converged,          ///< Steps or differences fell below their tolerance.
  stagnated,          ///< No improvement for long.
  flat,               ///< The objective does not change over a whole population.
  invalid_objective,  ///< Every value of an iteration was NaN.
  ill_conditioned,    ///< The covariance's condition number passed 1e14.
  diverged,           ///< Steps grew without bound.
  max_time,           ///< The time limit of the plan is over.
  cancelled,          ///< The caller stopped it.
};
/// The name of the enumerator.
std::string to_string(StopReason);

/// One point with its objective values, all minimised.
struct ParetoPoint {
  std::vector<double> x, f;  ///< Coordinates and objective values.
};

/// Schemes of MO-CMA-ES.
enum class MoScheme {
  generational,  ///< μ offspring of μ parents each iteration, which then compete with them.
  steady_state,  ///< Offspring one at a time, or `batch` at a time, each of which competes as soon as it is evaluated.
};

/// Makes an optimiser for `dimension` coordinates and `objectives` objectives.
using OptimiserMaker = std::function<std::unique_ptr<Optimiser>(std::size_t dimension, std::size_t objectives,
                                                                const OptimiserConfig& config)>;

}  // namespace vantage
