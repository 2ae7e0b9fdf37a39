// SPDX-License-Identifier: Apache-2.0
// Feasibility first (Deb: An Efficient Constraint Handling Method for Genetic Algorithms, 2000), but infeasible
// networks keep their objectives beside the violation. With the violation alone, a population on its way to the first
// feasible network loses the variety of a front.
#include "search/scaled_objectives.hpp"

namespace vantage {
namespace {

// A violation of a tenth of a scale outweighs any gain in an objective. With 1, a search for few stations prefers fewer
// to a required coverage; with much more, it finds worse fronts.
constexpr double kWeight = 10;

}  // namespace

void scale_objectives(const SurveyProblem& problem, std::span<const double> x, std::span<const double> values,
                      double missed, std::span<double> f) {
  const bool by_alpha = problem.stations_min < problem.stations_max;
  for (std::size_t k = 0; k < problem.objectives.size(); ++k) {
    const Objective& objective = problem.objectives[k];
    f[k] = objective.by_alpha && by_alpha ? x.back() : objective.scaled(values[k]);
    // Above 1: outside the reference point, so without hypervolume.
    if (missed > 0) f[k] += 1 + kWeight * missed;
  }
}

std::vector<double> scaled_objectives(const SurveyProblem& problem, std::span<const double> x,
                                      std::span<const double> values) {
  std::vector<double> f(problem.objectives.size());
  scale_objectives(problem, x, values, 0, f);
  return f;
}

}  // namespace vantage
