// SPDX-License-Identifier: Apache-2.0
#include "plan/choose_optimiser.hpp"

namespace vantage {
namespace {

constexpr std::size_t kRestarts = 1'000'000;  // enough to spend any budget
// When one objective is at rest: less is to be gained than a sample's standard error, or stations move by less than
// 1/250 of the search area.
constexpr double kCoverageTolerance = 1e-3, kStepTolerance = 0.02;

}  // namespace

std::size_t population_of(const PlanConfig& config) {
  if (config.population > 0) return config.population;
  if (config.fitness) return 20;
  return has_one_objective(config) ? 10 : 100;
}

std::unique_ptr<Optimiser> choose_optimiser(const DecisionSpace& space, const PlanConfig& config, std::size_t batch) {
  OptimiserConfig chosen{.population = population_of(config),
                         .sigma0 = config.sigma0,
                         .bounds = space.bounds(),
                         .blocks = space.blocks(),
                         .restarts = kRestarts,
                         .max_iterations = config.iterations,
                         .target_hypervolume = config.target_hypervolume,
                         .stagnation_iterations = config.stagnation_iterations,
                         .seed = config.seed,
                         .mo = {.scheme = config.scheme, .batch = batch}};
  if (space.minimises_stations())
    chosen.blocks_in_use = [&space](std::span<const double> x) { return space.placed_count(x); };
  if (has_one_objective(config)) {
    chosen.x_tolerance = kStepTolerance;
    chosen.cma.f_tolerance = kCoverageTolerance;
    if (!config.start.empty()) chosen.start = {space.encode(config.start)};
    return make_optimiser(MoAlgorithm::cma_es, space.dimension(), 1, chosen);
  }
  if (!config.start.empty()) chosen.start = space.encode_each(config.start);
  if (chosen.start.size() > chosen.population) chosen.start.resize(chosen.population);
  return make_optimiser(config.algorithm, space.dimension(), space.objectives(), chosen);
}

}  // namespace vantage
