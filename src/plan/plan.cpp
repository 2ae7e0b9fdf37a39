// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <utility>

#include "plan/choose_optimiser.hpp"
#include "plan/confirm.hpp"
#include "plan/decision_space.hpp"
#include "plan/identity.hpp"
#include "plan/measures.hpp"
#include "plan/search.hpp"
#include "plan/simulator_evaluator.hpp"
#include "plan/site.hpp"
#include "plan/somewhere_to_stand.hpp"
#include "vantage/planner.hpp"

namespace vantage {
namespace {

// Offspring at once in the steady state. Every one more is a step further from the textbook's one at a time, so no more
// than the engine needs to be kept busy: a whole network with every ray keeps any engine busy, a sampled one only a
// CPU.
std::size_t batch_of(const Simulator& simulator, const PlanConfig& config) {
  if (config.batch > 0) return config.batch;
  if (config.sample_voxels == 0) return 1;
  const bool cpu = simulator.engine().engine == Engine::embree || simulator.engine().software;
  return cpu ? 4 : 32;
}

// What a problem says, with the scale of the number of stations as it is.
SurveyProblem settled(SurveyProblem problem) {
  for (Objective& objective : problem.objectives) {
    if (!objective.by_alpha) continue;
    objective.best = static_cast<double>(problem.kept.size() + problem.stations_min);
    objective.worst = static_cast<double>(problem.kept.size() + problem.stations_max);
  }
  return problem;
}

}  // namespace

PlanResult plan(Simulator& simulator, const SearchArea& area, const ClashChecker& clash, const SurveyProblem& asked,
                const PlanConfig& config, const PlanWatch& watch) {
  const auto start = std::chrono::steady_clock::now();
  const SurveyProblem problem = settled(asked);
  const Measures measures = measures_of(problem);
  std::vector<double> heights{simulator.scanner().height_m};
  if (problem.heights_m) heights.assign(problem.heights_m->begin(), problem.heights_m->end());
  require_somewhere_to_stand(area, clash, heights);
  const Site site = make_site(area, clash, simulator.scanner());
  const DecisionSpace space(site, problem);
  SimulatorEvaluator evaluator(
      simulator, measures,
      {.sample_voxels = config.sample_voxels,
       .kept = problem.kept.size(),
       .visible_parts = [&](const Network& network) { return visibility_parts(site, network); }});
  const std::size_t batch = batch_of(simulator, config);
  SearchOutcome found = search(
      {.space = space,
       .problem = problem,
       .measures = measures,
       .config = config,
       .evaluator = evaluator,
       .batch = batch,
       .identity = identity(simulator, site, area, clash, problem, config, population_of(problem, config), batch),
       .watch = watch.report,
       .stop = watch.stop});
  const double searched = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double searched_trace = evaluator.trace_seconds();

  PlanResult result;
  result.problem = problem, result.config = config;
  result.population = population_of(problem, config), result.batch = batch;
  result.walkable = area.options(), result.security = clash.volume();
  result.measures = measures.all;
  result.front = confirm_front(found, space, problem, measures, config.sample_voxels > 0, evaluator, watch);
  result.exact_hypervolume = judge_by_every_ray(result.front, problem, measures);
  result.history = std::move(found.history);
  result.hypervolume = found.hypervolume;
  result.evaluations = found.evaluations, result.resumed_evaluations = found.resumed_evaluations;
  result.drawn = found.drawn, result.redrawn = found.redrawn;
  result.stop_reason = found.stop_reason;
  result.seconds =
      found.seconds + std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() - searched;
  result.trace_seconds = found.trace_seconds + evaluator.trace_seconds() - searched_trace;
  return result;
}

}  // namespace vantage
