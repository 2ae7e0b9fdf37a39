// SPDX-License-Identifier: Apache-2.0
// First how many, then where. The plan traces candidates, chooses the fewest stations among them, tries more candidates
// around these, and verifies the choice by every ray. From there the optimiser searches for the best network of that
// number. The answer is the best network that was evaluated with every ray.
#include "plan/plan_fewest.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "core/seconds_since.hpp"
#include "plan/fewest_search.hpp"
#include "plan/fewest_verify.hpp"
#include "plan/spread_positions.hpp"

namespace vantage {
namespace {

// Margin of a choice, in standard errors of the sample's coverage, so that most choices hold with every ray.
constexpr double kMarginErrors = 1;
// Radius of the first round of refinement, in distances between candidates; halved in each round.
constexpr double kAroundRadius = 0.8;
// Largest number of repairs of a choice, and of new choices by the known error of the sample.
constexpr std::size_t kRepairs = 3;

// Makes tables of stations, with a column for each on a sample of this many voxels.
class TableMaker {
 public:
  TableMaker(PlanContext& context, Simulator& simulator) : simulator_(simulator) {
    const FewestAsked asked = fewest_asked(context.problem());
    apart_m_ = asked.apart_m;
    const bool link_is_objective = std::ranges::any_of(
        context.problem().objectives, [](const Objective& o) { return o.kind == Objective::Kind::link; });
    if (asked.link <= 0 && !link_is_objective) return;
    const std::uint64_t sample = context.surroundings_voxels();
    surroundings_ = columns_of(context.surroundings(), sample > 0 ? sample : std::numeric_limits<std::uint32_t>::max());
  }
  CandidateTable operator()(std::uint64_t sample_voxels) const {
    return {columns_of(simulator_, sample_voxels), surroundings_, apart_m_};
  }

 private:
  Simulator& simulator_;
  TraceColumns surroundings_;
  double apart_m_ = 0;
};

// Reports the progress of the plan.
class FewestReport {
 public:
  explicit FewestReport(const PlanWatch& watch) : watch_(watch) {}

  std::uint64_t traced = 0;  // stations

  bool stopped() const { return watch_.stop.stop_requested() || watch_.abort.stop_requested(); }
  void operator()(const char* phase, std::optional<double> whole_seconds_left = {}) const {
    if (watch_.report)
      watch_.report(
          {.evaluations = traced, .seconds_left = -1, .phase = phase, .whole_seconds_left = whole_seconds_left});
  }
  Progress progress(const char* phase) const {
    return {.report = [this, phase](double) { (*this)(phase); }, .stop = watch_.stop};
  }

