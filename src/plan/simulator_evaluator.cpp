// SPDX-License-Identifier: Apache-2.0
#include "plan/simulator_evaluator.hpp"

#include <tbb/parallel_for.h>

#include <utility>

namespace vantage {
namespace {

std::vector<Network> to_networks(std::span<const PlacedNetwork> placed) {
  std::vector<Network> networks;
  for (const PlacedNetwork& stations : placed) networks.push_back(to_network(stations));
  return networks;
}

}  // namespace

std::optional<std::vector<NetworkCounts>> SimulatorEvaluator::count(std::span<const Network> networks,
                                                                    const Needs& needs, bool errors,
                                                                    const Progress& progress) {
  std::vector<NetworkCounts> counts;
  if (!needs.counts) return std::vector<NetworkCounts>(networks.size());
  if (options_.sample_voxels > 0) {
    counts = simulator_.evaluate_sampled(networks,
                                         {.voxels = options_.sample_voxels,
                                          .overlap = needs.pairs,
                                          .stop_at_goal = !needs.pairs,
                                          .registration = needs.registration,
                                          .registration_groups = errors},
                                         progress);
  } else {
    for (const Network& network : networks) {
      counts.push_back(
          simulator_.evaluate(network, {.overlap = needs.pairs, .registration = needs.registration}, progress));
      if (counts.back().cancelled) break;
    }
  }
  for (const NetworkCounts& c : counts) trace_seconds_ += c.trace_seconds;
  for (const NetworkCounts& c : counts)
    if (c.cancelled) return std::nullopt;
  if (counts.size() != networks.size()) return std::nullopt;
  return counts;
}

MeasuredNetwork SimulatorEvaluator::measured(const NetworkCounts& counts, const PlacedNetwork& stations,
                                             const Network& network, const Needs& needs) const {
  return {.counts = counts,
          .stations = stations,
          .kept = options_.kept,
          .goal_density = simulator_.goal_density(),
          .voxels = simulator_.voxel_count(),
          .overlap = needs.pairs ? overlap_matrix(counts) : OverlapMatrix{},
          .visible_parts = needs.visibility ? options_.visible_parts(network) : 0};
}

std::optional<std::vector<std::vector<double>>> SimulatorEvaluator::evaluate(std::span<const PlacedNetwork> placed,
                                                                             const Progress& progress) {
  const Needs needs = measures_.searched_needs();
  const std::vector<Network> networks = to_networks(placed);
  const auto counts = count(networks, needs, false, progress);
  if (!counts) return std::nullopt;
  std::vector<std::vector<double>> values(placed.size());
  tbb::parallel_for(std::size_t{0}, placed.size(), [&](std::size_t k) {
    const MeasuredNetwork network = measured((*counts)[k], placed[k], networks[k], needs);
    for (std::size_t m = 0; m < measures_.searched; ++m) values[k].push_back(measures_.all[m].value(network));
  });
  return values;
}

std::optional<std::vector<std::vector<Estimate>>> SimulatorEvaluator::estimate(std::span<const PlacedNetwork> placed,
                                                                               const Progress& progress) {
  const Needs needs = measures_.all_needs();
  const std::vector<Network> networks = to_networks(placed);
  const auto counts = count(networks, needs, true, progress);
  if (!counts) return std::nullopt;
  std::vector<std::vector<Estimate>> estimates(placed.size());
  tbb::parallel_for(std::size_t{0}, placed.size(), [&](std::size_t k) {
    const MeasuredNetwork network = measured((*counts)[k], placed[k], networks[k], needs);
    for (const Objective& objective : measures_.all) estimates[k].push_back(vantage::estimate(objective, network));
  });
  return estimates;
}

std::optional<ConfirmedNetwork> SimulatorEvaluator::confirm(const PlacedNetwork& placed, const Progress& progress) {
  const Network network = to_network(placed);
  NetworkCounts counts =
      simulator_.evaluate(network, {.overlap = true, .registration = measures_.all_needs().registration}, progress);
  trace_seconds_ += counts.trace_seconds;
  if (counts.cancelled) return std::nullopt;
  const MeasuredNetwork seen = measured(counts, placed, network, measures_.all_needs());
  ConfirmedNetwork confirmed{.values = {}, .overlaps = seen.overlap};
  for (const Objective& objective : measures_.all) confirmed.values.push_back(objective.value(seen));
  confirmed.points_on_surveyed = std::move(counts.points_on_surveyed);
  return confirmed;
}

}  // namespace vantage
