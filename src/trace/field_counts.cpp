// SPDX-License-Identifier: Apache-2.0
// Pairs are counted on bit planes. The masks of 64 voxels, a word each, are transposed into a word for each station
// (Warren: Hacker's Delight, 2nd edition, 2012, section 7-3), so one AND and one population count serve 64 voxels.
#include "trace/field_counts.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "core/target_clones.hpp"

namespace vantage {
namespace {

constexpr std::size_t block = 64;  // voxels per block: bits in a word

struct Sums {
  std::uint64_t weight = 0, saturated = 0, partial_points = 0;
  std::vector<std::uint64_t> seen, shared;

  void add(const Sums& other) {
    weight += other.weight;
    saturated += other.saturated;
    partial_points += other.partial_points;
    for (std::size_t i = 0; i < seen.size(); ++i) seen[i] += other.seen[i];
    for (std::size_t i = 0; i < shared.size(); ++i) shared[i] += other.shared[i];
  }
};

void transpose(std::array<std::uint64_t, block>& rows) {
  std::uint64_t low = 0x00000000FFFFFFFFu;
  for (std::size_t half = 32; half != 0; half >>= 1, low ^= low << half) {
    for (std::size_t i = 0; i < block; i = ((i | half) + 1) & ~half) {
      const std::uint64_t swapped = ((rows[i] >> half) ^ rows[i | half]) & low;
      rows[i] ^= swapped << half;
      rows[i | half] ^= swapped;
    }
  }
}

// For up to 64 stations.
VANTAGE_TARGET_CLONES
void add_pairs(const std::uint64_t* masks, std::size_t n, std::size_t stations, std::uint64_t* seen,
               std::uint64_t* shared) {
  for (std::size_t first = 0; first < n; first += block) {
    std::array<std::uint64_t, block> planes{};
    const std::size_t end = std::min(n, first + block);
    std::uint64_t any = 0;
    for (std::size_t k = first; k < end; ++k) any |= planes[k - first] = masks[k];
    if (any == 0) continue;
    transpose(planes);
    std::uint64_t* pair = shared;
    for (std::size_t i = 0; i < stations; ++i) {
      const std::uint64_t plane = planes[i];
      const std::size_t rest = stations - i - 1;
      if (plane != 0) {
        seen[i] += static_cast<std::uint64_t>(std::popcount(plane));
        for (std::size_t j = 0; j < rest; ++j)
          pair[j] += static_cast<std::uint64_t>(std::popcount(plane & planes[i + 1 + j]));
      }
      pair += rest;
    }
  }
}

// For more stations: pairs only those that see any voxel of the block. `size`: number of voxels, which is the distance
// between words.
VANTAGE_TARGET_CLONES
void add_many_pairs(const std::uint64_t* masks, std::size_t size, std::size_t n, std::size_t stations,
                    std::uint64_t* seen, std::uint64_t* shared) {
  std::vector<std::uint64_t> plane(stations);
  std::vector<std::size_t> here;
  for (std::size_t first = 0; first < n; first += block) {
    here.clear();
    const std::size_t end = std::min(n, first + block);
    for (std::size_t w = 0; w < mask_words(stations); ++w) {
      std::array<std::uint64_t, block> planes{};
      std::uint64_t any = 0;
      for (std::size_t k = first; k < end; ++k) any |= planes[k - first] = masks[w * size + k];
      if (any == 0) continue;
      transpose(planes);
      for (; any != 0; any &= any - 1) {
        const auto b = static_cast<std::size_t>(std::countr_zero(any));
        plane[w * mask_bits + b] = planes[b];
        here.push_back(w * mask_bits + b);
      }
    }
    for (std::size_t a = 0; a < here.size(); ++a) {
      const std::size_t i = here[a];
      seen[i] += static_cast<std::uint64_t>(std::popcount(plane[i]));
      std::uint64_t* const pair = shared + i * (2 * stations - i - 1) / 2;
      for (std::size_t b = a + 1; b < here.size(); ++b)
        pair[here[b] - i - 1] += static_cast<std::uint64_t>(std::popcount(plane[i] & plane[here[b]]));
    }
  }
}

}  // namespace

NetworkCounts reduce_field(std::span<const std::uint32_t> counts, std::span<const std::uint64_t> masks,
                           std::uint32_t stations, double goal_density, const VoxelDemands& demands) {
  const std::size_t pairs = masks.empty() ? 0 : std::size_t{stations} * (stations - 1) / 2;
  Sums zero;
  zero.seen.resize(masks.empty() ? 0 : stations);
  zero.shared.resize(pairs);
  const double goal = std::ceil(goal_density * demands.least_point_weight());

  constexpr std::size_t grain = 1024;  // blocks
  const std::size_t blocks = (counts.size() + block - 1) / block;
  const Sums sums = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, blocks, grain), zero,
      [&](const tbb::blocked_range<std::size_t>& range, Sums part) {
        const std::size_t first = range.begin() * block, end = std::min(counts.size(), range.end() * block);
        for (std::size_t k = first; k < end; ++k) {
          const std::uint64_t weight = demands.weight(k),
                              weighted_points = std::uint64_t{counts[k]} * demands.point_weight(k);
          part.weight += weight;
          if (static_cast<double>(weighted_points) >= goal) {
            part.saturated += weight;
          } else {
            part.partial_points += weight * weighted_points;
          }
        }
        if (!masks.empty() && stations > mask_bits)
          add_many_pairs(masks.data() + first, counts.size(), end - first, stations, part.seen.data(),
                         part.shared.data());
        else if (!masks.empty())
          add_pairs(masks.data() + first, end - first, stations, part.seen.data(), part.shared.data());
        return part;
      },
      [](Sums a, const Sums& b) {
        a.add(b);
        return a;
      });

  NetworkCounts result;
  result.voxels = counts.size();
  result.stations = stations;
  result.weight = sums.weight;
  result.point_weight = demands.least_point_weight();
  result.saturated = sums.saturated;
  result.partial_points = sums.partial_points;
  result.seen = sums.seen;
  result.shared = sums.shared;
  return result;
}

}  // namespace vantage
