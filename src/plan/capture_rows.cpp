// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "core/add_saturating.hpp"
#include "trace/sample_counts.hpp"
#include "vantage/candidates.hpp"
#include "vantage/error.hpp"
#include "vantage/planner.hpp"

namespace vantage {
namespace {

// Stations counted together: enough to keep a device busy, few enough that the caller can stop soon.
constexpr std::size_t stations_at_once = 64;
// Of a sample, for the jackknife of weighted coverage; as many as the simulator makes.
constexpr std::uint32_t sample_groups = 20;

}  // namespace

CaptureRows::CaptureRows(const Simulator& simulator, std::uint64_t sample_voxels)
    : voxels_(simulator.sampled_voxels(sample_voxels)),
      population_(simulator.voxel_count()),
      sample_voxels_(sample_voxels) {
  for (const std::uint32_t rank : voxels_) {
    weights_.push_back(simulator.voxel_weight(rank));
    worths_.push_back(simulator.point_worth(rank));
  }
  // All are 1, or none is.
  if (!worths_.empty() && worths_.front() == 1) worths_.clear();
  goal_density_ = simulator.goal_density() * (worths_.empty() ? 1 : densest_worth);
  total_weight_ = std::accumulate(weights_.begin(), weights_.end(), 0.0);
}

CaptureRows::CaptureRows(std::vector<std::uint32_t> weights, double goal_density)
    : voxels_(weights.size()),
      weights_(std::move(weights)),
      goal_density_(goal_density),
      population_(voxels_.size()),
      sample_voxels_(voxels_.size()) {
  std::iota(voxels_.begin(), voxels_.end(), 0u);
  total_weight_ = std::accumulate(weights_.begin(), weights_.end(), 0.0);
}

CapturedVoxel CaptureRows::captured(std::uint32_t voxel, std::uint32_t points) const {
  if (worths_.empty()) return {voxel, points};
  const double full = std::min(std::ceil(goal_density_), 4294967295.0);
  return {voxel, static_cast<std::uint32_t>(std::min(static_cast<double>(points) * worths_[voxel], full))};
}

void CaptureRows::add(std::span<const std::uint32_t> points) {
  assert(points.size() == voxels_.size());
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (points[i] > 0) entries_.push_back(captured(i, points[i]));
  offsets_.push_back(entries_.size());
}

void CaptureRows::append(const CaptureRows& rows, std::size_t most) {
  if (rows.voxels_ != voxels_ || rows.goal_density_ != goal_density_ || rows.worths_ != worths_)
    throw Error(Errc::invalid_argument, "capture rows of two samples cannot be joined");
  const std::size_t before = entries_.size(), count = std::min(most, rows.size());
  entries_.insert(entries_.end(), rows.entries_.begin(),
                  rows.entries_.begin() + static_cast<std::ptrdiff_t>(rows.offsets_[count]));
  for (std::size_t k = 1; k <= count; ++k) offsets_.push_back(before + rows.offsets_[k]);
  cancelled_ = cancelled_ || rows.cancelled_;
}

Estimate CaptureRows::coverage_of(std::span<const std::uint32_t> points) const {
  // The engines' weights are bytes, and a coverage does not change where all of them are 1.
  VoxelDemands demands;
  if (std::any_of(weights_.begin(), weights_.end(), [](std::uint32_t w) { return w != 1; }))
    demands.weights.assign(weights_.begin(), weights_.end());
  const NetworkCounts counts = reduce_sample(points, {}, sample_groups, 1, goal_density_, demands);
  return coverage_estimate(counts, goal_density_, population_);
}

Estimate CaptureRows::coverage(std::span<const std::size_t> rows) const {
  std::vector<std::uint32_t> points(voxels_.size());
  for (const std::size_t k : rows)
    for (const CapturedVoxel& seen : row(k)) add_saturating(points[seen.voxel], seen.points);
  return coverage_of(points);
}

Estimate CaptureRows::coverage() const {
  std::vector<std::uint32_t> points(voxels_.size());
  for (const CapturedVoxel& seen : entries_) add_saturating(points[seen.voxel], seen.points);
  return coverage_of(points);
}

CaptureRows capture_rows(Simulator& simulator, std::span<const PlacedStation> stations, std::uint64_t sample_voxels,
                         const Progress& progress) {
  CaptureRows rows(simulator, sample_voxels);
  for (std::size_t first = 0; first < stations.size(); first += stations_at_once) {
    const std::size_t here = std::min(stations_at_once, stations.size() - first);
    std::vector<Network> networks;
    for (const PlacedStation& station : stations.subspan(first, here))
      networks.push_back(to_network(std::span(&station, 1)));
    // Networks come in any order, rows must not: kept sparse until all are there.
    std::vector<std::vector<CapturedVoxel>> seen(here);
    SampleOptions options{.voxels = sample_voxels, .overlap = false, .stop_at_goal = false};
    std::size_t told = 0;
    options.points = [&](std::size_t k, std::span<const std::uint32_t> points) {
      for (std::uint32_t i = 0; i < points.size(); ++i)
        if (points[i] > 0) seen[k].push_back(rows.captured(i, points[i]));
      ++told;
    };
    const auto share = [&](double done) {
      progress((static_cast<double>(first) + done * static_cast<double>(here)) / static_cast<double>(stations.size()));
    };
    simulator.evaluate_sampled(networks, options, {share, progress.stop});
    if (told < here || progress.stopped()) {
      rows.cancelled_ = true;
      break;
    }
    for (const std::vector<CapturedVoxel>& one : seen) {
      rows.entries_.insert(rows.entries_.end(), one.begin(), one.end());
      rows.offsets_.push_back(rows.entries_.size());
    }
  }
  return rows;
}

}  // namespace vantage
