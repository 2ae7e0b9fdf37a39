// SPDX-License-Identifier: Apache-2.0
// Schedules an exact evaluation: rows of stations that are traced together, and clamping of counts.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace vantage::vulkan {

// Rows of one station, traced by one dispatch.
struct CountPart {
  std::uint32_t station, first_row, row_count;
  std::uint32_t slot;  // index of its station in the submission
  std::uint64_t list;  // offset of its list of tiles in the submission, in words
};

// Cuts all rows of all stations into parts, and parts into submissions, in order.
class CountSchedule {
 public:
  static constexpr std::uint32_t kStationsPerSubmission = 16, kPartsPerSubmission = 256;

  // REQUIRES: rows_per_part is a multiple of tile_side, so that no tile belongs to two parts.
  CountSchedule(std::uint32_t stations, std::uint32_t rows, std::uint32_t columns, std::uint32_t rows_per_part);

  // Returns the parts of the next submission: all that begin below `rays` rays, at least one unless finished. No part
  // has more rays than that, as far as whole tiles allow.
  std::vector<CountPart> next(double rays);
  bool finished() const { return station_ == stations_; }

  std::uint64_t rays_of(std::span<const CountPart> parts) const;
  std::uint64_t all_rays() const { return std::uint64_t{rows_} * columns_ * stations_; }
  std::uint32_t tiles_in_row() const;
  std::uint32_t tiles() const;                          // per station
  std::uint32_t tiles_of(const CountPart& part) const;  // size of its list: the number of tiles, then the tiles
  std::uint64_t list_words() const;                     // enough for the lists of any submission

 private:
  std::uint32_t stations_, rows_, columns_, rows_per_part_;
  std::uint32_t station_ = 0, row_ = 0;
};

// Tracks how much dispatches may have added to a 32-bit count since all counts were clamped to count_limit.
class CountHeadroom {
 public:
  // Returns true if counts must be clamped before a dispatch of `rays` rays, which is then the first one after it.
  // REQUIRES: rays < count_limit.
  bool clamp_before(std::uint64_t rays);

 private:
  std::uint64_t added_ = 0;
};

}  // namespace vantage::vulkan
