// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/pair_schedule.hpp"

#include <algorithm>
#include <cassert>

#include "shared/trace_types.h"

namespace vantage::vulkan {

std::array<SampleChunk, 2> SampleChunk::halves() const {
  SampleChunk a = *this, b = *this;
  if (end_voxel - first_voxel > 1) {
    a.end_voxel = b.first_voxel = first_voxel + (end_voxel - first_voxel) / 2;
  } else if (end_slot - first_slot > 1) {
    a.end_slot = b.first_slot = first_slot + (end_slot - first_slot) / 2;
  } else {
    assert(end_part - first_part > 1);
    a.end_part = b.first_part = first_part + (end_part - first_part) / 2;
  }
  return {a, b};
}

std::array<SampleChunk, 2> SampleChunk::cut(std::uint64_t most_pairs) const {
  const std::uint32_t slots = end_slot - first_slot, voxels = end_voxel - first_voxel;
  const auto even_piece = [](std::uint64_t all, std::uint64_t most) {
    const std::uint64_t pieces = (all + most - 1) / most;
    return static_cast<std::uint32_t>((all + pieces - 1) / pieces);
  };
  SampleChunk a = *this, b = *this;
  if (slots > most_pairs && voxels == 1)
    a.end_slot = b.first_slot = first_slot + even_piece(slots, most_pairs);
  else
    a.end_voxel = b.first_voxel = first_voxel + even_piece(voxels, std::max<std::uint64_t>(most_pairs / slots, 1));
  return {a, b};
}

SampleRoom sample_room(bool software, std::uint64_t max_rays_per_dispatch) {
  // Each kernel of a chunk ends with threads waiting for the last one. GPUs have many threads, so their chunks are
  // large.
  std::uint64_t rays = software ? 1u << 20 : 1u << 25;
  if (max_rays_per_dispatch > 0) rays = std::min(rays, max_rays_per_dispatch);
  // Most parts have no ray, or few rays, that are not known to be stopped.
  const auto room = static_cast<std::uint32_t>(std::max<std::uint64_t>(rays, sample_part));
  constexpr std::uint32_t kRaysOfPair = 8, kRaysOfPart = 8;
  return {room / kRaysOfPair, room, room / kRaysOfPart};
}

PairSchedule::PairSchedule(std::uint32_t slots, std::uint32_t voxels, std::uint32_t parts, const SampleRoom& room)
    : room_(room), parts_(parts), all_pairs_(static_cast<double>(slots) * voxels) {
  if (slots > 0 && voxels > 0) todo_.push_back({0, slots, 0, voxels, 0, parts});
}

std::vector<SampleChunk> PairSchedule::next(double rays, const PairsSeen& seen, double at_once) {
  constexpr double kSafety = 1.25;
  const double most_rays = std::min(at_once, static_cast<double>(room_.rays));
  const double most = std::min(most_rays / (seen.rays * kSafety), room_.pairs / (seen.open * kSafety));
  // Every pair may be probed, and no dispatch traces more rays than the list holds.
  const auto most_pairs = static_cast<std::uint64_t>(std::clamp(most, 1.0, static_cast<double>(room_.rays)));
  std::vector<SampleChunk> chunks;
  for (double expected = 0; !todo_.empty() && (chunks.empty() || expected < rays);) {
    SampleChunk chunk = todo_.front();
    todo_.pop_front();
    while (chunk.pairs() > most_pairs) {
      const auto [piece, rest] = chunk.cut(most_pairs);
      todo_.push_front(rest);
      chunk = piece;
    }
    expected += static_cast<double>(chunk.pairs()) * seen.rays;
    chunks.push_back(chunk);
  }
  return chunks;
}

double PairSchedule::settle(std::span<const SampleChunk> chunks, std::span<const SampleTally> tallies) {
  double traced = 0;
  for (std::size_t k = chunks.size(); k-- > 0;) {
    const SampleTally& tally = tallies[k];
    traced += static_cast<double>(tally.probed);
    const bool first_traced = tally.pairs <= room_.pairs && tally.rays <= room_.rays && tally.parts <= room_.parts;
    const bool all_traced = first_traced && tally.rest <= room_.rays;
    if (first_traced) traced += static_cast<double>(tally.rays);
    if (all_traced) {
      done_pairs_ += static_cast<double>(chunks[k].pairs()) * (chunks[k].end_part - chunks[k].first_part) / parts_;
      traced += static_cast<double>(tally.rest);
      continue;
    }
    auto halves = chunks[k].halves();
    for (SampleChunk& half : halves) {
      half.probed = true;
      half.first_traced = half.first_traced || first_traced;
    }
    todo_.insert(todo_.begin(), halves.begin(), halves.end());
  }
  return traced;
}

double PairSchedule::done() const { return all_pairs_ > 0 ? std::min(done_pairs_ / all_pairs_, 1.0) : 1.0; }

}  // namespace vantage::vulkan
