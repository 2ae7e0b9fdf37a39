// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "candidates/sample_seen.hpp"
#include "core/add_saturating.hpp"
#include "core/first_numbers.hpp"
#include "scan/sides_of.hpp"
#include "trace/sample_counts.hpp"
#include "vantage/candidates.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

// Stations counted together: enough to keep a device busy, few enough that the caller can stop soon.
constexpr std::size_t kStationsAtOnce = 64;
// Groups of a sample, for the jackknife of weighted coverage; as many as the simulator makes.
constexpr std::uint32_t kSampleGroups = 20;

}  // namespace

SampledCoverage::SampledCoverage(const Simulator& simulator, std::uint64_t sample_voxels)
    : voxels_(simulator.sampled_voxels(sample_voxels)),
      population_(simulator.voxel_count()),
      sample_voxels_(sample_voxels) {
  std::vector<std::uint32_t> weights;
  for (const std::uint32_t voxel : voxels_) {
    weights.push_back(simulator.voxel_weight(voxel));
    point_weights_.push_back(simulator.point_weight(voxel));
  }
  // Either all point weights are 1, or none is.
  if (!point_weights_.empty() && point_weights_.front() == 1) point_weights_.clear();
  matrix_ =
      CoverageMatrix(std::move(weights), simulator.goal_density() * (point_weights_.empty() ? 1 : kDensestPointWeight));
}

std::uint32_t SampledCoverage::amount(std::uint32_t element, std::uint32_t points) const {
  const double full = std::min(std::ceil(matrix_.goal()), 4294967295.0);
  const double weight = point_weights_.empty() ? 1 : point_weights_[element];
  return static_cast<std::uint32_t>(std::min(static_cast<double>(points) * weight, full));
}

void SampledCoverage::append(const SampledCoverage& other, std::size_t most) {
  if (other.voxels_ != voxels_ || other.point_weights_ != point_weights_)
    throw Error(Errc::invalid_argument, "sampled coverage: stations over two samples of voxels cannot be joined");
  matrix_.append(other.matrix_, most);
  cancelled_ = cancelled_ || other.cancelled_;
}

Estimate SampledCoverage::coverage_of(std::span<const std::uint32_t> amounts) const {
  // The engines' weights are bytes; if all are 1, coverage does not need them.
  VoxelDemands demands;
  if (std::ranges::any_of(matrix_.weights(), [](std::uint32_t w) { return w != 1; }))
    demands.weights.assign(matrix_.weights().begin(), matrix_.weights().end());
  const NetworkCounts counts = reduce_sample(amounts, {}, kSampleGroups, 1, matrix_.goal(), demands);
  return coverage_estimate(counts, matrix_.goal(), population_);
}

Estimate SampledCoverage::coverage(std::span<const std::size_t> stations) const {
  std::vector<std::uint32_t> amounts(matrix_.elements());
  for (const std::size_t k : stations)
    for (const CoverageMatrix::Entry& one : matrix_.column(k)) add_saturating(amounts[one.element], one.amount);
  return coverage_of(amounts);
}

Estimate SampledCoverage::coverage() const { return coverage(first_numbers(size())); }

SampledCoverage sample_coverage(Simulator& simulator, std::span<const PlacedStation> stations,
                                std::uint64_t sample_voxels, const Progress& progress, CountTo count_to) {
  SampledCoverage sampled(simulator, sample_voxels);
  for (std::size_t first = 0; first < stations.size(); first += kStationsAtOnce) {
    const std::size_t here = std::min(kStationsAtOnce, stations.size() - first);
    std::vector<Network> networks;
    for (const PlacedStation& station : stations.subspan(first, here))
      networks.push_back(to_network(std::span(&station, 1)));
    // Networks come in any order; columns must be in order, so they are collected first.
    std::vector<std::vector<CoverageMatrix::Entry>> columns(here);
    SampleOptions options{.voxels = sample_voxels, .overlap = false, .count_to = count_to};
    options.groups = false;
    std::size_t counted = 0;
    options.points = [&](std::size_t k, std::span<const std::uint32_t> points) {
      for (std::uint32_t i = 0; i < points.size(); ++i)
        if (points[i] > 0) columns[k].push_back({i, sampled.amount(i, points[i])});
      ++counted;
    };
    const auto share = [&](double done) {
      progress((static_cast<double>(first) + done * static_cast<double>(here)) / static_cast<double>(stations.size()));
    };
    simulator.evaluate_sampled(networks, options, {share, progress.stop});
    if (counted < here || progress.stopped()) {
      sampled.cancelled_ = true;
      break;
    }
    for (const auto& column : columns) sampled.matrix_.add(column);
  }
  return sampled;
}

CoverageMatrix sample_seen(Simulator& surroundings, std::span<const PlacedStation> stations,
                           std::uint64_t sample_voxels, const Progress& progress) {
  const SampledCoverage sampled = sample_coverage(surroundings, stations, sample_voxels, progress, CountTo::one);
  const std::vector<std::uint32_t>& voxels = sampled.voxels();
  std::vector<std::uint32_t> first{0};  // element of a voxel's first side
  for (const std::uint32_t voxel : voxels) first.push_back(first.back() + count_sides(surroundings, voxel));
  CoverageMatrix seen(std::vector<std::uint32_t>(first.back(), 1), 1);
  std::vector<CoverageMatrix::Entry> column;
  for (std::size_t k = 0; k < sampled.size(); ++k) {
    column.clear();
    for (const CoverageMatrix::Entry& one : sampled.matrix().column(k))
      column.push_back({first[one.element] + side_of(surroundings, voxels[one.element], stations[k].position), 1});
    seen.add(column);
  }
  return seen;
}

StationGraph overlap_graph(Simulator& surroundings, std::span<const PlacedStation> stations,
                           std::uint64_t sample_voxels, const Progress& progress) {
  return {sample_seen(surroundings, stations, sample_voxels, progress), stations.size()};
}

}  // namespace vantage
