// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/station_points.hpp"

#include <algorithm>
#include <bit>

#include "core/add_saturating.hpp"
#include "core/parallel.hpp"

namespace vantage {

// Calls f(number, first word, end of words).
template <class F>
void StationPoints::each_chunk(const F& f) const {
  constexpr std::size_t kChunkWords = kChunkVoxels / kWordVoxels;
  parallel::for_all(std::size_t{0}, (seen_.size() + kChunkWords - 1) / kChunkWords,
                    [&](std::size_t c) { f(c, c * kChunkWords, std::min(seen_.size(), (c + 1) * kChunkWords)); });
}

StationPoints::StationPoints(std::span<const std::uint32_t> counts, const StationTotals& totals)
    : totals_(totals),
      seen_((counts.size() + kWordVoxels - 1) / kWordVoxels),
      first_((counts.size() + kChunkVoxels - 1) / kChunkVoxels) {
  each_chunk([&](std::size_t c, std::size_t begin, std::size_t end) {
    for (std::size_t w = begin; w < end; ++w) {
      const std::span<const std::uint32_t> own =
          counts.subspan(w * kWordVoxels, std::min(kWordVoxels, counts.size() - w * kWordVoxels));
      for (std::size_t k = 0; k < own.size(); ++k) seen_[w] |= std::uint64_t{own[k] > 0} << k;
      first_[c] += static_cast<std::size_t>(std::popcount(seen_[w]));
    }
  });
  std::size_t sum = 0;
  for (std::size_t& first : first_) sum += std::exchange(first, sum);
  few_.resize(sum);
  each_chunk([&](std::size_t c, std::size_t begin, std::size_t end) {
    std::uint8_t* few = few_.data() + first_[c];
    for (std::size_t voxel_index = begin * kWordVoxels; voxel_index < std::min(end * kWordVoxels, counts.size());
         ++voxel_index)
      if (counts[voxel_index] > 0)
        *few++ = static_cast<std::uint8_t>(std::min<std::uint32_t>(counts[voxel_index], kMany));
  });
  if (std::find(few_.begin(), few_.end(), kMany) == few_.end()) return;
  for (std::uint32_t voxel_index = 0; voxel_index < counts.size(); ++voxel_index)
    if (counts[voxel_index] >= kMany) many_.emplace_back(voxel_index, counts[voxel_index]);
}

std::uint32_t StationPoints::count_of(std::uint32_t voxel_index) const {
  return std::lower_bound(many_.begin(), many_.end(), std::pair{voxel_index, 0u})->second;
}

void StationPoints::add_to(PassField& field, std::uint64_t bit) const {
  const bool masks = !field.stations.empty();
  each_chunk([&](std::size_t c, std::size_t begin, std::size_t end) {
    const std::uint8_t* few = few_.data() + first_[c];
    for (std::size_t w = begin; w < end; ++w) {
      for (std::uint64_t left = seen_[w]; left != 0; left &= left - 1, ++few) {
        const std::size_t voxel_index = w * kWordVoxels + static_cast<std::size_t>(std::countr_zero(left));
        const std::uint32_t points = *few == kMany ? count_of(static_cast<std::uint32_t>(voxel_index)) : *few;
        add_saturating(field.count[voxel_index], points);
        if (masks) field.stations[voxel_index] |= bit;
      }
    }
  });
}

}  // namespace vantage
