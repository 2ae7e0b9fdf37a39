// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "trace/embree/count_station.hpp"

namespace vantage {

// Points of one station in all voxels, packed: a bit for each voxel, and a byte for each voxel with points.
class StationPoints {
 public:
  // `counts`: of each voxel.
  StationPoints(std::span<const std::uint32_t> counts, const StationTotals& totals);

  const StationTotals& totals() const { return totals_; }
  std::size_t bytes() const { return seen_.size() * sizeof(seen_[0]) + few_.size() + many_.size() * sizeof(many_[0]); }
  // Adds them to a field of as many voxels, under the station's bit. Counts saturate.
  void add_to(PassField& field, std::uint64_t bit) const;

 private:
  static constexpr std::size_t kWordVoxels = 64, kChunkVoxels = 1024 * kWordVoxels;  // voxels; a chunk is a task
  static constexpr std::uint8_t kMany = 255;                                         // the count is in `many_`

  template <class F>
  void each_chunk(const F& f) const;
  std::uint32_t count_of(std::uint32_t voxel_index) const;

  StationTotals totals_;
  std::vector<std::uint64_t> seen_;                            // a bit per voxel
  std::vector<std::size_t> first_;                             // per chunk, its start in `few_`
  std::vector<std::uint8_t> few_;                              // counts of voxels with points
  std::vector<std::pair<std::uint32_t, std::uint32_t>> many_;  // voxel index and points, ascending
};

}  // namespace vantage
