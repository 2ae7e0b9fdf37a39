// SPDX-License-Identifier: Apache-2.0
#include "plan/fewest_verify.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include "core/graph.hpp"
#include "cover/network.hpp"
#include "plan/drop_networks.hpp"
#include "search/decision_space.hpp"

namespace vantage {
namespace {

// Factor from a shortfall to the increase of its margin.
constexpr double kBeyond = 1.25;
// Further standard errors that each repair subtracts from sampled overlaps.
constexpr double kRepairErrors = 1;
// Largest number of rounds in which links are checked on another sample.
constexpr std::size_t kChecks = 8;
// Candidates added around each end of a link that is too weak.
constexpr std::size_t kBetween = 24;

// Returns how far an entry falls short of its lower limits.
Margins shortfall(const PlanEntry& entry, const FewestAsked& asked, std::span<const Requirement> requirements) {
  Margins margins;
  for (const Requirement& requirement : requirements) {
    const Objective& objective = requirement.objective;
    if (requirement.bound != Requirement::Bound::at_least || !(requirement.limit > 0)) continue;
    const double here = requirement.limit - entry.value(objective.name);
    if (objective.kind == Objective::Kind::coverage)
      margins.coverage = std::max(margins.coverage, here * asked.of_one(objective));
    if (objective.kind == Objective::Kind::link) margins.link = std::max(margins.link, here);
  }
  return margins;
}

// Number of links of at least `least` that the network lacks to be connected.
std::size_t missing_links(const PlanEntry& entry, double least) {
  if (!entry.exact || entry.scan_overlap_matrix.size() == 0) return 0;
  return std::max<std::size_t>(station_links(entry.scan_overlap_matrix, least, entry.stations).parts.size(), 1) - 1;
}

// The violation without tolerance: a limit that is met only within its standard error is still repaired. Each missing
// link counts: with the weakest alone, one that cannot be mended would hide all others.
double strict_violation(const PlanEntry& entry, std::span<const Requirement> requirements) {
  double violation = 0;
  for (const Requirement& requirement : requirements) {
    const bool linking =
        requirement.objective.kind == Objective::Kind::link && requirement.bound == Requirement::Bound::at_least;
    const std::size_t missing = linking ? missing_links(entry, requirement.limit) : 0;
    violation += missing > 0 ? kMissingLink * static_cast<double>(missing)
                             : requirement.missed_by(entry.value(requirement.objective.name));
  }
  return violation;
}

// The same network with its stations in the order in which they are visited.
std::vector<double> in_order(const DecisionSpace& space, const std::vector<double>& x,
                             const VerifiedNetworks::VisitOrder& visit_order) {
  if (!visit_order) return x;
  const std::vector<PlacedStation> stations = space.decode(x);
  const std::vector<std::size_t> order = visit_order(std::span(stations).subspan(space.existing()));
  const auto blocks = space.blocks();
  if (order.size() != blocks.size()) return x;  // some station cannot be visited
  std::vector<double> ordered = x;
  for (std::size_t k = 0; k < order.size(); ++k)
    for (std::size_t c = 0; c < blocks[k].size(); ++c) ordered[blocks[k][c]] = x[blocks[order[k]][c]];
  return ordered;
}

// The chosen candidates in the order of an evaluation's stations, which are the same, in the order of visiting.
std::vector<std::size_t> in_order_of(std::span<const PlacedStation> stations, const FewestChoice& choice) {
  std::vector<std::size_t> left = choice.network.chosen, ordered;
  for (const PlacedStation& station : stations) {
    const auto nearest = std::ranges::min_element(left, {}, [&](std::size_t k) {
      const Vec3 apart = choice.table.stations()[k].position - station.position;
      return dot(apart, apart);
    });
    ordered.push_back(*nearest);
    left.erase(nearest);
  }
  return ordered;
}

// Adds candidates around both ends of the best link of each component, within the ends' distance, and along the path
// between them. Chooses again. This helps if no known candidate links a component to the rest.
void look_between(FewestChoice& choice, const PlacementOracle& oracle, std::span<const PlacedStation> stations,
                  const StationLinks& links, const std::stop_token& stop) {
  std::vector<PlacedStation> between;
  for (const StationLinks::Gap& gap : links.gaps) {
    const std::array ends{stations[gap.inside], stations[gap.outside]};
    const Vec3 way = ends[1].ground - ends[0].ground;
    const auto around = positions_around(oracle, ends, kBetween, std::sqrt(dot(way, way)));
    between.insert(between.end(), around.begin(), around.end());
    if (!choice.way) continue;
    const auto along = positions_along(oracle, choice.way(ends[0].ground, ends[1].ground), kAlong_m);
    between.insert(between.end(), along.begin(), along.end());
  }
  choice.table.add(between, {.stop = stop});
  choose_again(choice, stop);
}

// Chosen stations with a link that only the sample shows, and that links known exactly do not replace.
std::vector<std::size_t> with_unknown_links(const FewestChoice& choice) {
  const std::vector<std::size_t>& chosen = choice.network.chosen;
  const auto linked = [&](std::size_t i, std::size_t j) {
    return static_cast<double>(choice.table.graph().overlap(chosen[i], chosen[j])) >= choice.asked.link;
  };
  const auto known = [&](std::size_t i, std::size_t j) { return choice.table.is_known(chosen[i], chosen[j]); };
  const Components parts =
      components(chosen.size(), [&](std::size_t i, std::size_t j) { return linked(i, j) && known(i, j); });
  std::set<std::size_t> found;
  for (std::size_t i = 0; i < chosen.size(); ++i)
    for (std::size_t j = i + 1; j < chosen.size(); ++j)
      if (parts.of[i] != parts.of[j] && linked(i, j) && !known(i, j)) found.insert({chosen[i], chosen[j]});
  return {found.begin(), found.end()};
}

// The ends of the best link of each component of the chosen network, and the candidates with the best sampled links to
// both. Links that are too weak on this sample are included, as they may hold on a larger one.
std::vector<std::size_t> around_gaps(const FewestChoice& choice, const StationLinks& links) {
  const StationGraph& graph = choice.table.graph();
  std::set<std::size_t> found;
  for (const StationLinks::Gap& gap : links.gaps) {
    const std::size_t inside = choice.network.chosen[gap.inside], outside = choice.network.chosen[gap.outside];
    std::vector<std::pair<float, std::size_t>> between;
    for (const StationGraph::Overlap& one : graph.overlaps(inside)) {
      const float weaker = std::min(one.share, graph.overlap(one.candidate, outside));
      if (weaker > 0) between.emplace_back(-weaker, one.candidate);
    }
    std::ranges::sort(between);
    if (between.size() > kBetween) between.resize(kBetween);
    found.insert({inside, outside});
    for (const auto& [weaker, candidate] : between) found.insert(candidate);
  }
  return {found.begin(), found.end()};
}

// Links of the chosen stations, in their order, by the overlaps of the table.
StationLinks links_of(const FewestChoice& choice) {
  const std::vector<std::size_t>& chosen = choice.network.chosen;
  ScanOverlapMatrix overlap(chosen.size());
  for (std::size_t i = 0; i < chosen.size(); ++i)
    for (std::size_t j = i + 1; j < chosen.size(); ++j)
      overlap.set(i, j, static_cast<double>(choice.table.graph().overlap(chosen[i], chosen[j])));
  return station_links(overlap, choice.asked.link, choice.stations_of(choice.network));
}

}  // namespace

SurveyProblem with_stations(SurveyProblem problem, std::size_t placed) {
  problem.stations_min = problem.stations_max = placed;
  const auto all = static_cast<double>(problem.existing.size() + placed);
  for (Objective& objective : problem.objectives)
    if (objective.by_alpha) objective.scale = minimise(all, all);
  return problem;
}

VerifiedNetworks::VerifiedNetworks(const SurveyProblem& problem, const Measures& measures,
                                   const PlacementOracle& oracle, NetworkEvaluator& evaluator,
                                   std::uint64_t sample_voxels, const PlanWatch& watch, VisitOrder visit_order,
                                   TiesPastStairs ties_past_stairs)
    : problem_(problem),
      measures_(measures),
      oracle_(oracle),
      evaluator_(evaluator),
      sample_voxels_(sample_voxels),
      watch_(watch),
      visit_order_(std::move(visit_order)),
      ties_past_stairs_(std::move(ties_past_stairs)) {}

void VerifiedNetworks::add(std::span<const PlacedStation> placed) {
  const SurveyProblem narrowed = with_stations(problem_, placed.size());
  SearchOutcome found;  // one network, whose objectives are not known yet
  found.front.push_back(
      {.x = DecisionSpace(oracle_, narrowed).encode(placed), .f = std::vector<double>(problem_.objectives.size(), 2)});
  add(found, placed.size());
}

void VerifiedNetworks::add(const SearchOutcome& found, std::size_t placed) {
  if (found.front.empty()) return;
  const SurveyProblem narrowed = with_stations(problem_, placed);
  const DecisionSpace space(oracle_, narrowed);
  SearchOutcome ordered = found;
  for (ParetoPoint& point : ordered.front) point.x = in_order(space, point.x, visit_order_);
  // A search may return the network that it started from.
  const auto known = [&](const ParetoPoint& point) {
    return std::ranges::any_of(entries_, [&](const PlanEntry& entry) { return entry.exact && entry.x == point.x; });
  };
  for (std::size_t k = ordered.front.size(); k-- > 0;)
    if (known(ordered.front[k])) drop_point(ordered, k);
  if (ordered.front.empty()) return;
  for (PlanEntry& entry :
       confirm_front(ordered, space, narrowed, measures_, sample_voxels_, evaluator_, watch_).entries) {
    entry.violation = violation_of(entry);
    entries_.push_back(std::move(entry));
  }
  // Counts of every voxel take about 12 bytes each; only the entry that may be the answer keeps them.
  const auto answer = std::ranges::min_element(entries_, {}, [](const PlanEntry& entry) {
    return std::tuple(!entry.exact, entry.violation, entry.stations.size());
  });
  for (PlanEntry& entry : entries_)
    if (&entry != &*answer) entry.field = {};
}

double VerifiedNetworks::violation_of(const PlanEntry& entry) const {
  return strict_violation(entry, problem_.requirements) + kMissingLink * static_cast<double>(ties_past_stairs(entry));
}

void VerifiedNetworks::judge_again() {
  for (PlanEntry& entry : entries_) entry.violation = violation_of(entry);
}

const PlanEntry* VerifiedNetworks::best() const {
  const PlanEntry* best = nullptr;
  for (const PlanEntry& entry : entries_)
    if (entry.exact && (!best || entry.violation < best->violation)) best = &entry;
  return best;
}

std::vector<PlanEntry> VerifiedNetworks::front() const {
  const bool any_exact = std::ranges::any_of(entries_, &PlanEntry::exact);
  std::vector<PlanEntry> left;
  for (const PlanEntry& entry : entries_)
    if (entry.exact || !any_exact) left.push_back(entry);
  drop_unplaced(left, problem_.existing.size());
  const auto rank = [](const PlanEntry& entry) {
    return std::pair{entry.violation, entry.violation > 0 ? std::size_t{0} : entry.stations.size()};
  };
  if (left.empty()) return left;
  const auto best = rank(*std::ranges::min_element(left, {}, rank));
  std::erase_if(left, [&](const PlanEntry& entry) { return rank(entry) != best; });

  const std::size_t objectives = problem_.objectives.size();
  std::vector<double> scaled;
  for (const PlanEntry& entry : left)
    for (const Objective& objective : problem_.objectives)
      scaled.push_back(objective.scaled(entry.value(objective.name)));
  const std::vector<std::size_t> ranks = non_dominated_ranks(scaled, objectives);
  std::vector<PlanEntry> front;
  for (std::size_t k = 0; k < left.size(); ++k) {
    const bool doubled =
        std::ranges::any_of(front, [&](const PlanEntry& other) { return same_places(other, left[k]); });
    if (ranks[k] == 0 && !doubled && (objectives > 1 || front.empty())) front.push_back(std::move(left[k]));
  }
  return front;
}

void VerifiedNetworks::fill_in(const std::string& measure, double value) {
  if (entries_.empty() || entries_.back().exact || !std::isnan(entries_.back().value(measure))) return;
  PlanEntry& entry = entries_.back();
  entry.values[measure] = entry.searched[measure] = {value, 0};
  entry.violation = strict_violation(entry, problem_.requirements);
}

double verify(const FewestChoice& choice, VerifiedNetworks& verified) {
  verified.add(choice.placed_of(choice.network));
  verified.fill_in(choice.asked.measure(), choice.network.coverage);
  if (choice.asked.link > 0) verified.fill_in("link", choice.network.link);
  if (verified.entries().empty() || !verified.entries().back().exact) return choice.margins.coverage;
  const PlanEntry& entry = verified.entries().back();
  return entry.searched.at(choice.asked.measure()).value - entry.value(choice.asked.measure());
}

void choose_again(FewestChoice& choice, const std::stop_token& stop) {
  choice.one_fewer.reset();
  // Starts from the present network with as many stations, and else adds more.
  const CoverProblem asked = cover_problem(choice);
  CoverSolution same =
      improve_weakest_link(asked, evaluate_cover(asked, choice.network.chosen), choice.asked.link, stop);
  if (same.violation == 0)
    choice.network = std::move(same);
  else
    choose_from(choice, std::move(same), stop);
  strengthen(choice, stop);
}

void raise_margins(FewestChoice& choice, const Margins& missing, const std::stop_token& stop) {
  choice.margins.coverage += kBeyond * missing.coverage, choice.margins.link += kBeyond * missing.link;
  choose_again(choice, stop);
}

bool keep_to_stairs(FewestChoice& choice, VerifiedNetworks& verified, const std::stop_token& stop) {
  if (choice.along_stairs || verified.entries().empty()) return false;
  const PlanEntry& last = verified.entries().back();
  if (verified.ties_past_stairs(last) == 0 || last.stations.size() != choice.network.chosen.size()) return false;
  choice.table.take_in(in_order_of(last.stations, choice), last.scan_overlap_matrix);
  const bool kept = keep_to_stairs(choice, stop);
  if (!kept) choice.past_stairs = nullptr;
  verified.judge_again();
  return kept;
}

void check_links(FewestChoice& choice, const PlacementOracle& oracle, const LeastOverlaps& least_overlaps,
                 const std::stop_token& stop) {
  // False if stopped.
  const auto check = [&](const std::vector<std::size_t>& some) {
    std::vector<PlacedStation> stations;
    for (const std::size_t k : some) stations.push_back(choice.table.stations()[k]);
    const std::optional<ScanOverlapMatrix> least = least_overlaps(stations);
    if (least) choice.table.take_in(some, *least);
    return least.has_value();
  };
  for (std::size_t k = 0; k < kChecks; ++k) {
    const std::vector<std::size_t> unknown = with_unknown_links(choice);
    if (unknown.empty() || !check(unknown)) return;
    choice.network = evaluate_cover(cover_problem(choice), std::move(choice.network.chosen));
    if (choice.network.violation == 0) return;
    // Candidates that may mend a gap are checked before one of them is chosen.
    if (const auto around = around_gaps(choice, links_of(choice)); !around.empty() && !check(around)) return;
    const std::vector<std::size_t> before = choice.network.chosen;
    choose_again(choice, stop);
    if (choice.network.violation > 0)
      look_between(choice, oracle, choice.stations_of(choice.network), links_of(choice), stop);
    if (choice.network.chosen == before) return;
  }
}

bool repair(FewestChoice& choice, const VerifiedNetworks& verified, const PlacementOracle& oracle,
            const std::stop_token& stop) {
  const PlanEntry *best = verified.best(), &last = verified.entries().back();
  if (!best) return false;
  const Margins missing = shortfall(*best, choice.asked, verified.problem().requirements);
  const std::size_t ties = verified.ties_past_stairs(*best);
  const bool unlinked = missing.link > 0 || ties > 0;
  if (missing.coverage == 0 && !unlinked) return false;
  // The last verified network is the chosen one.
  const double known = choice.network.violation;
  if (last.exact && unlinked && last.scan_overlap_matrix.size() == choice.network.chosen.size()) {
    choice.link_errors = std::min(choice.link_errors + kRepairErrors, kMostLinkErrors);
    choice.table.take_least_overlaps(choice.link_errors);
    choice.table.take_in(in_order_of(last.stations, choice), last.scan_overlap_matrix);
    choice.network = evaluate_cover(cover_problem(choice), std::move(choice.network.chosen));
  }
  const double told = choice.network.violation;  // by the links of every ray
  const bool was_known = known > 0 && told >= known;
  if (was_known && !unlinked) return false;
  const std::vector<std::size_t> before = choice.network.chosen;
  if (!was_known) raise_margins(choice, missing, stop);
  if (ties > 0 && choice.network.violation > 0)
    look_between(choice, oracle, choice.stations_of(choice.network), links_of(choice), stop);
  else if (const auto links = last.links(); links && choice.network.violation > 0 && unlinked)
    look_between(choice, oracle, last.stations, *links, stop);
  if (choice.network.violation == 0) return true;
  return choice.network.chosen != before && (known == 0 || choice.network.violation < told);
}

bool repair_meshes(FewestChoice& choice, const VerifiedNetworks& verified, const std::stop_token& stop) {
  if (choice.of_meshes.empty() || verified.entries().empty()) return false;
  const PlanEntry& last = verified.entries().back();  // the chosen one
  for (AskedOfMeshes& asked : choice.of_meshes)
    if (const double lacks = asked.share - last.value(asked.measure); lacks > 0) asked.margin += kBeyond * lacks;
  return capture_meshes(choice, stop);
}

bool choose_by_known_error(FewestChoice& choice, VerifiedNetworks& verified, double& overstated,
                           const std::stop_token& stop) {
  const PlanEntry& entry = verified.entries().back();
  const auto exact = entry.values.find(choice.asked.measure());
  if (!entry.exact || exact == entry.values.end() || !choice.one_fewer || choice.network.violation > 0) return false;
  const double error = choice.network.coverage - exact->second.value;
  if (error >= choice.margins.coverage) return false;
  const double margin = std::exchange(choice.margins.coverage, error);
  ConnectedCover found = min_connected_cover(cover_problem(choice), stop, *choice.one_fewer);
  if (found.best.violation == 0 && found.best.chosen.size() <= choice.network.chosen.size() &&
      !leaves_units(choice, choice.stations_of(choice.network), choice.stations_of(found.best))) {
    CoverSolution before = std::exchange(choice.network, std::move(found.best));
    strengthen(choice, stop);
    const double now_overstated = verify(choice, verified);
    const PlanEntry& now = verified.entries().back();
    if (now.exact && now.violation == 0) {
      choice.one_fewer = std::move(found.one_fewer);
      overstated = now_overstated;
      return true;
    }
    choice.network = std::move(before);
  }
  choice.margins.coverage = margin;
  return false;
}

}  // namespace vantage
