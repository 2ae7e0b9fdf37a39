// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/beyond.hpp"
#include "core/first_numbers.hpp"
#include "core/graph.hpp"
#include "core/parallel.hpp"
#include "core/part_of.hpp"
#include "scene/changed_scene.hpp"
#include "taken/model_surface.hpp"
#include "taken/real_counts.hpp"
#include "vantage/cover.hpp"
#include "vantage/error.hpp"
#include "vantage/taken_scans.hpp"

namespace vantage {
namespace {

constexpr std::uint64_t kOverlapVoxels = 10'000;
// A voxel that scans fill to less than this share still has something to capture.
constexpr double kFilled = 0.999;

// Returns the share of the attainable coverage that amounts capture.
double captured_of(const CoverageMatrix& matrix, std::span<const double> amounts) {
  double sum = 0;
  for (std::size_t e = 0; e < amounts.size(); ++e)
    if (matrix.goal(e) > 0) sum += matrix.weight(e) * std::min(1.0, amounts[e] / matrix.goal(e));
  return matrix.total_weight() > 0 ? sum / matrix.total_weight() : 0;
}

void add_column(const CoverageMatrix& matrix, std::size_t k, std::vector<double>& amounts) {
  for (const CoverageMatrix::Entry& one : matrix.column(k)) amounts[one.element] += one.amount;
}

// Scans, planned stations and candidates, in this order, with their columns.
struct Table {
  std::vector<PlacedStation> stations = {};
  CoverageMatrix matrix = {};
  StationGraph graph = {};
  AttainableCounts attainable = {};
  std::size_t scans = 0, planned = 0, candidates = 0;
};

// Converts points to amounts of a column.
std::vector<std::uint32_t> amounts_of(std::vector<std::uint32_t> points, const Simulator& simulator,
                                      const SampledCoverage& sampled) {
  const auto full = static_cast<std::uint64_t>(std::ceil(sampled.matrix().goal()));
  for (std::size_t e = 0; e < points.size(); ++e)
    points[e] = static_cast<std::uint32_t>(
        std::min(full, std::uint64_t{points[e]} * simulator.point_weight(sampled.voxels()[e])));
  return points;
}

PlacedStation station_of(Site& found, const TakenScan& scan) {
  PlacedStation station = found.place_head(scan.head).station;
  station.existing = true;
  station.setup = scan.setup, station.setup.scanner = 0;
  return station;
}

void check(const NextConfig& config, std::span<const TakenScan> scans) {
  const auto refuse = [](const std::string& why) { throw Error(Errc::invalid_argument, "next stations: " + why); };
  if (scans.empty()) refuse("no scan was given");
  check_settings(next_settings(), config);
  if (config.sample_voxels == 0) refuse("a sample has at least one voxel");
}

std::optional<Table> make_table(Site& found, std::span<const TakenScan> scans, std::span<const PlacedStation> taken,
                                std::span<const PlacedStation> planned, const NextConfig& config,
                                const Progress& progress) {
  const Candidates candidates =
      find_candidates(found, {.sample_voxels = config.sample_voxels}, between(progress, 0, 0.6));
  const SampledCoverage plan =
      sample_coverage(found.simulator(), planned, candidates.coverage().sample_voxels(), between(progress, 0.6, 0.7));
  if (candidates.ended() == "cancelled" || plan.cancelled() || progress.stopped()) return std::nullopt;

  Table table{.attainable = candidates.attainable_counts(),
              .scans = scans.size(),
              .planned = planned.size(),
              .candidates = candidates.stations().size()};
  const CoverageMatrix& others = candidates.coverage().matrix();
  table.matrix = CoverageMatrix(others.weights(), others.goal());
  const RealCounts real(found.simulator(), candidates.coverage().voxels(), config.tolerance_m);
  for (const TakenScan& scan : scans)
    table.matrix.add(amounts_of(real.of(scan), found.simulator(), candidates.coverage()));
  table.stations.assign(taken.begin(), taken.end());
  table.matrix.append(plan.matrix());
  table.stations.insert(table.stations.end(), planned.begin(), planned.end());
  table.matrix.append(others);
  table.stations.insert(table.stations.end(), candidates.stations().begin(), candidates.stations().end());
  for (std::size_t k = 0; k < table.scans + table.planned; ++k)
    for (const CoverageMatrix::Entry& one : table.matrix.column(k)) table.attainable.raise(one.element, one.amount);
  table.matrix.set_goals(table.attainable.counts());
  if (config.link > 0)
    table.graph = overlap_graph(found.surroundings(), table.stations, kOverlapVoxels, between(progress, 0.7, 1));
  if (progress.stopped()) return std::nullopt;
  return table;
}

// Returns the fewest stations, grown from the scans, or from the remaining planned ones, which win if they are as few.
CoverSolution choose(const Table& table, const CoverProblem& problem, std::span<const PlannedStation> planned,
                     const std::stop_token& stop) {
  CoverSolution there = evaluate_cover(problem, problem.existing);
  if (there.violation == 0) return there;
  const CoverSolution grown = min_connected_cover(problem, stop).best;
  std::vector<std::size_t> start = problem.existing;
  for (std::size_t k = 0; k < planned.size(); ++k)
    if (!planned[k].taken_as && planned[k].status == StationStatus::ok) start.push_back(table.scans + k);
  if (start.size() == problem.existing.size() || start.size() - problem.existing.size() > problem.most) return grown;
  const CoverSolution of_plan = min_connected_cover(problem, stop, evaluate_cover(problem, start)).best;
  if (of_plan.violation != grown.violation) return of_plan.violation < grown.violation ? of_plan : grown;
  return of_plan.chosen.size() <= grown.chosen.size() ? of_plan : grown;
}

// Returns the first of the stations `there` that station `k` connects to `linked_to`, as no chain of links did.
std::optional<std::size_t> tied(const Table& table, std::span<const std::size_t> there, std::size_t k,
                                std::size_t linked_to, double link) {
  const Components parts = components(
      there.size(), [&](std::size_t i, std::size_t j) { return table.graph.linked(there[i], there[j], link); });
  for (std::size_t other = 0; other < there.size(); ++other)
    if (parts.of[other] != parts.of[linked_to] && table.graph.linked(k, there[other], link)) return other;
  return {};
}

// Orders the chosen stations: next is the largest gain among those linked to earlier ones, or among all if none is.
void order(const Table& table, const std::vector<std::size_t>& chosen, double link, NextAnswer& answer) {
  std::vector<std::size_t> there(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(table.scans));
  std::vector<std::size_t> left(chosen.begin() + static_cast<std::ptrdiff_t>(table.scans), chosen.end());
  std::vector<double> amounts(table.matrix.elements());
  for (const std::size_t k : there) add_column(table.matrix, k, amounts);
  double captured = captured_of(table.matrix, amounts);
  while (!left.empty()) {
    NextStation best;
    std::size_t best_at = 0;
    bool best_linked = false;
    for (std::size_t at = 0; at < left.size(); ++at) {
      NextStation one;
      one.station = table.stations[left[at]];
      std::vector<double> with = amounts;
      add_column(table.matrix, left[at], with);
      one.captured = captured_of(table.matrix, with), one.gain = one.captured - captured;
      for (std::size_t k = 0; k < there.size() && link > 0; ++k)
        if (const double overlap = table.graph.overlap(left[at], there[k]); overlap > one.overlap)
          one.overlap = overlap, one.linked_to = k;
      const bool linked = link == 0 || one.overlap >= link;
      if (at > 0 && (linked != best_linked ? best_linked : one.gain <= best.gain)) continue;
      best = one, best_at = at, best_linked = linked;
    }
    const std::size_t k = left[best_at];
    if (k < table.scans + table.planned) best.planned = k - table.scans;
    if (link > 0 && best.linked_to && best.overlap >= link) best.ties = tied(table, there, k, *best.linked_to, link);
    answer.next.push_back(best);
    there.push_back(k);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best_at));
    add_column(table.matrix, k, amounts);
    captured = best.captured;
  }
  answer.captured_then = captured;
}

