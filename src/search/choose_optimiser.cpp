// SPDX-License-Identifier: Apache-2.0
#include "search/choose_optimiser.hpp"

#include <cmath>
#include <string>

#include "search/refuse.hpp"

namespace vantage {
namespace {

void check(const SurveyProblem& problem, const PlanConfig& config) {
  if (config.iterations < 1) refuse("at least one iteration is needed");
  if (problem.objectives.size() > 1 && config.population == 1) refuse("a population of 1 has no front; give 2 or more");
  if (!(config.sigma0 > 0) || !std::isfinite(config.sigma0))
    refuse("sigma0 must be above 0, not " + std::to_string(config.sigma0));
  if (!(config.max_seconds >= 0)) refuse("max_seconds must not be negative, not " + std::to_string(config.max_seconds));
}

constexpr std::size_t kRestarts = 1'000'000;  // enough to spend any budget
// One objective has converged if the possible gain is below a sample's standard error, or stations move by less than
// 1/250 of the search area.
constexpr double kCoverageTolerance = 1e-3, kStepTolerance = 0.02;

}  // namespace

std::size_t population_of(const SurveyProblem& problem, const PlanConfig& config) {
  if (config.population > 0) return config.population;
  if (problem.objectives.size() > 1) return 100;
  return problem.stations_min < problem.stations_max ? 20 : 10;
}

std::unique_ptr<Optimiser> choose_optimiser(const DecisionSpace& space, const SurveyProblem& problem,
                                            const PlanConfig& config, std::size_t batch,
                                            const std::vector<double>& start) {
  check(problem, config);
  OptimiserConfig chosen{.population = population_of(problem, config),
                         .sigma0 = config.sigma0,
                         .bounds = space.bounds(),
                         .blocks = space.blocks(),
                         .restarts = kRestarts,
                         .max_iterations = config.iterations,
                         .target_hypervolume = config.target_hypervolume,
                         .stagnation_iterations = config.stagnation_iterations,
                         .seed = config.seed.value_or(1),
                         .mo = {.scheme = config.scheme,
                                .batch = batch,
                                .recalls = config.sample_voxels > 0 && config.renew_iterations.value_or(0) > 0}};
  if (space.searches_number())
    chosen.blocks_in_use = [&space](std::span<const double> x) { return space.placed_count(x); };
  if (problem.objectives.size() == 1) {
    chosen.x_tolerance = kStepTolerance;
    chosen.cma.f_tolerance = kCoverageTolerance;
    if (!start.empty())
      chosen.start = {start};
    else if (!config.start.empty())
      chosen.start = {space.encode(config.start)};
    return std::make_unique<CmaEs>(space.dimension(), chosen);
  }
  if (!start.empty())
    chosen.start = {start};
  else if (!config.start.empty())
    chosen.start = space.encode_each(config.start);
  if (chosen.start.size() > chosen.population) chosen.start.resize(chosen.population);
  if (config.optimiser) return config.optimiser(space.dimension(), problem.objectives.size(), chosen);
  return std::make_unique<MoCmaEs>(space.dimension(), problem.objectives.size(), chosen);
}

}  // namespace vantage
