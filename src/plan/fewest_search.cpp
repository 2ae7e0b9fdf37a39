// SPDX-License-Identifier: Apache-2.0
#include "plan/fewest_search.hpp"

#include <algorithm>

#include "search/choose_optimiser.hpp"

namespace vantage {
namespace {

// Stations that the search may trace for each traced candidate.
constexpr double kSearchShare = 2;
constexpr std::size_t kMostIterations = 100;
// Least number of networks per coordinate. With fewer, CMA-ES learns no direction and keeps the initial network.
constexpr std::size_t kLeastTries = 10;
// Initial step size: about the distance between candidates, not the size of the site.
constexpr double kRefiningSigma = 0.03;

}  // namespace

SurveyProblem with_margins(SurveyProblem problem, const FewestAsked& asked, double overstated, double link_margin) {
  for (Requirement& requirement : problem.requirements) {
    if (requirement.bound != Requirement::Bound::at_least) continue;
    const Objective& objective = requirement.objective;
    if (objective.kind == Objective::Kind::coverage)
      requirement.limit = std::min(1.0, requirement.limit + overstated / asked.of_one(objective));
    if (objective.kind == Objective::Kind::link) requirement.limit += link_margin;
  }
  return problem;
}

PlanConfig refining_config(const SurveyProblem& problem, PlanConfig config, std::size_t candidates) {
  config.sigma0 = std::min(config.sigma0, kRefiningSigma);
  if (config.iterations == 0) {
    const double stations = kSearchShare * static_cast<double>(candidates);
    const auto each = static_cast<double>(population_of(problem, config) * problem.stations_max);
    config.iterations = std::clamp<std::size_t>(static_cast<std::size_t>(stations / each), 1, kMostIterations);
  }
  return config;
}

bool worth_searching(const SurveyProblem& problem, const PlanConfig& config) {
  return !problem.pays_m2 &&
         config.iterations * population_of(problem, config) >= kLeastTries * 2 * problem.stations_max;
}

}  // namespace vantage