// Splits the missing share into what each thing hides from all heads, and the rest.
void explain_missing(Site& found, const Table& table, std::span<const std::uint32_t> voxels,
                     std::span<const TakenScan> scans, const SiteChanges& changes, std::span<const double> amounts,
                     NextAnswer& answer) {
  answer.hidden_by.assign(changes.things.size(), 0.0);
  const Scene& scene = found.scene();
  std::vector<std::uint32_t> others, things;
  for (std::uint32_t m = 0; m < scene.meshes().size(); ++m)
    (scene.meshes()[m].name == kNotInModel ? things : others).push_back(m);
  std::optional<ModelSurface> model;  // without the things
  if (!things.empty()) model.emplace(changed_scene(scene, {}, things));
  const ModelSurface all(scene);
  const double margin = found.simulator().voxel_size_m();
  const std::vector<VoxelPatch> patches = found.simulator().voxel_patches(voxels);
  std::vector<std::size_t> hidden_by(voxels.size(), changes.things.size());
  parallel::for_all(std::size_t{0}, voxels.size(), [&](std::size_t e) {
    if (!model || !(table.matrix.goal(e) > 0) || amounts[e] >= kFilled * table.matrix.goal(e)) return;
    for (const TakenScan& scan : scans) {
      const glm::dvec3 head = to_glm(scan.head), to = to_glm(patches[e].point) - head;
      const double range = length(to) - margin;
      if (!(range > 0) || range > found.scanner().max_range_m) continue;
      const glm::dvec3 way = normalize(to);
      if (!model->passes(head, head + range * way)) continue;
      const auto met = all.first(head, way);
      if (!met || met->distance > range) continue;
      // The thing whose box is nearest to where the ray stops.
      const Vec3 at = to_vec3(head + met->distance * way);
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < changes.things.size(); ++k) {
        const double distance = beyond(at, changes.things[k].box);
        if (distance < nearest) nearest = distance, hidden_by[e] = k;
      }
      return;
    }
  });
  for (std::size_t e = 0; e < voxels.size(); ++e) {
    if (!(table.matrix.goal(e) > 0)) continue;
    const double lost =
        table.matrix.weight(e) * (1 - std::min(1.0, amounts[e] / table.matrix.goal(e))) / table.matrix.total_weight();
    const auto near = all.nearest(to_glm(patches[e].point), margin);
    if (near && scene.meshes()[near->mesh].name == kUnknown)
      answer.unknown += lost;
    else
      (hidden_by[e] < changes.things.size() ? answer.hidden_by[hidden_by[e]] : answer.not_seen) += lost;
  }
}