 private:
  const PlanWatch& watch_;
};

VisitTime visit_time(PlanContext& context, const FewestAsked& asked) {
  if (!asked.minutes) return {};  // avoids making the walking graph for nothing
  const OnSite& on_site = context.on_site();
  return {.each_min = on_site.minutes_per_scan() + on_site.options().set_up_min + on_site.options().photos_min,
          .minutes = [&on_site](std::span<const PlacedStation> placed) { return on_site.visit(placed).minutes; }};
}

// Looks, chooses and refines. Returns no stations if the time was over before.
FewestChoice choose_number(PlanContext& context, Simulator& simulator, const Candidates& candidates,
                           double candidates_seconds, const PlanConfig& config, const PlanWatch& watch,
                           FewestReport& report) {
  using Clock = std::chrono::steady_clock;
  const SurveyProblem& problem = context.problem();
  const std::uint64_t sample = config.sample_voxels > 0 ? config.sample_voxels : simulator.voxel_count();
  const TableMaker make_table(context, simulator);
  FewestChoice choice{.asked = fewest_asked(problem), .table = make_table(sample)};
  choice.margins.coverage = kMarginErrors * candidates.visible().standard_error;

  auto begun = Clock::now();
  std::vector<PlacedStation> existing = existing_stations(context.oracle(), problem.kept, problem.kept_setups);
  for (PlacedStation& station : existing)
    if (active(station)) station.status = StationStatus::ok;  // others are not traced
  look(choice.table, existing, candidates.stations(), candidates.coverage().matrix(), report.progress("look"),
       watch.abort);
  report.traced += choice.table.stations().size();
  if (choice.table.stations().size() <= existing.size()) return choice;
  const auto looked_at = static_cast<double>(std::max<std::size_t>(candidates.stations().size(), 1));
  StageTimes times{.look_s = candidates_seconds / looked_at};
  times.station_s = times.look_s + seconds_since(begun) / looked_at;

  report("choose");
  choose(choice, visit_time(context, choice.asked), watch.stop);
  for (std::size_t round = 0; round < kRounds && !report.stopped(); ++round) {
    begun = Clock::now();
    const std::size_t before = choice.table.stations().size();
    const double radius_m = kAroundRadius * std::ldexp(std::max(candidates.spacing_m(), 0.1), -static_cast<int>(round));
    refine_around(choice, context.oracle(), radius_m, report.progress("choose"));
    const std::size_t tried = choice.table.stations().size() - before;
    report.traced += tried;
    if (round > 0 || !watch.report || report.stopped() || choice.placed() == 0) continue;
    times.round_s = seconds_since(begun), times.round_stations = tried;
    const SurveyProblem narrowed = with_stations(problem, choice.placed());
    if (const auto seconds =
            expected_seconds(choice, narrowed, refining_config(narrowed, config, candidates.stations().size()),
                             context.evaluator(), times, watch))
      report("choose", seconds);
  }
  if (const std::uint64_t larger = std::min(kLargerSample * sample, simulator.voxel_count()); larger > sample) {
    const double sharper = std::sqrt(static_cast<double>(sample) / static_cast<double>(larger));
    report.traced += refine_on_larger_sample(choice, make_table(larger), choice.margins.coverage * sharper,
                                             report.progress("choose"), watch.abort);
  }
  return choice;
}

// Verifies the choice and repairs it if it is not feasible by every ray; otherwise tries fewer stations. Returns the
// overstatement of its coverage by the sample of a search.
double verify_and_repair(FewestChoice& choice, VerifiedNetworks& verified, const PlanWatch& watch,
                         const FewestReport& report) {
  const auto least_violation = [&] {
    const PlanEntry* best = verified.best();
    return best ? best->violation : std::numeric_limits<double>::infinity();
  };
  double overstated = verify(choice, verified);
  for (std::size_t k = 0; k < kRepairs && least_violation() > 0 && !report.stopped(); ++k) {
    if (!repair(choice, verified, watch.stop)) break;
    overstated = verify(choice, verified);
  }
  for (std::size_t k = 0; k < kRepairs && least_violation() == 0 && !report.stopped(); ++k)
    if (!choose_by_known_error(choice, verified, overstated, watch.stop)) break;
  return overstated;
}

// Searches for the best network with the number of stations of the chosen one, starting from it.
SearchOutcome search_from(const FewestChoice& choice, PlanContext& context, double overstated, std::size_t candidates,
                          const PlanConfig& config, const PlanWatch& watch, const FewestReport& report) {
  SearchOutcome found;
  const SurveyProblem asked =
      with_margins(with_stations(context.problem(), choice.placed()), overstated, choice.margins.link);
  const std::vector<double> start = DecisionSpace(context.oracle(), asked).encode(choice.placed_of(choice.network));
  if (!report.stopped()) found = context.search(asked, refining_config(asked, config, candidates), start, watch);
  if (report.stopped() && found.stop_reason == StopReason::running) found.stop_reason = StopReason::cancelled;
  return found;
}

// Fallback if time ran out before anything was traced: an allowed position without figures.
std::vector<PlanEntry> any_position(const PlanContext& context, const Candidates& candidates,
                                    VerifiedNetworks& verified) {
  std::vector<PlacedStation> one = candidates.stations();
  if (one.empty())
    one = spread_positions(context.oracle(), context.area().mesh(), context.oracle().height_m, 1).stations;
  if (one.empty()) return {};
  verified.add(std::span(one).first(1));
  return verified.entries();
}

}  // namespace

PlanResult plan_fewest(PlanContext& context, Simulator& simulator, std::shared_ptr<const Candidates> candidates,
                       double candidates_seconds, const PlanConfig& config, const PlanWatch& watch) {
  const SurveyProblem problem = context.problem();
  FewestReport report(watch);
  VerifiedNetworks verified(
      problem, context.measures(), context.oracle(), context.evaluator(), config.sample_voxels, watch,
      [&context](std::span<const PlacedStation> placed) { return context.on_site().visit(placed).order; });
  FewestChoice choice = choose_number(context, simulator, *candidates, candidates_seconds, config, watch, report);
  SearchOutcome found;
  PlanResult result;
  if (choice.table.stations().size() <= choice.asked.existing) {
    found.stop_reason = StopReason::cancelled;
    result = context.result(found);
    result.front = any_position(context, *candidates, verified);
  } else {
    const double overstated = verify_and_repair(choice, verified, watch, report);
    found = search_from(choice, context, overstated, candidates->stations().size(), config, watch, report);
    verified.add(found, choice.placed());
    result = context.result(found);
    result.evaluations += report.traced;
    result.front = verified.front();
  }
  result.exact_hypervolume = judge_by_every_ray(result.front, problem, context.measures());
  return result;
}

}  // namespace vantage
