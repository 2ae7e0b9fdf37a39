// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <optional>
#include <string>
#include <utility>

#include "candidates/somewhere_to_stand.hpp"
#include "candidates/spread_positions.hpp"
#include "core/deadline.hpp"
#include "core/first_numbers.hpp"
#include "core/seconds_since.hpp"
#include "cover/tabu_search.hpp"
#include "plan/check_problem.hpp"
#include "plan/complete_front.hpp"
#include "plan/drop_networks.hpp"
#include "plan/limits.hpp"
#include "plan/plan_context.hpp"
#include "plan/plan_fewest.hpp"
#include "plan/plan_time.hpp"
#include "plan/what_pays.hpp"
#include "vantage/candidates.hpp"
#include "vantage/error.hpp"
#include "vantage/planner.hpp"

namespace vantage {
namespace {

// Returns the problem with its actual scale of stations, and with `capture` relative to what is attainable.
SurveyProblem with_scales(SurveyProblem problem) {
  const auto settle = [&](Objective& objective) {
    if (objective.needs.attainable) objective = make_objective(objective.name, problem.settings());
    if (!objective.by_alpha) return;
    objective.scale = {static_cast<double>(problem.existing.size() + problem.stations_min),
                       static_cast<double>(problem.existing.size() + problem.stations_max)};
  };
  for (Objective& objective : problem.objectives) settle(objective);
  if (problem.attainable)
    for (Requirement& requirement : problem.requirements)
      if (requirement.objective.needs.attainable) settle(requirement.objective);
  return problem;
}

// Index of the scanner with most rays: what it cannot capture, none can.
std::uint32_t finest(const Simulator& simulator, std::span<const std::uint32_t> scanners) {
  if (scanners.empty()) return 0;
  return *std::ranges::max_element(scanners, {}, [&](std::uint32_t k) { return simulator.scanners()[k].rays(); });
}

// Shares of a plan's time limit by which candidates are found, and by which the second sample of voxels is counted from
// them. The rest is for links, the search and what follows.
constexpr double kCandidatesTimeShare = 0.25, kCountedTimeShare = 0.5;
// Most candidates of a site without much ground. Later stages add more around the chosen stations.
constexpr std::size_t kMostCandidates = 4096;
// Ground for each candidate of a larger site, so that every place is within some metres of one.
constexpr double kGroundPerCandidate_m2 = 16;
// The choice of a number of stations has `kLargerSample` times as many voxels as a search, up to this much ground. On
// more ground it has proportionally more, up to `kMostSamples` times, since each candidate is traced on all.
constexpr std::uint64_t kLargerSample = 5;
constexpr double kGroundOfSample_m2 = 8000, kMostSamples = 4;

// Size of the sample that the number of stations is chosen on. It is larger than a search's, since thousands compete. A
// site with at most twice as many voxels uses all, since as many others have to confirm the network.
std::uint64_t sample_of_choice(const SurveyProblem& problem, const PlanConfig& config, Site& site) {
  const Simulator& simulator = site.simulator();
  std::uint64_t sample = config.sample_voxels;
  if (problem.fewest) {
    const double samples = std::clamp(ground_area_m2(site.area().mesh()) / kGroundOfSample_m2, 1.0, kMostSamples);
    sample = static_cast<std::uint64_t>(static_cast<double>(sample * kLargerSample) * samples);
  }
  return config.exact || 2 * sample >= simulator.voxel_count() ? every_voxel : sample;
}

// Counts what candidates and existing stations can attain, on the voxels that networks are chosen on, and on as many
// others that confirm them. On a site of few voxels, both use all of them.
void count_attainable(PlanContext& context, Simulator& simulator, const SurveyProblem& problem,
                      const Candidates& candidates, std::uint64_t searched, const Progress& progress) {
  const Network existing = to_network(existing_stations(context.oracle(), problem.existing, problem.existing_setups));
  context.chosen = candidates.attainable_counts();
  const std::vector<std::string> meshes = meshes_asked_for(problem);
  for (const std::string& some : meshes) context.chosen.tell_of(simulator, some);
  raise_attainable(context.chosen, simulator, existing, progress);
  const std::uint64_t sample = context.chosen.sample_voxels();
  context.searched = context.chosen.part(simulator, searched > 0 ? std::min(searched, sample) : sample);
  if (sample >= simulator.voxel_count()) {
    context.confirmed = context.chosen;
    return;
  }
  context.confirmed = AttainableCounts(simulator, sample, sample);
  for (const std::string& some : meshes) context.confirmed.tell_of(simulator, some);
  Network all = to_network(candidates.stations());
  all.insert(all.end(), existing.begin(), existing.end());
  // If there is no time for it, networks are confirmed on the voxels that they were chosen on.
  if (!raise_attainable(context.confirmed, simulator, all, progress)) context.confirmed = context.chosen;
}

std::size_t most_candidates(Site& site) {
  const double by_ground = ground_area_m2(site.area().mesh()) / kGroundPerCandidate_m2;
  return std::max(kMostCandidates, static_cast<std::size_t>(by_ground));
}

// Least floor of a room, or of another part, that gets a station of its own.
constexpr double kLeastFloorOfUnit_m2 = 2;

// Finds candidates. If a measure needs it, counts what is attainable, and sets it in the problem.
std::shared_ptr<const Candidates> look_for_candidates(PlanContext& context, Site& site, SurveyProblem& problem,
                                                      const PlanConfig& config, double max_seconds,
                                                      const PlanWatch& watch) {
  Simulator& simulator = site.simulator();
  const auto begun = std::chrono::steady_clock::now();
  const auto report = [&](double done) {
    if (!watch.report) return;
    const double seconds = seconds_since(begun);
    watch.report({.seconds_left = done > 0 ? seconds / done - seconds : -1, .phase = "look"});
  };
  const auto candidates =
      std::make_shared<const Candidates>(find_candidates(site,
                                                         {.most = most_candidates(site),
                                                          .sample_voxels = sample_of_choice(problem, config, site),
                                                          .scanner = finest(simulator, context.oracle().scanners),
                                                          .max_seconds = kCandidatesTimeShare * max_seconds},
                                                         {.report = report, .stop = watch.stop}));
  const bool limit_wanted = needs_attainable(problem);
  if (limit_wanted) {
    const double left = kCountedTimeShare * max_seconds - seconds_since(begun);
    const Deadline counted_by(max_seconds > 0 ? std::max(left, 0.1) : 0, watch.stop);
    count_attainable(context, simulator, problem, *candidates, config.sample_voxels, {.stop = counted_by.stop()});
  }
  const double attainable = limit_wanted ? context.confirmed.coverage().value : candidates->attainable().value;
  if (watch.report && candidates->ended() != "cancelled")
    watch.report(
        {.evaluations = candidates->stations().size(), .seconds_left = -1, .phase = "look", .attainable = attainable});
  // Nothing is attainable: every network captures all of nothing.
  if (limit_wanted) problem.attainable = attainable > 0 ? attainable : 1;
  return candidates;
}

// Columns of stations, then of the candidates, with attainable counts as goals; fewer if stopped.
CoverageMatrix columns_with(std::span<const PlacedStation> stations, const PlanContext& context, Simulator& simulator,
                            const Candidates& candidates, const Progress& progress) {
  const SampledCoverage& known = candidates.coverage();
  SampledCoverage columns = sample_coverage(simulator, stations, known.sample_voxels(), progress);
  columns.append(known);
  CoverageMatrix matrix = columns.matrix();
  matrix.set_goals(context.chosen.counts());
  return matrix;
}

// Raises the required capture to what the stations that pay can capture.
void require_what_pays(SurveyProblem& problem, PlanContext& context, Site& site, const Candidates& candidates,
                       const Progress& progress) {
  if (!problem.pays_m2 || candidates.coverage().size() == 0) return;
  std::vector<PlacedStation> stations = existing_stations(context.oracle(), problem.existing, problem.existing_setups);
  const std::size_t kept = stations.size();
  const CoverageMatrix matrix = columns_with(stations, context, site.simulator(), candidates, progress);
  if (matrix.candidates() < kept + candidates.coverage().size()) return;
  stations.insert(stations.end(), candidates.stations().begin(), candidates.stations().end());
  const double metre = site.length_scale(), least_m2 = *problem.pays_m2;
  context.to_visit.emplace(
      UnitsToVisit{.units = FloorUnits(site.scene(), site.area(), kLeastFloorOfUnit_m2 * metre * metre),
                   .least_m2 = kLeastOfUnit * least_m2,
                   .element_m2 = surveyed_area_m2(site.scene()) / static_cast<double>(matrix.elements())});
  const CoverProblem asked{
      .matrix = matrix, .existing = first_numbers(kept), .fewest = problem.stations_min, .most = problem.stations_max};
  StationsThatPay pays = stations_that_pay(asked, context.to_visit->element_m2, {least_m2, problem.pays_share},
                                           context.to_visit->units.stations_in(stations));
  pays.capture = rounded_down(pays.capture);
  for (Requirement& requirement : problem.requirements)
    if (requires_capture(requirement)) {
      context.asked_capture = std::max(context.asked_capture, requirement.limit);
      requirement.limit = std::max(requirement.limit, pays.capture);
    }
  context.pays = pays;
}

// Share of what is attainable that pays, but may be left out without a message if no link reaches it.
constexpr double kLittleUnlinked = 0.02;

// Lowers the required capture to that of the answer, but not below the problem's own. It does so if a limit on stations
// or on time on site ended the plan before all stations that pay were placed, or if missing links leave out only little
// that pays.
void require_no_more_than_answer(PlanResult& result, const SurveyProblem& asked, const Measures& measures) {
  if (!result.pays || result.front.empty()) return;
  const PlanEntry& entry = result.front[answer(result)];
  const bool all_placed = entry.stations.size() - asked.existing.size() >= asked.stations_max;
  const double captured = entry.value("capture");
  if (std::isnan(captured)) return;
  const bool cut_short = result.stop_reason == StopReason::max_time || result.stop_reason == StopReason::cancelled,
             little = !cut_short && result.pays->capture - captured <= kLittleUnlinked;
  if (!all_placed && !little && !limit_of(asked, Objective::Kind::time, Requirement::Bound::at_most)) return;
  for (std::size_t k = 0; k < asked.requirements.size(); ++k)
    if (Requirement& requirement = result.problem.requirements[k];
        requires_capture(requirement) && requirement.limit > captured)
      requirement.limit = std::max(asked.requirements[k].limit, rounded_down(captured));
  result.exact_hypervolume = judge_by_every_ray(result.front, result.problem, measures);
}

// Counts one station with every ray, so that the watch knows how long that takes.
void time_a_station(PlanContext& context, Simulator& simulator, const PlanWatch& watch) {
  const std::vector<PlacedStation> one =
      spread_positions(context.oracle(), context.area().mesh(), context.oracle().height_m, 1).stations;
  if (one.empty()) return;
  Simulator* const around = context.measures().all_needs().surroundings ? &context.surroundings() : nullptr;
  const auto begun = std::chrono::steady_clock::now();
  for (Simulator* const counting : {&simulator, around})
    if (counting && counting->evaluate(to_network(one), {}, {.stop = watch.stop}).cancelled) return;
  watch.seconds_after(context.problem().existing.size() + context.problem().stations_max, seconds_since(begun));
}

}  // namespace

PlanResult plan(Site& site, const SurveyProblem& asked, const PlanConfig& wanted, const PlanWatch& given) {
  using Clock = std::chrono::steady_clock;
  check_problem(site, asked);
  check_search(site, wanted);
  const auto start = Clock::now();
  PlanTime time(wanted.max_seconds, given);  // building the site's missing parts is part of it
  const PlanWatch watch = time.watch();
  const std::vector<std::uint32_t> scanners = equip(site, asked);
  Simulator& simulator = site.simulator();
  const PlanConfig config = settled(wanted, asked, simulator.voxel_count(), simulator.config().seed);
  const Work before = site.work();
  const std::uint64_t swaps = swaps_made();
  SurveyProblem problem = asked;
  std::vector<double> heights{simulator.scanner().height_m};
  if (problem.heights_m) heights.assign(problem.heights_m->begin(), problem.heights_m->end());
  require_somewhere_to_stand(site, heights);
  PlanContext context(site, config, scanners);
  std::future<void> surroundings;  // put together while candidates are found
  if (asks_for(problem, &RequiredInputs::surroundings))
    surroundings = std::async(std::launch::async, [&] { site.surroundings(); });
  const bool limit_wanted = needs_attainable(problem);
  std::shared_ptr<const Candidates> candidates;
  if (problem.fewest || limit_wanted)
    candidates = look_for_candidates(context, site, problem, config, time.seconds(), watch);
  if (candidates) require_what_pays(problem, context, site, *candidates, {.stop = watch.abort});
  problem = with_scales(std::move(problem));
  if (surroundings.valid()) surroundings.get();
  context.ask(problem);
  PlanResult result;
  if (problem.fewest) {
    result = plan_fewest(context, simulator, candidates, config, watch);
    result.seconds = seconds_since(start);
    result.trace_seconds = context.evaluator().trace_seconds();
  } else {
    if (time.limited()) time_a_station(context, simulator, watch);
    const SearchOutcome found = context.search(problem, config, {}, watch);
    const auto searched = Clock::now();
    const double searched_trace = context.evaluator().trace_seconds();
    result = context.result(found);
    ConfirmedFront confirmed = context.confirm(found, problem, watch);
    result.front = std::move(confirmed.entries), result.spared = confirmed.spared;
    drop_networks(result.front, problem);
    result.exact_hypervolume = judge_by_every_ray(result.front, problem, context.measures());
    if (config.renew_iterations.value_or(0) > 0) keep_undominated(result.front, problem, context.measures());
    result.seconds = found.seconds + seconds_since(searched);
    result.trace_seconds = found.trace_seconds + context.evaluator().trace_seconds() - searched_trace;
  }
  if (result.stop_reason == StopReason::cancelled && time.search_ended()) result.stop_reason = StopReason::max_time;
  result.candidates = std::move(candidates);
  result.pays = context.pays;
  complete_front(result, context, site, {.stop = watch.abort});
  require_no_more_than_answer(result, asked, context.measures());
  result.work = site.work() - before, result.work.choice_steps = 2 * (swaps_made() - swaps);  // one joins, one leaves
  return result;
}

}  // namespace vantage
