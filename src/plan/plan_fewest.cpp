// SPDX-License-Identifier: Apache-2.0
// First how many, then where. The plan traces candidates, chooses the fewest stations among them, tries more candidates
// around these, and verifies the choice by every ray. From there the optimiser searches for the best network of that
// number. The answer is the best network that was evaluated with every ray.
#include "plan/plan_fewest.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "candidates/spread_positions.hpp"
#include "core/seconds_since.hpp"
#include "evaluate/storey_ties.hpp"
#include "plan/fewest_search.hpp"
#include "plan/fewest_verify.hpp"
#include "plan/limits.hpp"
#include "plan/trade_off.hpp"
#include "plan/what_pays.hpp"
#include "vantage/candidates.hpp"

namespace vantage {
namespace {

// Radius of the first round of refinement, in distances between candidates; halved each round.
constexpr double kAroundRadius = 0.8;
// Largest number of repairs of a choice, and of new choices by the known error of the sample.
constexpr std::size_t kRepairs = 6, kNewChoices = 3;
// Stations that may be traced with every ray to repair a choice, and to try fewer stations.
constexpr std::size_t kRepairStations = 6000, kFewerStations = 500;

// Ratio of the time after the first round of refinement to the time until then, a guess from one plan of the office.
// Timing the stages themselves would take longer than some of them.
constexpr double kRestOfPlan = 3;

// Largest networks of a trade-off that are measured together.
constexpr std::size_t kTogether = 128;

// A site with more ground has hundreds of links, some of which a sample overestimates. The choice subtracts
// `kLinkErrors` standard errors from them, before every ray is traced. On smaller sites that would cost stations for
// links that hold.
constexpr double kGroundOfHundreds_m2 = 8000, kLinkErrors = 2;
// Size of the sample that checks its links, as a multiple of the one that chose them, and standard errors by which
// links must hold on it.
constexpr std::uint64_t kCheckedVoxels = 3;
constexpr double kCheckErrors = 1;

// Makes tables of stations, with a column for each station on a sample of the voxels.
class TableMaker {
 public:
  TableMaker(PlanContext& context, Simulator& simulator, const SampledCoverage& known) : simulator_(simulator) {
    const FewestAsked asked = fewest_asked(context.problem());
    if (asked.captured) goals_ = context.chosen.counts();
    spacing_.nearest_m = asked.apart_m;
    if (asked.apart_m > 0) {
      std::vector<Vec3> centres;
      for (const std::uint32_t voxel : known.voxels()) centres.push_back(simulator.voxel_centre(voxel));
      CoverageMatrix goals(known.matrix().weights(), known.matrix().goal());
      if (asked.captured) goals.set_goals(goals_);
      spacing_.least_m = [centres = std::move(centres), goals = std::move(goals)](
                             const PlacedStation& station, std::span<const CoverageMatrix::Entry> column) {
        return spacing_by_view(station, column, goals, centres);
      };
      spacing_.sees = context.oracle().sees;
    }
    const bool link_is_objective = std::ranges::any_of(
        context.problem().objectives, [](const Objective& o) { return o.kind == Objective::Kind::link; });
    if (asked.link <= 0 && !link_is_objective) return;
    const std::uint64_t sample = context.link_voxels();
    surroundings_ =
        seen_columns_of(context.surroundings(), sample > 0 ? sample : std::numeric_limits<std::uint32_t>::max());
    const auto all = static_cast<double>(context.surroundings().voxel_count()), some = static_cast<double>(sample);
    unsampled_ = sample > 0 && some < all ? 1 - some / all : 0;
  }
  CandidateTable operator()(std::uint64_t sample_voxels) const {
    return {columns_of(simulator_, sample_voxels, goals_), surroundings_, spacing_, unsampled_};
  }
  // Returns known columns with the goals of the table.
  CoverageMatrix by_goals(CoverageMatrix known) const {
    if (!goals_.empty()) known.set_goals(goals_);
    return known;
  }

 private:
  Simulator& simulator_;
  TraceColumns surroundings_;
  std::vector<double> goals_;  // attainable counts, if the choice is by `capture`
  StationSpacing spacing_;
  double unsampled_ = 1;
};

// Reports the progress of the plan.
class FewestReport {
 public:
  explicit FewestReport(const PlanWatch& watch) : watch_(watch) {}

  std::uint64_t traced = 0;  // stations

