// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/add_saturating.hpp"
#include "core/parallel.hpp"
#include "trace/pass_field.hpp"

namespace vantage {

// Buffers points for the voxel field. Each thread sorts its own by range of voxel index; then one thread adds each
// range, while that part of the field stays in the cache. This is faster than an atomic addition for each point, and
// the gain grows with the field.
class PointBuckets {
 public:
  static constexpr std::uint32_t kBuckets = 256;

  explicit PointBuckets(std::uint64_t voxels) {
    while (((voxels - 1) >> shift_) >= kBuckets && voxels > 0) ++shift_;
  }

  static constexpr std::uint32_t kMostAtOnce = 256;

  // Buckets of the calling thread.
  class Local {
   public:
    // Adds `points` to a voxel. REQUIRES: 1 <= points <= kMostAtOnce.
    void add(std::uint32_t voxel_index, std::uint32_t shift, std::uint32_t points = 1) {
      const std::uint32_t place = voxel_index & ((std::uint32_t{1} << shift) - 1);
      buckets_[voxel_index >> shift].push_back(place | (points - 1) << kPlaceBits);
    }

   private:
    friend class PointBuckets;
    std::vector<std::uint32_t> buckets_[kBuckets];  // place of the voxel in the range, and its points minus one
  };
  Local& local() { return local_.local(); }
  std::uint32_t shift() const { return shift_; }

  // Adds all points to the field under their station's bit, and empties the buckets. Counts saturate.
  void flush(PassField& field, std::uint64_t bit) {
    const bool masks = !field.stations.empty();
    parallel::for_all(std::uint32_t{0}, kBuckets, [&](std::uint32_t b) {
      for (Local& local : local_) {
        for (const std::uint32_t entry : local.buckets_[b]) {
          const std::uint32_t voxel_index = b << shift_ | (entry & ((std::uint32_t{1} << shift_) - 1));
          add_saturating(field.count[voxel_index], (entry >> kPlaceBits) + 1);
          if (masks) field.stations[voxel_index] |= bit;
        }
        local.buckets_[b].clear();
      }
    });
  }

 private:
  static constexpr std::uint32_t kPlaceBits = 24;  // 2^32 voxels in 256 ranges
  std::uint32_t shift_ = 0;
  tbb::enumerable_thread_specific<Local> local_;
};

}  // namespace vantage
