// SPDX-License-Identifier: Apache-2.0
#include "plan/plan_context.hpp"

#include <algorithm>

#include "candidates/spread_positions.hpp"
#include "search/choose_optimiser.hpp"
#include "search/identity.hpp"

namespace vantage {
namespace {

// Scan overlap is a share of a scan, which has some thousand of these voxels: known to 0.01.
constexpr std::uint64_t kSurroundingsVoxels = 10'000;
// Ground of a site on which a scan has that many of them. On a larger site the sample for links has as many voxels per
// square metre.
constexpr double kGroundOfLinks_m2 = 4000;

}  // namespace

// The textbook's steady state has one offspring at a time, so the batch is no larger than keeps the engine busy. A
// whole network with every ray keeps any engine busy, a sampled one only a CPU.
std::size_t batch_of(const Simulator& simulator, const PlanConfig& config) {
  if (config.batch > 0) return config.batch;
  if (config.sample_voxels == 0) return 1;
  const bool cpu = simulator.engine().engine == Engine::embree || simulator.engine().software;
  return cpu ? 4 : 32;
}

PlanContext::PlanContext(Site& site, const PlanConfig& config, std::vector<std::uint32_t> scanners)
    : site_(site), simulator_(site.simulator()), config_(config), oracle_(make_placement_oracle(site)) {
  oracle_.scanners = std::move(scanners);
}

void PlanContext::ask(const SurveyProblem& problem) {
  problem_ = problem;
  measures_ = measures_of(problem);
  const RequiredInputs needs = measures_.all_needs();
  EvaluationOptions options = evaluation_options(problem);
  if (needs.registration) options.registration = problem.registration;
  evaluator_.emplace(EvaluationSite{.simulator = simulator_,
                                    .surroundings = needs.surroundings ? &surroundings() : nullptr,
                                    .on_site = needs.time ? &on_site() : nullptr,
                                    .clash = &site_.clash()},
                     measures_, std::move(options),
                     SimulatorEvaluator::Attainable{.searched = &searched, .confirmed = &confirmed},
                     surroundings_voxels());
}

const OnSite& PlanContext::on_site() {
  if (!on_site_) on_site_ = site_.on_site(problem_.on_site);
  return *on_site_;
}

std::uint64_t PlanContext::surroundings_voxels() const { return std::min(config_.sample_voxels, kSurroundingsVoxels); }

std::uint64_t PlanContext::link_voxels() const {
  const double samples = std::max(ground_area_m2(site_.area().mesh()) / kGroundOfLinks_m2, 1.0);
  return static_cast<std::uint64_t>(static_cast<double>(surroundings_voxels()) * samples);
}

SearchOutcome PlanContext::search(const SurveyProblem& narrowed, const PlanConfig& config,
                                  const std::vector<double>& start, const PlanWatch& watch) {
  const DecisionSpace space(oracle_, narrowed);
  const std::unique_ptr<SearchEvaluator> searched = make_search_evaluator(*evaluator_, config, measures_.searched);
  const std::size_t batch = batch_of(simulator_, config);
  return vantage::search({.space = space,
                          .problem = narrowed,
                          .measures = measures_,
                          .config = config,
                          .evaluator = *searched,
                          .batch = batch,
                          .identity = identity(site_, narrowed, config, population_of(narrowed, config), batch),
                          .start = start,
                          .watch = watch.report,
                          .warn = simulator_.config().warn,
                          .stop = watch.stop});
}

ConfirmedFront PlanContext::confirm(const SearchOutcome& found, const SurveyProblem& narrowed, const PlanWatch& watch) {
  const DecisionSpace space(oracle_, narrowed);
  return confirm_front(found, space, narrowed, measures_, config_.sample_voxels, *evaluator_, watch);
}

PlanResult PlanContext::result(const SearchOutcome& found) {
  PlanResult result;
  result.problem = problem_, result.config = config_;
  result.population = population_of(problem_, config_), result.batch = batch_of(simulator_, config_);
  result.scene = site_.scene();
  result.area = site_.area();
  result.walkable = site_.area().options(), result.security = site_.clash().volume();
  result.scanners.assign(simulator_.scanners().begin(), simulator_.scanners().end());
  result.measures = measures_.all;
  result.history = found.history;
  result.hypervolume = found.hypervolume;
  result.evaluations = found.evaluations, result.resumed_evaluations = found.resumed_evaluations;
  result.drawn = found.drawn, result.redrawn = found.redrawn;
  result.stop_reason = found.stop_reason;
  return result;
}

}  // namespace vantage
