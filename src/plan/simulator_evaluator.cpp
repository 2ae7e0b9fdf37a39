// SPDX-License-Identifier: Apache-2.0
#include "plan/simulator_evaluator.hpp"

#include <utility>

#include "vantage/planner.hpp"

namespace vantage {

std::optional<std::vector<NetworkCounts>> SimulatorEvaluator::count(std::span<const Network> networks, bool overlap,
                                                                    const Progress& progress) {
  std::vector<NetworkCounts> counts;
  if (options_.sample_voxels > 0) {
    counts = simulator_.evaluate_sampled(
        networks, {.voxels = options_.sample_voxels, .overlap = overlap, .stop_at_goal = !overlap}, progress);
  } else {
    for (const Network& network : networks) {
      counts.push_back(simulator_.evaluate(network, {.overlap = overlap}, progress));
      if (counts.back().cancelled) break;
    }
  }
  for (const NetworkCounts& c : counts) trace_seconds_ += c.trace_seconds;
  for (const NetworkCounts& c : counts)
    if (c.cancelled) return std::nullopt;
  if (counts.size() != networks.size()) return std::nullopt;
  return counts;
}

std::optional<std::vector<NetworkValue>> SimulatorEvaluator::evaluate(std::span<const Network> networks,
                                                                      const Progress& progress) {
  const bool overlap = options_.overlap || options_.min_link_overlap > 0;
  const auto counts = count(networks, overlap, progress);
  if (!counts) return std::nullopt;
  std::vector<NetworkValue> values;
  for (const NetworkCounts& c : *counts) {
    NetworkValue& value = values.emplace_back();
    value.coverage = coverage(c, simulator_.goal_density());
    if (!overlap) continue;
    const OverlapMatrix matrix = overlap_matrix(c);
    if (options_.overlap) value.overlap = clustering_coefficient(matrix);
    if (options_.min_link_overlap > 0) value.parts = connectivity(matrix, options_.min_link_overlap).parts;
  }
  return values;
}

std::optional<std::vector<NetworkEstimate>> SimulatorEvaluator::estimate(std::span<const Network> networks,
                                                                         const Progress& progress) {
  const auto counts = count(networks, true, progress);
  if (!counts) return std::nullopt;
  std::vector<NetworkEstimate> estimates;
  for (const NetworkCounts& c : *counts) {
    estimates.push_back({.coverage = coverage_estimate(c, simulator_.goal_density(), simulator_.voxel_count()),
                         .overlap = overlap_estimate(c, simulator_.voxel_count())});
  }
  return estimates;
}

std::optional<ConfirmedNetwork> SimulatorEvaluator::confirm(const Network& network, const Progress& progress) {
  NetworkCounts counts = simulator_.evaluate(network, {.overlap = true}, progress);
  trace_seconds_ += counts.trace_seconds;
  if (counts.cancelled) return std::nullopt;
  ConfirmedNetwork confirmed{.coverage = coverage(counts, simulator_.goal_density()),
                             .overlaps = overlap_matrix(counts)};
  confirmed.overlap = clustering_coefficient(confirmed.overlaps);
  confirmed.points_on_surveyed = std::move(counts.points_on_surveyed);
  return confirmed;
}

}  // namespace vantage
