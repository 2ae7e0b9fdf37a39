// SPDX-License-Identifier: Apache-2.0
#include "search/simulator_evaluator.hpp"

#include <algorithm>
#include <utility>

#include "core/parallel.hpp"
#include "core/part_of.hpp"
#include "objective/number_of.hpp"
#include "trace/tracer_maker.hpp"

namespace vantage {
namespace {

std::vector<Network> to_networks(std::span<const PlacedNetwork> placed) {
  std::vector<Network> networks;
  for (const PlacedNetwork& stations : placed) networks.push_back(to_network(stations));
  return networks;
}

// Largest number of voxels whose points a confirmed network keeps, some 400 MB.
constexpr std::uint64_t kKeptVoxels = std::uint64_t{1} << 25;

// The model of registration on all surfaces, if that is used.
std::optional<RegistrationModel> registered_around(const RequiredInputs& needs) {
  return needs.surroundings_registration ? needs.registration : std::nullopt;
}

}  // namespace

// As many as keep all devices busy with every ray, so that a search can be stopped, and saved, often.
std::size_t SimulatorEvaluator::chunk() const {
  const std::size_t devices = std::max<std::size_t>(site_.simulator.config().devices.size(), 1);
  const TracerMaker* const shared = site_.simulator.config().shared.get();
  return shared ? devices * shared->networks_at_once() : devices;
}

std::optional<SimulatorEvaluator::Counted> SimulatorEvaluator::count(std::span<const Network> networks,
                                                                     const VoxelWindow& sample,
                                                                     const RequiredInputs& needs, bool errors,
                                                                     const Progress& progress) {
  Counted counted;
  counted.surveyed.resize(networks.size());
  // The voxels of a search are mostly those of its attainable counts: then one pass does.
  const auto on_sample = [&](const AttainableCounts* counts) {
    return counts && sample.voxels == counts->sample_voxels() && sample.from == counts->from();
  };
  const AttainableCounts* attainable = nullptr;
  if (needs.attainable) attainable = on_sample(attainable_.confirmed) ? attainable_.confirmed : attainable_.searched;
  const bool in_one = needs.counts && on_sample(attainable);
  if (needs.counts) {
    SampleOptions options{.voxels = sample.voxels,
                          .from = sample.from,
                          .overlap = needs.pairs,
                          .count_to = CountTo::goal,
                          .registration = needs.registration,
                          .meshes = needs.meshes,
                          .groups = errors};
    if (in_one) {
      counted.captured.resize(networks.size());
      options.points = [&](std::size_t k, std::span<const std::uint32_t> points) {
        counted.captured[k] = attainable->captured_shares(points);
      };
    }
    auto counts = count_with(site_.simulator, networks, options, progress);
    if (!counts) return std::nullopt;
    counted.surveyed = std::move(*counts);
  }
  if (attainable && !in_one) {
    counted.captured = captured_shares(site_.simulator, *attainable, networks, {.stop = progress.stop});
    if (counted.captured.size() < networks.size()) return std::nullopt;
  }
  if (needs.surroundings) {
    auto counts = count_with(*site_.surroundings, networks,
                             {.voxels = std::min(sample.voxels, surroundings_voxels_),
                              .from = sample.from,
                              .overlap = true,
                              .count_to = CountTo::one,
                              .registration = registered_around(needs),
                              .groups = errors},
                             {.stop = progress.stop});
    if (!counts) return std::nullopt;
    counted.surroundings = std::move(*counts);
  }
  return counted;
}

std::optional<std::vector<NetworkCounts>> SimulatorEvaluator::count_with(Simulator& simulator,
                                                                         std::span<const Network> networks,
                                                                         const SampleOptions& sample,
                                                                         const Progress& progress) {
  const EveryRayOptions every_ray{
      .overlap = sample.overlap, .registration = sample.registration, .meshes = sample.meshes};
  std::vector<NetworkCounts> counts = sample.voxels > 0 ? simulator.evaluate_sampled(networks, sample, progress)
                                                        : simulator.evaluate_each(networks, every_ray, progress);
  for (const NetworkCounts& c : counts) trace_seconds_ += c.trace_seconds;
  for (const NetworkCounts& c : counts)
    if (c.cancelled) return std::nullopt;
  return counts;
}

std::optional<std::vector<std::vector<double>>> SimulatorEvaluator::evaluate(std::span<const PlacedNetwork> placed,
                                                                             const VoxelWindow& sample,
                                                                             const Progress& progress) {
  const RequiredInputs needs = measures_.searched_needs();
  const std::vector<Network> networks = to_networks(placed);
  const auto counts = count(networks, sample, needs, false, progress);
  if (!counts) return std::nullopt;
  std::vector<std::vector<double>> values(placed.size());
  parallel::for_all(std::size_t{0}, placed.size(), [&](std::size_t k) {
    const CountedNetwork counted = counts->network(k, placed[k]);
    const MeasuredNetwork network = evaluator_.measured(counted, needs);
    for (std::size_t m = 0; m < measures_.searched; ++m) values[k].push_back(number_of(measures_.all[m], network));
  });
  return values;
}

std::optional<std::vector<std::vector<Estimate>>> SimulatorEvaluator::estimate(std::span<const PlacedNetwork> placed,
                                                                               const VoxelWindow& sample, Which which,
                                                                               const Progress& progress) {
  const bool all = which == Which::all;
  const RequiredInputs needs = all ? measures_.all_needs() : measures_.searched_needs();
  const auto estimated = std::span(measures_.all).first(all ? measures_.all.size() : measures_.searched);
  const std::vector<Network> networks = to_networks(placed);
  const auto counts = count(networks, sample, needs, true, progress);
  if (!counts) return std::nullopt;
  std::vector<std::vector<Estimate>> estimates(placed.size());
  parallel::for_all(std::size_t{0}, placed.size(), [&](std::size_t k) {
    const CountedNetwork counted = counts->network(k, placed[k]);
    const MeasuredNetwork network = evaluator_.measured(counted, needs);
    for (const Objective& objective : estimated) estimates[k].push_back(vantage::estimate(objective, network));
  });
  return estimates;
}

std::vector<std::optional<Evaluation>> SimulatorEvaluator::confirm(std::span<const PlacedNetwork> placed,
                                                                   const Progress& progress) {
  const std::vector<Network> networks = to_networks(placed);
  Counted counted;
  const bool field = networks.size() == 1 && site_.simulator.voxel_count() <= kKeptVoxels;
  static_cast<CountedNetworks&>(counted) = evaluator_.count(networks, field, progress);
  for (const auto* counts : {&counted.surveyed, &counted.surroundings})
    for (const NetworkCounts& c : *counts) trace_seconds_ += c.trace_seconds;
  const bool share = evaluator_.needs().attainable;
  if (share)
    counted.captured = captured_shares(site_.simulator, *attainable_.confirmed, networks, {.stop = progress.stop});

  std::vector<std::optional<Evaluation>> all(placed.size());
  for (std::size_t k = 0; k < placed.size(); ++k) {
    if (!counted.whole(k) || (share && counted.captured.empty())) continue;
    CountedNetwork network = counted.network(k, placed[k]);
    if (share) network.attainable = attainable_.confirmed->coverage();
    if (field) network.field = &counted.field;
    all[k] = evaluator_.evaluate(network);
  }
  return all;
}

}  // namespace vantage
