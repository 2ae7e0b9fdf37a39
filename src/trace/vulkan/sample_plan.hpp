// SPDX-License-Identifier: Apache-2.0
// Which pairs of station and sampled voxel one set of lists takes, and what becomes of those that overflow it.
//
// Lists have room for so many open pairs, rays and parts of walks and no more. How many there are is known only once
// they are listed; so chunks of pairs are as large as the lists will probably hold, and one that turns out larger comes
// again in halves, with what has been traced of it by then left out.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace vantage::vulkan {

// Slots (stations of the batch) × sampled voxels, and some parts of their walks.
struct SampleChunk {
  std::uint32_t first_slot, end_slot, first_voxel, end_voxel, first_part, end_part;
  // What has been done already, as part of a chunk that was too large for the rest.
  bool probed = false, first_traced = false;

  std::uint64_t pairs() const { return std::uint64_t{end_slot - first_slot} * (end_voxel - first_voxel); }
  // By voxels while it has several, then by slots, then by parts. REQUIRES: more than one part of one pair.
  std::array<SampleChunk, 2> halves() const;
  // A first piece and the rest, so that going on with the rest gives pieces of about the same size, of `most_pairs` at
  // most; where even one voxel has more, that voxel and the rest. REQUIRES: it has more.
  std::array<SampleChunk, 2> cut(std::uint64_t most_pairs) const;
  bool operator==(const SampleChunk&) const = default;
};

// What lists have room for: sample_part rays, all of one part, at least. `pairs`: that are open.
struct SampleRoom {
  std::uint32_t pairs, rays, parts;
};

// What pairs are thought to have, in the mean.
struct PairsSeen {
  double rays, open;
};

// Room for the lists of an engine; no dispatch traces more rays than `max_rays_per_dispatch`, where that is not 0.
SampleRoom sample_room(bool software, std::uint64_t max_rays_per_dispatch);

// What a chunk's kernels traced and listed, or wanted to.
struct SampleTally {
  std::uint32_t pairs = 0;   // that are open
  std::uint32_t probed = 0;  // rays
  std::uint32_t rays = 0;    // listed
  std::uint32_t parts = 0;   // that come later
  std::uint32_t rest = 0;    // rays listed of these
};

// What is left to do of a batch.
class SamplePlan {
 public:
  // `parts`: of a pair's walk, at most.
  SamplePlan(std::uint32_t slots, std::uint32_t voxels, std::uint32_t parts, const SampleRoom& room);

  // The chunks of the next submission, in order: each probably fits, if pairs are as has been seen, and all together
  // probably have `rays`; one at least, unless nothing is left. None has probably more than `at_once`.
  std::vector<SampleChunk> next(double rays, const PairsSeen& seen, double at_once);
  bool finished() const { return todo_.empty(); }

  // Takes note of what became of the chunks of a submission. Returns how many rays were traced.
  double settle(std::span<const SampleChunk> chunks, std::span<const SampleTally> tallies);
  double done() const;  // share of all pairs, in [0, 1]

 private:
  SampleRoom room_;
  std::uint32_t parts_;
  std::deque<SampleChunk> todo_;
  double all_pairs_, done_pairs_ = 0;
};

}  // namespace vantage::vulkan
