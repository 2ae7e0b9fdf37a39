// SPDX-License-Identifier: Apache-2.0
#include "edit/traced_stations.hpp"

#include <algorithm>
#include <iterator>

#include "scan/sides_of.hpp"
#include "vantage/trace.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t kGroups = 20;  // of a sample, as in the simulator

}  // namespace

TracedStations::TracedStations(Simulator& simulator, std::uint64_t voxels) : simulator_(simulator) {
  if (simulator.voxel_count() > 0) sample_ = simulator.sampled_voxels(std::min(voxels, simulator.voxel_count()));
  for (const std::uint32_t voxel_index : sample_) {
    demands_.weights.push_back(static_cast<std::uint8_t>(simulator.voxel_weight(voxel_index)));
    demands_.point_weights.push_back(simulator.point_weight(voxel_index));
  }
  // Empty if all are 1, as in the simulator.
  const auto clear_ones = [](auto& of_voxels) {
    if (std::ranges::count(of_voxels, 1u) == std::ssize(of_voxels)) of_voxels.clear();
  };
  clear_ones(demands_.weights);
  clear_ones(demands_.point_weights);
}

void TracedStations::set_real(std::uint32_t id, std::vector<std::uint32_t> points) {
  std::erase_if(traced_, [&](const Traced& traced) { return traced.id == id; });
  real_[id] = std::move(points);
}

void TracedStations::follow(const Network& network, std::span<const std::uint32_t> ids) {
  std::erase_if(traced_, [&](const Traced& traced) {
    if (traced.place >= network.size() || ids[traced.place] != traced.id) return true;
    const Station& now = network[traced.place];
    return !now.active || now.position != traced.head || !(now.setup == traced.setup);
  });
  trace(network, ids);
  add_up(network);
}

std::vector<std::span<const std::uint32_t>> TracedStations::single_points() const {
  std::vector<std::span<const std::uint32_t>> points;
  for (const Traced& traced : traced_) points.emplace_back(traced.points);
  return points;
}

void TracedStations::trace(const Network& network, std::span<const std::uint32_t> ids) {
  std::vector<Network> alone;
  std::vector<Traced> fresh;
  for (std::size_t k = 0; k < network.size(); ++k) {
    if (!network[k].active || std::ranges::count(traced_, k, &Traced::place) > 0) continue;
    if (const auto real = real_.find(ids[k]); real != real_.end()) {
      traced_.push_back(
          {.place = k, .id = ids[k], .head = network[k].position, .setup = network[k].setup, .points = real->second});
      continue;
    }
    Network one = network;
    for (std::size_t other = 0; other < one.size(); ++other) one[other].active = other == k;
    alone.push_back(std::move(one));
    fresh.push_back({.place = k, .id = ids[k], .head = network[k].position, .setup = network[k].setup, .points = {}});
  }
  if (alone.empty() || sample_.empty()) return;
  simulator_.evaluate_sampled(alone, {.voxels = sample_.size(),
                                      .overlap = false,
                                      .points = [&](std::size_t n, std::span<const std::uint32_t> counted) {
                                        fresh[n].points.assign(counted.begin(), counted.end());
                                      }});
  std::ranges::move(fresh, std::back_inserter(traced_));
}

void TracedStations::add_up(const Network& network) {
  const std::size_t stations = network.size();
  points_.assign(sample_.size(), 0);
  seen_by_.assign(sample_.size(), 0);
  std::vector<std::uint64_t> masks(sample_.size() * mask_words(stations), 0);
  for (const Traced& traced : traced_)
    for (std::size_t i = 0; i < traced.points.size(); ++i) {
      points_[i] += traced.points[i];
      if (traced.points[i] == 0) continue;
      masks[traced.place / mask_bits * sample_.size() + i] |= std::uint64_t{1} << (traced.place % mask_bits);
      seen_by_[i] = together(seen_by_[i], static_cast<Seer>(traced.place + 1));
    }
  counts_ =
      reduce_sample(points_, masks, kGroups, static_cast<std::uint32_t>(stations), simulator_.goal_density(), demands_);
  share_one_sided(simulator_, counts_, network, sample_, masks);
}

}  // namespace vantage
