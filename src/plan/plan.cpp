// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include "core/deadline.hpp"
#include "plan/drop_networks.hpp"
#include "plan/plan_context.hpp"
#include "plan/plan_fewest.hpp"
#include "plan/somewhere_to_stand.hpp"
#include "vantage/error.hpp"
#include "vantage/planner.hpp"
#include "vantage/question.hpp"

namespace vantage {
namespace {

bool needs_attainable(const SurveyProblem& problem) {
  const auto needs = [](const Objective& objective) { return objective.needs.attainable; };
  return std::ranges::any_of(problem.objectives, needs) ||
         std::ranges::any_of(problem.requirements, needs, &Requirement::objective);
}

// The problem with the scale of the number of stations in force, and `capture` as a share of attainable coverage.
SurveyProblem settled(SurveyProblem problem) {
  const auto settle = [&](Objective& objective) {
    if (objective.needs.attainable) objective = make_objective(objective.name, problem.settings());
    if (!objective.by_alpha) return;
    objective.scale = {static_cast<double>(problem.kept.size() + problem.stations_min),
                       static_cast<double>(problem.kept.size() + problem.stations_max)};
  };
  for (Objective& objective : problem.objectives) settle(objective);
  if (problem.visible)
    for (Requirement& requirement : problem.requirements)
      if (requirement.objective.needs.attainable) settle(requirement.objective);
  return problem;
}

// The scanner that sees most: what it cannot capture, none can.
std::uint32_t finest(const Simulator& simulator, std::span<const std::uint32_t> scanners) {
  if (scanners.empty()) return 0;
  for (const std::uint32_t k : scanners)
    if (k >= simulator.scanners().size())
      throw Error(Errc::invalid_argument, "plan: scanner " + std::to_string(k) + " is among those to choose, and the " +
                                              "simulator has " + std::to_string(simulator.scanners().size()) +
                                              ", counted from 0");
  return *std::ranges::max_element(scanners, {}, [&](std::uint32_t k) { return simulator.scanners()[k].rays(); });
}

// Share of the time limit for looking, choosing and searching. The rest is for tracing every ray of the results.
constexpr double kSearchTimeShare = 0.8;
// More are tried only around the chosen stations.
constexpr std::size_t kMostCandidates = 512;
// A front with more entries gets a round only for its answer.
constexpr std::size_t kMostRounds = 16;

void work_out_rounds(PlanResult& result, PlanContext& context) {
  if (result.front.empty()) return;
  const std::size_t chosen = answer(result), kept = result.problem.kept.size();
  for (std::size_t k = 0; k < result.front.size(); ++k) {
    PlanEntry& entry = result.front[k];
    if (k == chosen || result.front.size() <= kMostRounds)
      entry.visit = context.on_site().visit(std::span(entry.stations).subspan(kept));
  }
}

// Stops at the limits too, and reports no longer times than they leave.
PlanWatch limited(const PlanWatch& watch, const Deadline& search_by, const Deadline& all_by) {
  PlanWatch own{.report = {}, .stop = search_by.stop(), .abort = all_by.stop()};
  if (watch.report) {
    own.report = [&](const PlanProgress& now) {
      PlanProgress told = now;
      const Deadline& end = now.phase == "confirm" ? all_by : search_by;
      told.seconds_left = std::min(now.seconds_left, end.seconds_left());
      if (now.whole_seconds_left) told.whole_seconds_left = std::min(*now.whole_seconds_left, all_by.seconds_left());
      watch.report(told);
    };
  }
  return own;
}

}  // namespace

PlanResult plan(Simulator& simulator, const SearchArea& area, const ClashChecker& clash, const SurveyProblem& asked,
                const PlanConfig& wanted, const PlanWatch& given) {
  const PlanConfig config = settled(wanted, asked, simulator.voxel_count(), simulator.config().seed);
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const Deadline search_by(kSearchTimeShare * config.max_seconds, given.stop), all_by(config.max_seconds, given.abort);
  const PlanWatch watch = limited(given, search_by, all_by);
  const auto since = [](Clock::time_point then) { return std::chrono::duration<double>(Clock::now() - then).count(); };
  SurveyProblem problem = asked;
  std::vector<double> heights{simulator.scanner().height_m};
  if (problem.heights_m) heights.assign(problem.heights_m->begin(), problem.heights_m->end());
  require_somewhere_to_stand(area, clash, heights);
  std::shared_ptr<const Candidates> candidates;
  double candidates_seconds = 0;
  const bool limit_wanted = !problem.visible && needs_attainable(problem);
  if (problem.fewest || limit_wanted) {
    const auto report = [&](double done) {
      if (!watch.report) return;
      const double seconds = since(start);
      watch.report({.seconds_left = done > 0 ? seconds / done - seconds : -1, .phase = "look"});
    };
    candidates = std::make_shared<const Candidates>(find_candidates(simulator, area, clash,
                                                                    {.most = kMostCandidates,
                                                                     .sample_voxels = config.sample_voxels,
                                                                     .scanner = finest(simulator, problem.scanners)},
                                                                    {.report = report, .stop = watch.stop}));
    candidates_seconds = since(start);
    if (watch.report && candidates->ended() != "cancelled")
      watch.report({.evaluations = candidates->stations().size(),
                    .seconds_left = -1,
                    .phase = "look",
                    .visible = candidates->visible().value});
    // Nothing is attainable: every network captures all of it.
    if (limit_wanted) problem.visible = candidates->visible().value > 0 ? candidates->visible().value : 1;
  }
  problem = settled(std::move(problem));
  PlanContext context(simulator, area, clash, config);
  context.ask(problem);
  PlanResult result;
  if (problem.fewest) {
    result = plan_fewest(context, simulator, candidates, candidates_seconds, config, watch);
    result.seconds = since(start);
    result.trace_seconds = context.evaluator().trace_seconds();
  } else {
    const SearchOutcome found = context.search(problem, config, {}, watch);
    const auto searched = Clock::now();
    const double searched_trace = context.evaluator().trace_seconds();
    result = context.result(found);
    ConfirmedFront confirmed = context.confirm(found, problem, watch);
    result.front = std::move(confirmed.entries), result.spared = confirmed.spared;
    drop_networks(result.front, problem);
    result.exact_hypervolume = judge_by_every_ray(result.front, problem, context.measures());
    if (config.renew_iterations.value_or(0) > 0) keep_undominated(result.front, problem, context.measures());
    result.seconds = found.seconds + since(searched);
    result.trace_seconds = found.trace_seconds + context.evaluator().trace_seconds() - searched_trace;
  }
  if (result.stop_reason == StopReason::cancelled && search_by.passed()) result.stop_reason = StopReason::max_time;
  result.candidates = std::move(candidates);
  if (!watch.abort.stop_requested()) work_out_rounds(result, context);
  return result;
}

}  // namespace vantage
