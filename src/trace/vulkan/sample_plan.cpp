// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/sample_plan.hpp"

#include <algorithm>
#include <cassert>

#include "shared/trace_types.h"
#include "trace/vulkan/groups.hpp"

namespace vantage::vulkan {

std::array<SampleChunk, 2> SampleChunk::halves() const {
  SampleChunk a = *this, b = *this;
  if (end_slot - first_slot > 1) {
    a.end_slot = b.first_slot = first_slot + (end_slot - first_slot) / 2;
  } else if (end_voxel - first_voxel > 1) {
    a.end_voxel = b.first_voxel = first_voxel + (end_voxel - first_voxel) / 2;
  } else {
    assert(end_row - first_row > 1);
    a.end_row = b.first_row = first_row + (end_row - first_row) / 2;
  }
  return {a, b};
}

SampleList sample_room(std::uint32_t columns, bool software, std::uint64_t max_rays_per_dispatch) {
  std::uint64_t rays = software ? 1u << 20 : 1u << 24;
  if (max_rays_per_dispatch > 0) rays = std::min(rays, max_rays_per_dispatch);
  // Whatever comes of the items has room where they have.
  const auto room =
      static_cast<std::uint32_t>(std::max<std::uint64_t>({rays, std::uint64_t{2} * columns, sample_part}));
  return {room, room / sample_part};
}

SamplePlan::SamplePlan(std::uint32_t slots, std::uint32_t voxels, std::uint32_t rows, const SampleList& room)
    : room_(room), rows_(rows), all_pairs_(static_cast<double>(slots) * voxels) {
  if (slots > 0 && voxels > 0) todo_.push_back({0, slots, 0, voxels, 0, rows});
}

std::vector<SampleChunk> SamplePlan::next(double rays, double rays_per_pair, double at_once) {
  constexpr double safety = 1.5;
  const double most = std::min(at_once, static_cast<double>(room_.rays));
  const auto too_large = [&](const SampleChunk& chunk) {
    return chunk.end_slot - chunk.first_slot > most_groups ||
           groups_of(chunk.end_voxel - chunk.first_voxel) > most_groups ||
           (chunk.pairs() > 1 && static_cast<double>(chunk.pairs()) * rays_per_pair * safety > most);
  };
  std::vector<SampleChunk> chunks;
  for (double expected = 0; !todo_.empty() && (chunks.empty() || expected < rays);) {
    SampleChunk chunk = todo_.front();
    todo_.pop_front();
    while (too_large(chunk)) {
      const auto [a, b] = chunk.halves();
      todo_.push_front(b);
      chunk = a;
    }
    expected += static_cast<double>(chunk.pairs()) * rays_per_pair;
    chunks.push_back(chunk);
  }
  return chunks;
}

double SamplePlan::settle(std::span<const SampleChunk> chunks, std::span<const SampleList> wanted) {
  double traced = 0;
  for (std::size_t k = chunks.size(); k-- > 0;) {
    if (fits(wanted[k])) {
      done_pairs_ += static_cast<double>(chunks[k].pairs()) * (chunks[k].end_row - chunks[k].first_row) / rows_;
      traced += static_cast<double>(wanted[k].rays) + wanted[k].rest;
    } else {
      const auto [a, b] = chunks[k].halves();
      todo_.push_front(b);
      todo_.push_front(a);
    }
  }
  return traced;
}

double SamplePlan::done() const { return all_pairs_ > 0 ? std::min(done_pairs_ / all_pairs_, 1.0) : 1.0; }

}  // namespace vantage::vulkan