double distance_of(const Vec3& a, const Vec3& b) { return std::sqrt(dot(a - b, a - b)); }

std::vector<PlannedStation> judge_planned(std::span<const PlacedStation> planned, std::span<const TakenScan> scans,
                                          double within_m) {
  std::vector<PlannedStation> judged;
  for (const PlacedStation& station : planned) {
    PlannedStation one{.status = station.status};
    double nearest = within_m;
    for (std::size_t s = 0; s < scans.size(); ++s)
      if (const double distance = distance_of(scans[s].head, station.position); distance <= nearest)
        nearest = distance, one.taken_as = s;
    judged.push_back(one);
  }
  return judged;
}

}  // namespace

std::optional<NextAnswer> next_stations(Site& found, std::span<const TakenScan> scans, const SiteChanges& changes,
                                        std::span<const PlacedStation> planned, const NextConfig& config,
                                        const Progress& progress) {
  check(config, scans);
  std::vector<PlacedStation> there;  // planned stations, on the site as it was found
  for (const PlacedStation& station : planned) {
    PlacedStation placed = found.place_head(station.position).station;
    placed.setup = station.setup;
    there.push_back(placed);
  }
  NextAnswer answer;
  for (const TakenScan& scan : scans) answer.taken.push_back(station_of(found, scan));
  const std::optional<Table> made = make_table(found, scans, answer.taken, there, config, progress);
  if (!made) return std::nullopt;
  const Table& table = *made;
  answer.candidates = table.candidates;
  answer.attainable = table.attainable.coverage();
  std::vector<double> amounts(table.matrix.elements());
  for (std::size_t k = 0; k < table.scans; ++k) {
    std::vector<double> alone(table.matrix.elements());
    add_column(table.matrix, k, alone);
    answer.captured_by.push_back(captured_of(table.matrix, alone));
    add_column(table.matrix, k, amounts);
  }
  answer.captured = table.attainable.captured(std::span<const double>(amounts));
  answer.planned = judge_planned(there, scans, config.taken_within_m);
  for (std::size_t k = 0; k < there.size(); ++k) {
    std::vector<double> with = amounts;
    add_column(table.matrix, table.scans + k, with);
    answer.planned[k].gain = captured_of(table.matrix, with) - captured_of(table.matrix, amounts);
  }
  explain_missing(found, table, table.attainable.voxels(), scans, changes, amounts, answer);

  CoverProblem problem{.matrix = table.matrix,
                       .graph = config.link > 0 ? &table.graph : nullptr,
                       .existing = first_numbers(table.scans),
                       .fewest = 0,
                       .most = config.most,
                       .coverage = config.capture,
                       .link = config.link};
  const CoverSolution chosen = choose(table, problem, answer.planned, progress.stop);
  if (progress.stopped()) return std::nullopt;
  order(table, chosen.chosen, config.link, answer);
  for (const NextStation& next : answer.next)
    if (next.planned) answer.planned[*next.planned].chosen = true;
  answer.enough = chosen.violation == 0;
  answer.linked = config.link == 0 || chosen.link >= config.link;
  std::vector<PlacedStation> round;
  for (const NextStation& next : answer.next) round.push_back(next.station);
  if (!round.empty()) answer.visit = found.on_site().visit(round);
  return answer;
}

}  // namespace vantage
