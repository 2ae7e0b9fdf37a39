// SPDX-License-Identifier: Apache-2.0
#include "report/report.hpp"

#include <cmath>
#include <utility>

#include "export/front_view.hpp"
#include "vantage/export.hpp"

namespace vantage {

Report report_of(const PlanResult& result, const Simulator& simulator) {
  Report report{.question = problem_line(result.problem),
                .answer = answer(result),
                .measures = result.measures,
                .parameters = run_parameters_json(simulator, &result)};
  if (result.problem.objectives.size() > 1) {
    const FrontView view(result);
    report.front_axes = {view.x(), view.y()};
    if (view.third()) report.front_axes.push_back(*view.third());
  }
  for (const PlanEntry& entry : result.front) {
    ReportNetwork network{.entry = entry, .names = station_names(entry.stations), .summary = summary_of(entry, result)};
    if (entry.confirmed)
      network.links =
          entry.exact_scan_overlap_matrix.size() > 0 ? entry.exact_scan_overlap_matrix : entry.exact_overlap_matrix;
    report.networks.push_back(std::move(network));
  }
  return report;
}

ReportNetwork measured_network(std::span<const PlacedStation> stations, std::vector<std::string> names,
                               const NetworkCounts& counts, const Simulator& simulator, OverlapMatrix scan_overlaps,
                               double link) {
  ReportNetwork network{.names = std::move(names)};
  PlanEntry& entry = network.entry;
  entry.stations.assign(stations.begin(), stations.end());
  entry.confirmed = counts.voxels == simulator.voxel_count();
  const auto known = [&](const Estimate& estimate) {
    return MeasuredValue{.searched = estimate.value,
                         .standard_error = estimate.standard_error,
                         .exact = entry.confirmed ? estimate.value : std::nan("")};
  };
  const Estimate covered = coverage_estimate(counts, simulator.goal_density(), simulator.voxel_count());
  entry.values["coverage"] = known(covered);
  if (entry.confirmed) entry.points_on_surveyed = counts.points_on_surveyed;
  network.summary = {.names = network.names, .captured = covered.value, .captured_error = covered.standard_error};
  if (!counts.seen.empty()) {
    entry.values["overlap"] = known(overlap_estimate(counts, simulator.voxel_count()));
    entry.exact_overlap_matrix = overlap_matrix(counts);
  }
  if (scan_overlaps.size() > 0) {
    network.summary.links = scan_links(scan_overlaps, link, stations);
    entry.exact_scan_overlap_matrix = network.links = std::move(scan_overlaps);
  }
  network.summary.faults = station_faults(stations, network.names);
  return network;
}

std::string link_words(const ReportNetwork& network) {
  return network.summary.links && network.summary.links->measure == scan_overlap_measure ? "Scan overlap" : "Overlap";
}

Report report_of(ReportNetwork network, const Simulator& simulator) {
  const std::size_t stations = network.names.size();
  Report report{.question = std::to_string(stations) + (stations == 1 ? " station" : " stations") + ", as given",
                .parameters = run_parameters_json(simulator)};
  for (const char* name : {"coverage", "overlap"})
    if (network.entry.values.contains(name)) report.measures.push_back(make_objective(name));
  report.networks.push_back(std::move(network));
  return report;
}

}  // namespace vantage
