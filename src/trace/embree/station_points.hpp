// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "trace/embree/count_station.hpp"

namespace vantage {

// What a station alone put into every voxel, packed: a bit a voxel, and a byte for each that has points.
class StationPoints {
 public:
  // `counts`: of each voxel.
  StationPoints(std::span<const std::uint32_t> counts, const StationTotals& totals);

  const StationTotals& totals() const { return totals_; }
  std::size_t bytes() const { return seen_.size() * sizeof(seen_[0]) + few_.size() + many_.size() * sizeof(many_[0]); }
  // To a field of as many voxels, as the station with this bit. Counts saturate.
  void add_to(VoxelField& field, std::uint64_t bit) const;

 private:
  static constexpr std::size_t word = 64, chunk = 1024 * word;  // voxels; a chunk is a task
  static constexpr std::uint8_t more = 255;                     // the count is in `many_`

  template <class F>
  void each_chunk(const F& f) const;
  std::uint32_t count_of(std::uint32_t rank) const;

  StationTotals totals_;
  std::vector<std::uint64_t> seen_;                            // a bit a voxel
  std::vector<std::size_t> first_;                             // of each chunk, in `few_`
  std::vector<std::uint8_t> few_;                              // points of those that have any
  std::vector<std::pair<std::uint32_t, std::uint32_t>> many_;  // rank and points, ascending
};

}  // namespace vantage
