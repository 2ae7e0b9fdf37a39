// SPDX-License-Identifier: Apache-2.0
// Which pairs of station and sampled voxel one list of rays takes, and what becomes of those that overflow it.
//
// A list has room for so many rays and no more. How many rays a pair has is known only once they are listed; so chunks
// of pairs are as large as the list will probably hold, and one that turns out larger is traced not at all and comes
// again in halves.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace vantage::vulkan {

// Slots (stations of the batch) × sampled voxels, or some rows of the pattern for a single pair.
struct SampleChunk {
  std::uint32_t first_slot, end_slot, first_voxel, end_voxel, first_row, end_row;

  std::uint64_t pairs() const { return std::uint64_t{end_slot - first_slot} * (end_voxel - first_voxel); }
  // By slots while it has several, then by voxels, then by rows. REQUIRES: more than one row of one pair.
  std::array<SampleChunk, 2> halves() const;
  bool operator==(const SampleChunk&) const = default;
};

// What a chunk's kernels wanted to list; or how much of that there is room for.
struct SampleList {
  std::uint32_t rays, items;
  std::uint32_t rest = 0;  // rays that came of the items; there is room for them where there is for these
};

// Room for the lists of an engine: as many rays as a dispatch may trace, where that is limited, and never less than a
// row of one pair may have.
SampleList sample_room(std::uint32_t columns, bool software, std::uint64_t max_rays_per_dispatch);

// What is left to do of a batch.
class SamplePlan {
 public:
  SamplePlan(std::uint32_t slots, std::uint32_t voxels, std::uint32_t rows, const SampleList& room);

  // The chunks of the next submission, in order: each probably fits, if a pair has so many rays, and all together
  // probably have `rays`; one at least, unless nothing is left. None has probably more than `at_once`.
  std::vector<SampleChunk> next(double rays, double rays_per_pair, double at_once);
  bool finished() const { return todo_.empty(); }

  // Takes note of what the chunks of a submission wanted to list. Returns how many rays were traced.
  double settle(std::span<const SampleChunk> chunks, std::span<const SampleList> wanted);
  double done() const;  // share of all pairs, in [0, 1]

 private:
  bool fits(const SampleList& wanted) const { return wanted.rays <= room_.rays && wanted.items <= room_.items; }

  SampleList room_;
  std::uint32_t rows_;
  std::deque<SampleChunk> todo_;
  double all_pairs_, done_pairs_ = 0;
};

}  // namespace vantage::vulkan
