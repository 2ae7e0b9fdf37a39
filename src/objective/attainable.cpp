// SPDX-License-Identifier: Apache-2.0
#include "vantage/attainable.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

#include "objective/meshes_named.hpp"
#include "vantage/error.hpp"
#include "voxel/voxel_demands.hpp"

namespace vantage {
namespace {

// Stations traced together: enough to keep a device busy, few enough that the caller can stop soon.
constexpr std::size_t kStationsAtOnce = 64;
// The largest standard error of a share.
constexpr double kLargestError = 0.5;
// Number of voxels whose surfaces are examined together.
constexpr std::size_t kPatchesAtOnce = std::size_t{1} << 20;

}  // namespace

AttainableCounts::AttainableCounts(const Simulator& simulator, std::uint64_t voxels, std::uint64_t from)
    : voxels_(simulator.sampled_voxels(voxels, from)),
      counts_(voxels_.size(), 0.0),
      population_(simulator.voxel_count()),
      sample_voxels_(voxels),
      from_(from),
      goal_(simulator.goal_density()) {
  for (const std::uint32_t voxel : voxels_) {
    weights_.push_back(simulator.voxel_weight(voxel));
    point_weights_.push_back(simulator.point_weight(voxel));
  }
  // Either all are 1 or none is.
  if (!point_weights_.empty() && point_weights_.front() != 1) goal_ *= kDensestPointWeight;
}

AttainableCounts AttainableCounts::part(const Simulator& simulator, std::uint64_t voxels) const {
  AttainableCounts some(simulator, voxels, from_);
  std::size_t e = 0;
  std::vector<std::size_t> at;  // the element here of each element of `some`
  for (std::size_t k = 0; k < some.voxels_.size(); ++k) {
    while (e < voxels_.size() && voxels_[e] < some.voxels_[k]) ++e;
    if (e == voxels_.size() || voxels_[e] != some.voxels_[k])
      throw Error(Errc::invalid_argument, "attainable counts: " + std::to_string(voxels) +
                                              " voxels are no part of a sample of " + std::to_string(voxels_.size()));
    some.counts_[k] = counts_[e];
    at.push_back(e);
  }
  for (const OfMeshes& of : told_of_) {
    OfMeshes& own = some.told_of_.emplace_back(OfMeshes{.meshes = of.meshes, .has = {}});
    for (const std::size_t element : at) own.has.push_back(of.has[element]);
  }
  return some;
}

void AttainableCounts::tell_of(const Simulator& simulator, const std::string& meshes) {
  if (std::ranges::count(told_of_, meshes, &OfMeshes::meshes) > 0) return;
  const std::vector<std::uint8_t> named = meshes_named(simulator.scene(), meshes);
  OfMeshes& of = told_of_.emplace_back(OfMeshes{.meshes = meshes, .has = {}});
  of.has.reserve(voxels_.size());
  for (std::size_t first = 0; first < voxels_.size(); first += kPatchesAtOnce)
    for (const VoxelPatch& patch :
         simulator.voxel_patches(std::span(voxels_).subspan(first, std::min(kPatchesAtOnce, voxels_.size() - first))))
      of.has.push_back(named[patch.mesh]);
}

void AttainableCounts::raise(std::span<const std::uint32_t> points) {
  assert(points.size() == counts_.size());
  for (std::size_t e = 0; e < points.size(); ++e) raise(e, weighted(e, points[e]));
}

void AttainableCounts::raise(std::size_t element, double point_weights) {
  counts_[element] = std::max(counts_[element], std::min(point_weights, goal_));
}

// Returns Σ part / Σ whole with the error of a ratio: the error of the mean of part − ratio · whole, by successive
// differences, as systematic samples need (Wolter, Introduction to Variance Estimation, 2007, chapters 6 and 8).
template <class Share>
Estimate AttainableCounts::ratio(const std::vector<double>& whole, const Share& part) const {
  double parts = 0, wholes = 0;
  for (std::size_t e = 0; e < whole.size(); ++e) parts += part(e), wholes += whole[e];
  if (!(wholes > 0)) return {0, 0};
  Estimate estimate{parts / wholes, 0};
  const double n = static_cast<double>(whole.size());
  const double unsampled = 1 - n / static_cast<double>(population_);
  if (unsampled <= 0) return estimate;
  if (whole.size() < 2) return {estimate.value, kLargestError};
  double sum = 0, before = part(0) - estimate.value * whole[0];
  for (std::size_t e = 1; e < whole.size(); ++e) {
    const double now = part(e) - estimate.value * whole[e];
    sum += (now - before) * (now - before);
    before = now;
  }
  const double error_of_mean = std::sqrt(unsampled * sum / (2 * n * (n - 1)));
  estimate.standard_error = std::min(error_of_mean / (wholes / n), kLargestError);
  return estimate;
}

Estimate AttainableCounts::coverage() const {
  const std::vector<double> whole(weights_.begin(), weights_.end());
  return ratio(whole, [&](std::size_t e) { return weights_[e] * (counts_[e] / goal_); });
}

Estimate AttainableCounts::captured(std::span<const std::uint32_t> points) const {
  std::vector<double> point_weights(points.size());
  for (std::size_t e = 0; e < points.size(); ++e) point_weights[e] = weighted(e, points[e]);
  return captured(point_weights);
}

Estimate AttainableCounts::captured(std::span<const double> point_weights) const {
  return captured(point_weights, nullptr);
}

// Elements of other meshes have the weight 0; they add nothing to the ratio but their place in the sample.
Estimate AttainableCounts::captured(std::span<const double> point_weights, const OfMeshes* of) const {
  assert(point_weights.size() == counts_.size());
  const auto weight = [&](std::size_t e) { return of && of->has[e] == 0 ? 0.0 : static_cast<double>(weights_[e]); };
  std::vector<double> whole(counts_.size());
  for (std::size_t e = 0; e < whole.size(); ++e) whole[e] = weight(e) * (counts_[e] / goal_);
  return ratio(whole, [&](std::size_t e) { return weight(e) * (std::min(counts_[e], point_weights[e]) / goal_); });
}

CapturedShares AttainableCounts::captured_shares(std::span<const std::uint32_t> points) const {
  std::vector<double> point_weights(points.size());
  for (std::size_t e = 0; e < points.size(); ++e) point_weights[e] = weighted(e, points[e]);
  CapturedShares shares{.all = captured(point_weights, nullptr)};
  for (const OfMeshes& of : told_of_) shares.meshes[of.meshes] = captured(point_weights, &of);
  return shares;
}

bool raise_attainable(AttainableCounts& attainable, Simulator& simulator, std::span<const Station> stations,
                      const Progress& progress) {
  for (std::size_t first = 0; first < stations.size(); first += kStationsAtOnce) {
    std::vector<Network> alone;
    for (const Station& station : stations.subspan(first, std::min(kStationsAtOnce, stations.size() - first)))
      if (station.active) alone.push_back({station});
    // Skips voxels that have their goal, as they cannot rise.
    std::vector<std::uint8_t> enough(attainable.voxels().size());
    for (std::size_t e = 0; e < enough.size(); ++e) enough[e] = attainable.has_goal(e);
    std::size_t counted = 0;
    const auto share = [&](double done) {
      progress((static_cast<double>(first) + done * static_cast<double>(alone.size())) /
               static_cast<double>(stations.size()));
    };
    if (!alone.empty())
      simulator.evaluate_sampled(alone,
                                 {.voxels = attainable.sample_voxels(),
                                  .from = attainable.from(),
                                  .overlap = false,
                                  .count_to = CountTo::goal,
                                  .points =
                                      [&](std::size_t, std::span<const std::uint32_t> points) {
                                        attainable.raise(points);
                                        ++counted;
                                      },
                                  .groups = false,
                                  .leave_out = enough},
                                 {share, progress.stop});
    if (counted < alone.size() || progress.stopped()) return false;
  }
  return true;
}

std::vector<CapturedShares> captured_shares(Simulator& simulator, const AttainableCounts& attainable,
                                            std::span<const Network> networks, const Progress& progress) {
  std::vector<CapturedShares> shares(networks.size());
  std::size_t counted = 0;
  simulator.evaluate_sampled(networks,
                             {.voxels = attainable.sample_voxels(),
                              .from = attainable.from(),
                              .overlap = false,
                              .count_to = CountTo::goal,
                              .points =
                                  [&](std::size_t k, std::span<const std::uint32_t> points) {
                                    shares[k] = attainable.captured_shares(points);
                                    ++counted;
                                  },
                              .groups = false},
                             progress);
  if (counted < networks.size()) return {};
  return shares;
}

}  // namespace vantage