  double seconds() const { return seconds_since(begun_); }
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
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

VisitTime visit_time(PlanContext& context, const FewestAsked& asked) {
  if (!asked.minutes) return {};  // avoids making the walking graph for nothing
  const OnSite& on_site = context.on_site();
  return {.each_min = on_site.minutes_per_scan() + on_site.options().set_up_min + on_site.options().photos_min,
          .minutes = [&on_site](std::span<const PlacedStation> placed) { return on_site.visit(placed).minutes; }};
}

bool has_hundreds_of_links(const FewestChoice& choice, PlanContext& context) {
  return choice.asked.link > 0 && ground_area_m2(context.area().mesh()) > kGroundOfHundreds_m2;
}

// Chooses again with larger margins until the network has enough coverage on other voxels. The sample overestimates a
// network chosen among thousands; other voxels show by how much, long before every ray does.
void calibrate(FewestChoice& choice, PlanContext& context, Simulator& simulator, const PlanWatch& watch) {
  if (!choice.asked.captured || choice.asked.most_coverage) return;
  for (std::size_t k = 0; k < kNewChoices && choice.network.violation == 0 && !watch.stop.stop_requested(); ++k) {
    const Network network = to_network(choice.stations_of(choice.network));
    const auto shares = captured_shares(simulator, context.confirmed, {&network, 1}, {.stop = watch.stop});
    if (shares.empty() || shares.front().all.value >= choice.asked.coverage) return;
    raise_margins(choice, {.coverage = choice.asked.coverage - shares.front().all.value}, watch.stop);
  }
}

// Lowers the required capture to that of the network on other voxels, less its error, within the problem's limits.
void require_no_more(FewestChoice& choice, PlanContext& context, Simulator& simulator, const PlanWatch& watch) {
  const Network network = to_network(choice.stations_of(choice.network));
  const auto shares = captured_shares(simulator, context.confirmed, {&network, 1}, {.stop = watch.stop});
  if (shares.empty()) return;
  const double captured = std::min(shares.front().all.value - shares.front().all.standard_error, choice.asked.coverage);
  choice.asked.coverage = context.pays->capture = std::max(context.asked_capture, rounded_down(captured));
  SurveyProblem problem = context.problem();
  for (Requirement& requirement : problem.requirements)
    if (requires_capture(requirement)) requirement.limit = std::min(requirement.limit, context.pays->capture);
  context.ask(problem);
}

// Mends links that do not hold on other voxels, on sites with hundreds of links.
void mend_links(FewestChoice& choice, PlanContext& context, Simulator& simulator, const PlanWatch& watch) {
  if (!has_hundreds_of_links(choice, context)) return;
  Simulator& surroundings = context.surroundings();
  const std::uint64_t known_by = context.link_voxels(), all = surroundings.voxel_count();
  if (known_by == 0 || known_by >= all) return;
  const SampleOptions others{.voxels = std::min(kCheckedVoxels * known_by, all - known_by),
                             .from = known_by,
                             .count_to = CountTo::one,
                             .groups = false};
  const double errors = kCheckErrors * std::sqrt(1 - static_cast<double>(others.voxels) / static_cast<double>(all));
  const LeastOverlaps least_overlaps =
      [&](std::span<const PlacedStation> stations) -> std::optional<ScanOverlapMatrix> {
    const Network network = to_network(stations);
    const auto counts = surroundings.evaluate_sampled({&network, 1}, others, {.stop = watch.stop});
    if (counts.front().cancelled) return std::nullopt;
    ScanOverlapMatrix overlap = scan_overlap_matrix(counts.front());
    for (std::size_t i = 0; i < stations.size(); ++i)
      for (std::size_t j = i + 1; j < stations.size(); ++j)
        if (const std::uint64_t fewer = std::min(counts.front().seen[i], counts.front().seen[j]); fewer > 0)
          overlap.set(i, j, least_share(overlap(i, j), static_cast<double>(fewer), errors));
    return overlap;
  };
  check_links(choice, context.oracle(), least_overlaps, watch.stop);
  // Stations that mend links may capture less than the sample shows.
  calibrate(choice, context, simulator, watch);
  check_links(choice, context.oracle(), least_overlaps, watch.stop);
}

// Order of visiting, by which stations are numbered. It follows sampled links, long before every ray is traced.
VerifiedNetworks::VisitOrder visit_order(PlanContext& context, const PlanWatch& watch) {
  return [&context, &watch, link = fewest_asked(context.problem()).link](std::span<const PlacedStation> placed) {
    std::optional<StationLinks> links;
    if (const std::uint64_t voxels = context.link_voxels(); link > 0 && voxels > 0) {
      const Network network = to_network(placed);
      const auto counts = context.surroundings().evaluate_sampled(
          {&network, 1}, {.voxels = voxels, .count_to = CountTo::one, .groups = false}, {.stop = watch.abort});
      if (!counts.front().cancelled) links = station_links(scan_overlap_matrix(counts.front()), link, placed);
    }
    return visit_of(placed, links, context.on_site(), most_minutes(context.problem().requirements)).order;
  };
}

// Traces candidates, chooses and refines. Places no station if the time was over before that.
FewestChoice choose_number(PlanContext& context, Simulator& simulator, const Candidates& candidates,
                           const PlanWatch& watch, FewestReport& report) {
  const SurveyProblem& problem = context.problem();
  const TableMaker make_table(context, simulator, candidates.coverage());
  FewestChoice choice{.asked = fewest_asked(problem), .table = make_table(candidates.coverage().sample_voxels())};
  if (context.to_visit) choice.to_visit = &*context.to_visit;
  choice.of_meshes = asked_of_meshes(problem, context.chosen, choice.table.matrix().weights());
  if (!choice.of_meshes.empty()) choice.attainable = context.chosen.counts();
  if (choice.asked.link > 0)
    choice.past_stairs = [&context](std::span<const PlacedStation> stations,
                                    std::span<const std::pair<std::size_t, std::size_t>> pairs) {
      return past_stairs(stations, pairs, context.on_site());
    };
  choice.way = [&context](const Vec3& from, const Vec3& to) { return context.on_site().way(from, to); };
  // No other voxels correct the sample then: the margin is a standard error of it.
  if (!choice.asked.captured) choice.margins.coverage = candidates.coverage().coverage().standard_error;

  if (has_hundreds_of_links(choice, context)) {
    choice.link_errors = kLinkErrors;
    choice.table.take_least_overlaps(choice.link_errors);
  }

  std::vector<PlacedStation> existing = existing_stations(context.oracle(), problem.existing, problem.existing_setups);
  for (PlacedStation& station : existing)
    if (active(station)) station.status = StationStatus::ok;  // others are not traced
  look(choice.table, existing, candidates.stations(), make_table.by_goals(candidates.coverage().matrix()),
       report.progress("look"), watch.abort);
  report.traced += choice.table.stations().size();
  if (choice.table.stations().size() <= existing.size()) return choice;

  report("choose");
  choose(choice, visit_time(context, choice.asked), watch.stop);
  visit_units(choice, watch.stop);
  const auto refine = [&] {
    for (std::size_t round = 0; round < kRounds && !report.stopped(); ++round) {
      const std::size_t before = choice.table.stations().size();
      const double radius_m =
          kAroundRadius * std::ldexp(std::max(candidates.spacing_m(), 0.1), -static_cast<int>(round));
      refine_around(choice, context.oracle(), radius_m, report.progress("choose"));
      report.traced += choice.table.stations().size() - before;
      if (round == 0 && !report.stopped() && choice.placed() > 0) report("choose", kRestOfPlan * report.seconds());
    }
  };
  refine();
  if (look_along_ways(choice, context.oracle(), watch.stop)) refine();
  // Reaches a required share with any number of stations. If it stays out of reach, each station has to help.
  if (out_of_reach(choice) && !problem.pays_m2 && !report.stopped()) {
    choose_anew(choice, 0, watch.stop);
    refine();
    if (out_of_reach(choice)) choose_anew(choice, kLeastHelp, watch.stop);
  }
  if (grow_into_reach(choice, watch.stop)) refine();
  keep_to_stairs(choice, watch.stop);
  const auto keep_only_what_pays = [&] {
    if (context.pays && keep_what_pays(choice, *context.pays, context.asked_capture, watch.stop))
      require_no_more(choice, context, simulator, watch);
  };
  keep_only_what_pays();
  calibrate(choice, context, simulator, watch);
  mend_links(choice, context, simulator, watch);
  if (visit_units(choice, watch.stop)) mend_links(choice, context, simulator, watch);
  if (capture_meshes(choice, watch.stop)) mend_links(choice, context, simulator, watch);
  if (context.pays && add_what_pays(choice, *context.pays, watch.stop)) {
    keep_only_what_pays();  // swaps may have gained so much that the last one does not pay any more
    mend_links(choice, context, simulator, watch);
  }
  if (stand_aside(choice, context.oracle(), watch.stop)) mend_links(choice, context, simulator, watch);
  return choice;
}

// Counts ties past the stair in evaluated networks, without those that the choice found unavoidable.
VerifiedNetworks::TiesPastStairs count_ties(const FewestChoice& choice) {
  return [&choice](const Evaluation& evaluation) -> std::size_t {
    const ScanOverlapMatrix& overlap = evaluation.scan_overlap_matrix;
    if (!choice.past_stairs || overlap.size() != evaluation.stations.size()) return 0;
    const auto linked = [&](std::size_t a, std::size_t b) { return overlap(a, b) >= choice.asked.link; };
    const std::size_t ties = ties_past_stairs(evaluation.stations, choice.past_stairs, linked);
    return ties - std::min(ties, choice.along_stairs ? choice.along_stairs->unavoidable : 0);
  };
}

// Verifies the choice and repairs it if it is not feasible by every ray; otherwise tries fewer stations. Returns the
// overstatement of its coverage by the sample of a search.
double verify_and_repair(FewestChoice& choice, VerifiedNetworks& verified, PlanContext& context, Simulator& simulator,
                         const PlanWatch& watch, const FewestReport& report) {
  const auto least_violation = [&] {
    const PlanEntry* best = verified.best();
    return best ? best->violation : std::numeric_limits<double>::infinity();
  };
  double overstated = verify(choice, verified);
  std::size_t traced = choice.network.chosen.size();
  const auto affordable = [&](std::size_t stations) { return traced + choice.network.chosen.size() <= stations; };
  const auto verify_again = [&] {
    visit_units(choice, watch.stop);
    stand_aside(choice, context.oracle(), watch.stop);
    mend_links(choice, context, simulator, watch);
    overstated = verify(choice, verified);
    traced += choice.network.chosen.size();
  };
  const auto repair_all = [&] {
    for (std::size_t k = 0; k < kRepairs && least_violation() > 0 && affordable(kRepairStations) && !report.stopped();
         ++k) {
      if (keep_to_stairs(choice, verified, watch.stop))
        calibrate(choice, context, simulator, watch);
      else if (least_violation() == 0 ||
               !(repair_meshes(choice, verified, watch.stop) || repair(choice, verified, context.oracle(), watch.stop)))
        break;
      verify_again();
    }
  };
  repair_all();
  if (const PlanEntry* best = verified.best();
      choice.along_stairs && best && verified.ties_past_stairs(*best) > 0 && !report.stopped()) {
    leave_stairs(choice, watch.stop);
    verified.judge_again();
    verify_again();
    repair_all();
  }
  for (std::size_t k = 0; k < kNewChoices && least_violation() == 0 && affordable(kFewerStations) && !report.stopped();
       ++k, traced += choice.network.chosen.size())
    if (!choose_by_known_error(choice, verified, overstated, watch.stop)) break;
  return overstated;
}

// Searches for the best network with the number of stations of the chosen one, starting from it.
SearchOutcome search_from(const FewestChoice& choice, PlanContext& context, double overstated, std::size_t candidates,
                          const PlanConfig& config, const PlanWatch& watch, const FewestReport& report) {
  SearchOutcome found;
  const SurveyProblem asked =
      with_margins(with_stations(context.problem(), choice.placed()), choice.asked, overstated, choice.margins.link);
  const std::vector<double> start = DecisionSpace(context.oracle(), asked).encode(choice.placed_of(choice.network));
  const PlanConfig refining = refining_config(asked, config, candidates);
  if (config.iterations == 0 && !worth_searching(asked, refining))
    found.stop_reason = StopReason::max_iterations;
  else if (!report.stopped())
    found = context.search(asked, refining, start, watch);
  // Registration draws stations together: networks with stations too close, or with an emptied unit, are dropped.
  const DecisionSpace space(context.oracle(), asked);
  for (std::size_t k = found.front.size(); k-- > 0;)
    if (const std::vector<PlacedStation> stations = space.decode(found.front[k].x);
        !choice.table.spaced(stations) || leaves_units(choice, choice.stations_of(choice.network), stations))
      drop_point(found, k);
  if (report.stopped() && (found.stop_reason == StopReason::running || found.front.empty()))
    found.stop_reason = StopReason::cancelled;
  return found;
}

// The trade-off around the chosen network, estimated on the voxels that confirm networks. A stop ends the improvement
// of its networks; an abort leaves points out.
std::vector<TradeOffPoint> trade_off(const FewestChoice& choice, PlanContext& context, const PlanWatch& watch) {
  if (!choice.asked.captured) return {};
  const std::vector<CoverSolution> solutions = trade_off_networks(choice, watch.stop, watch.abort);
  std::vector<PlacedNetwork> networks;
  for (const CoverSolution& solution : solutions) networks.push_back(choice.stations_of(solution));
  // Sums of all pairs of hundreds of stations, by group of voxels, are gigabytes: one network at a time.
  const std::size_t at_once = networks.empty() || networks.back().size() > kTogether ? 1 : networks.size();
  std::vector<std::vector<Estimate>> estimates;
  for (std::size_t first = 0; first < networks.size(); first += at_once) {
    auto some =
        context.evaluator().estimate(std::span(networks).subspan(first, std::min(at_once, networks.size() - first)),
                                     {.voxels = context.confirmed.sample_voxels(), .from = context.confirmed.from()},
                                     NetworkEvaluator::Which::all, {.stop = watch.abort});
    if (!some) break;
    std::ranges::move(*some, std::back_inserter(estimates));
  }
  std::vector<TradeOffPoint> points;
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    TradeOffPoint& point = points.emplace_back(TradeOffPoint{.stations = networks[k]});
    for (std::size_t m = 0; m < context.measures().all.size(); ++m) {
      const Objective& measure = context.measures().all[m];
      // A single scan has nothing to be registered to.
      if (measure.needs.registration && networks[k].size() < 2) continue;
      point.values[measure.name] = estimates[k][m];
    }
    point.minutes_on_site = context.on_site().visit(std::span(networks[k]).subspan(choice.asked.existing)).minutes;
  }
  return points;
}

// Finds what a further station would add to the answer, linked to it.
std::optional<FurtherStation> further_station(const PlanResult& result, const FewestChoice& choice,
                                              PlanContext& context, const Simulator& simulator) {
  const bool chosen = choice.table.stations().size() > choice.asked.existing;
  if (!choice.asked.captured || !chosen || result.front.empty()) return std::nullopt;
  const std::vector<PlacedStation>& stations = result.front[answer(result)].stations;
  const CoverProblem asked = cover_problem(choice);
  const CoverageMatrix even = with_even_weights(asked.matrix);
  CoverProblem problem{.matrix = even, .graph = asked.graph, .link = asked.link};
  for (const PlacedStation& station : stations) problem.existing.push_back(choice.table.nearest(station));
  const std::span placed = std::span(stations).subspan(choice.asked.existing);
  const double element_m2 = surveyed_area_m2(simulator.scene()) / static_cast<double>(asked.matrix.elements());
  const FurtherStations more = further_stations(problem, placed.size(), element_m2);
  FurtherStation further{.m2 = more.each_m2};
  if (more.candidates.empty()) return further;
  std::vector<PlacedStation> with(placed.begin(), placed.end());
  for (const std::size_t k : more.candidates) with.push_back(choice.table.stations()[k]);
  further.minutes = (context.on_site().visit(with).minutes - context.on_site().visit(placed).minutes) /
                    static_cast<double>(more.candidates.size());
  return further;
}

// Returns one allowed position as an entry, since the time ran out before anything was traced.
std::vector<PlanEntry> any_position(PlanContext& context, const Candidates& candidates, VerifiedNetworks& verified) {
  std::vector<PlacedStation> one = candidates.stations();
  if (one.empty())
    one = spread_positions(context.oracle(), context.area().mesh(), context.oracle().height_m, 1).stations;
  if (one.empty()) return {};
  verified.add(std::span(one).first(1));
  return verified.entries();
}

}  // namespace

PlanResult plan_fewest(PlanContext& context, Simulator& simulator, std::shared_ptr<const Candidates> candidates,
                       const PlanConfig& config, const PlanWatch& watch) {
  FewestReport report(watch);
  FewestChoice choice = choose_number(context, simulator, *candidates, watch, report);
  const SurveyProblem problem = context.problem();  // the choice may have narrowed it
  VerifiedNetworks verified(problem, context.measures(), context.oracle(), context.evaluator(), config.sample_voxels,
                            watch, visit_order(context, watch), count_ties(choice));
  SearchOutcome found;
  PlanResult result;
  if (choice.table.stations().size() <= choice.asked.existing) {
    found.stop_reason = StopReason::cancelled;
    result = context.result(found);
    result.front = any_position(context, *candidates, verified);
  } else {
    const double overstated = verify_and_repair(choice, verified, context, simulator, watch, report);
    // This comes before the search, which takes whatever time there is.
    std::vector<TradeOffPoint> points = trade_off(choice, context, watch);
    found = search_from(choice, context, overstated, candidates->stations().size(), config, watch, report);
    verified.add(found, choice.placed());
    result = context.result(found);
    result.evaluations += report.traced;
    result.front = verified.front();
    result.trade_off = std::move(points);
  }
  result.exact_hypervolume = judge_by_every_ray(result.front, problem, context.measures());
  result.further = further_station(result, choice, context, simulator);
  return result;
}

}  // namespace vantage
