// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "vantage/trace.hpp"

namespace vantage {

// Buffers points for the voxel field. Each thread sorts its own by range of voxel index; then a single thread adds each
// range, while that part of the field stays in the cache. This is faster than an atomic addition per point, and the
// gain grows with the field.
class PointBuckets {
 public:
  static constexpr std::uint32_t count = 256;

  explicit PointBuckets(std::uint64_t voxels) {
    while (((voxels - 1) >> shift_) >= count && voxels > 0) ++shift_;
  }

  // The calling thread's buckets.
  class Local {
   public:
    void add(std::uint32_t voxel_index, std::uint32_t shift) { buckets_[voxel_index >> shift].push_back(voxel_index); }

   private:
    friend class PointBuckets;
    std::vector<std::uint32_t> buckets_[count];
  };
  Local& local() { return local_.local(); }
  std::uint32_t shift() const { return shift_; }

  // Adds all points to the field under the bit of their station, and empties the buckets. Counts saturate.
  void flush(VoxelField& field, std::uint64_t bit) {
    const bool masks = !field.stations.empty();
    tbb::parallel_for(std::uint32_t{0}, count, [&](std::uint32_t b) {
      for (Local& local : local_) {
        for (const std::uint32_t voxel_index : local.buckets_[b]) {
          std::uint32_t& n = field.count[voxel_index];
          n += n != std::numeric_limits<std::uint32_t>::max();
          if (masks) field.stations[voxel_index] |= bit;
        }
        local.buckets_[b].clear();
      }
    });
  }

 private:
  std::uint32_t shift_ = 0;
  tbb::enumerable_thread_specific<Local> local_;
};

}  // namespace vantage
