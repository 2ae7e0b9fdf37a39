// SPDX-License-Identifier: Apache-2.0
// Feasibility first (Deb: An Efficient Constraint Handling Method for Genetic Algorithms, 2000): among networks that
// break requirements the violation decides, and only where it is equal what is searched for.
#include "plan/scaled_objectives.hpp"

namespace vantage {
namespace {

// What is left of an objective in a network that breaks a requirement: enough to order equal violations. A power of 2,
// so that it rounds nothing.
constexpr double kLeft = 1.0 / 1024;

}  // namespace

void scale_objectives(const SurveyProblem& problem, std::span<const double> x, std::span<const double> values,
                      double missed, std::span<double> f) {
  const bool by_alpha = problem.stations_min < problem.stations_max;
  for (std::size_t k = 0; k < problem.objectives.size(); ++k) {
    const Objective& objective = problem.objectives[k];
    f[k] = objective.by_alpha && by_alpha ? x.back() : objective.scaled(values[k]);
    // Above 1: outside the reference point, so without hypervolume.
    if (missed > 0) f[k] = 1 + missed + kLeft * f[k];
  }
}

std::vector<double> scaled_objectives(const SurveyProblem& problem, std::span<const double> x,
                                      std::span<const double> values) {
  std::vector<double> f(problem.objectives.size());
  scale_objectives(problem, x, values, 0, f);
  return f;
}

}  // namespace vantage
