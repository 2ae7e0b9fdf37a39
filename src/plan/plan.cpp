// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <utility>

#include "plan/confirm.hpp"
#include "plan/decision_space.hpp"
#include "plan/identity.hpp"
#include "plan/search.hpp"
#include "plan/simulator_evaluator.hpp"
#include "plan/site.hpp"
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

}  // namespace

PlanResult plan(Simulator& simulator, const SearchArea& area, const ClashChecker& clash, const PlanConfig& config,
                const std::function<void(const PlanProgress&)>& watch, std::stop_token stop, std::stop_token abort) {
  const auto start = std::chrono::steady_clock::now();
  const Site site = make_site(area, clash, simulator.scanner());
  const DecisionSpace space(site, config);
  SimulatorEvaluator evaluator(simulator, {.sample_voxels = config.sample_voxels,
                                           .overlap = space.needs_overlap(),
                                           .min_link_overlap = config.min_link_overlap});
  const std::size_t batch = batch_of(simulator, config);
  SearchOutcome found = search({.space = space,
                                .config = config,
                                .evaluator = evaluator,
                                .batch = batch,
                                .identity = identity(simulator, site, area, config, batch),
                                .watch = watch,
                                .stop = stop});
  const double searched = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double searched_trace = evaluator.trace_seconds();

  PlanResult result;
  result.front = confirm_front(found, space, config, evaluator, watch, abort);
  result.exact_hypervolume = judge_by_every_ray(result.front, space, config);
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
