// SPDX-License-Identifier: Apache-2.0
// Schedules sampled evaluation: the pairs of station and sampled voxel for one set of lists, and how overflow is
// handled.
//
// Lists have limited room for open pairs, rays and parts of walks, and the numbers needed are known only after listing.
// A chunk of pairs is therefore as large as the lists probably hold. If it overflows, it is repeated in halves, without
// work that was already traced.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace vantage::vulkan {

// Slots (stations of the batch) × sampled voxels, and a range of parts of their walks.
struct SampleChunk {
  std::uint32_t first_slot, end_slot, first_voxel, end_voxel, first_part, end_part;
  // Work already done, by a chunk whose other work did not fit.
  bool probed = false, first_traced = false;

  std::uint64_t pairs() const { return std::uint64_t{end_slot - first_slot} * (end_voxel - first_voxel); }
  // Splits by voxels while there are several, then by slots, then by parts. REQUIRES: more than one part of one pair.
  std::array<SampleChunk, 2> halves() const;
  // Cuts off a first piece of at most `most_pairs`; cutting the rest again gives pieces of similar size. If one voxel
  // alone has more, the piece is that voxel. REQUIRES: it has more than `most_pairs`.
  std::array<SampleChunk, 2> cut(std::uint64_t most_pairs) const;
  bool operator==(const SampleChunk&) const = default;
};

// Capacity of the lists: at least sample_part rays, those of one part. `pairs`: open ones.
struct SampleRoom {
  std::uint32_t pairs, rays, parts;
};

// Mean figures of pairs, from experience.
struct PairsSeen {
  double rays, open;
};

// Capacity of an engine's lists. No dispatch traces more rays than `max_rays_per_dispatch`, unless that is 0.
SampleRoom sample_room(bool software, std::uint64_t max_rays_per_dispatch);

// Numbers that a chunk's kernels traced and listed, or would have listed.
struct SampleTally {
  std::uint32_t pairs = 0;   // open
  std::uint32_t probed = 0;  // rays
  std::uint32_t rays = 0;    // listed
  std::uint32_t parts = 0;   // to be listed later
  std::uint32_t rest = 0;    // rays listed for those parts
};

// Work left in a batch.
class PairSchedule {
 public:
  // `parts`: most parts of a pair's walk.
  PairSchedule(std::uint32_t slots, std::uint32_t voxels, std::uint32_t parts, const SampleRoom& room);

  // Returns the chunks of the next submission, in order, at least one unless nothing is left. Each chunk probably fits
  // and has at most `at_once` rays, and all together have `rays`, judged by `seen`.
  std::vector<SampleChunk> next(double rays, const PairsSeen& seen, double at_once);
  bool finished() const { return todo_.empty(); }

  // Records the outcome of a submission's chunks. Returns the number of rays traced.
  double settle(std::span<const SampleChunk> chunks, std::span<const SampleTally> tallies);
  double done() const;  // share of all pairs that are done, in [0, 1]

 private:
  SampleRoom room_;
  std::uint32_t parts_;
  std::deque<SampleChunk> todo_;
  double all_pairs_, done_pairs_ = 0;
};

}  // namespace vantage::vulkan
