// SPDX-License-Identifier: Apache-2.0
// Pairs are counted on bit planes. The masks of 64 voxels, a word each, are transposed into a word for each station
// (Warren: Hacker's Delight, 2nd edition, 2012, section 7-3), so one AND and one population count serve 64 voxels.
#include "trace/field_counts.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "core/target_clones.hpp"

namespace vantage {
namespace {

constexpr std::size_t kBlockVoxels = 64;  // voxels per block: bits in a word

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

void transpose(std::array<std::uint64_t, kBlockVoxels>& rows) {
  std::uint64_t low = 0x00000000FFFFFFFFu;
  for (std::size_t half = 32; half != 0; half >>= 1, low ^= low << half) {
    for (std::size_t i = 0; i < kBlockVoxels; i = ((i | half) + 1) & ~half) {
      const std::uint64_t swapped = ((rows[i] >> half) ^ rows[i | half]) & low;
      rows[i] ^= swapped << half;
      rows[i | half] ^= swapped;
    }
  }
}

// Counts pairs of up to 64 stations.
VANTAGE_TARGET_CLONES
void add_few_pairs(const std::uint64_t* masks, std::size_t n, std::size_t stations, std::uint64_t* seen,
                   std::uint64_t* shared) {
  for (std::size_t first = 0; first < n; first += kBlockVoxels) {
    std::array<std::uint64_t, kBlockVoxels> planes{};
    const std::size_t end = std::min(n, first + kBlockVoxels);
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

// Counts pairs of more stations, but only of those that see any voxel of the block. `words`: for each 64 stations a
// span of n voxels, empty if it is 0 for all of them.
VANTAGE_TARGET_CLONES
void add_many_pairs(std::span<const std::span<const std::uint64_t>> words, std::size_t n, std::size_t stations,
                    std::uint64_t* seen, std::uint64_t* shared) {
  std::vector<std::uint64_t> plane(stations);
  std::vector<std::size_t> here;
  for (std::size_t first = 0; first < n; first += kBlockVoxels) {
    here.clear();
    const std::size_t end = std::min(n, first + kBlockVoxels);
    for (std::size_t w = 0; w < words.size(); ++w) {
      if (words[w].empty()) continue;
      std::array<std::uint64_t, kBlockVoxels> planes{};
      std::uint64_t any = 0;
      for (std::size_t k = first; k < end; ++k) any |= planes[k - first] = words[w][k];
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

// Masks stored word by word, each for all voxels.
struct DenseMasks {
  std::span<const std::uint64_t> masks;
  std::size_t voxels;

  bool empty() const { return masks.empty(); }
  // Returns word w of voxels [first, end).
  std::span<const std::uint64_t> words(std::size_t w, std::size_t first, std::size_t end) const {
    return masks.subspan(w * voxels + first, end - first);
  }
};

// Masks kept by a voxel field.
struct KeptMasks {
  const StationMasks& masks;

  bool empty() const { return masks.empty(); }
  // REQUIRES: within one block of the masks.
  std::span<const std::uint64_t> words(std::size_t w, std::size_t first, std::size_t end) const {
    const std::span<const std::uint64_t> own = masks.block(w, first / StationMasks::block_voxels);
    return own.empty() ? own : own.subspan(first % StationMasks::block_voxels, end - first);
  }
};

template <class Masks>
NetworkCounts reduce(std::span<const std::uint32_t> counts, const Masks& masks, std::uint32_t stations,
                     double goal_density, const VoxelDemands& demands) {
  Sums zero;
  zero.seen.resize(masks.empty() ? 0 : stations);
  zero.shared.resize(masks.empty() ? 0 : std::size_t{stations} * (stations - 1) / 2);
  const double goal = std::ceil(goal_density * demands.least_point_weight());

  constexpr std::size_t kGrain = 16, kAtOnce = StationMasks::block_voxels;
  const std::size_t parts = (counts.size() + kAtOnce - 1) / kAtOnce;
  const auto add_part = [&](Sums& sums, std::size_t first, std::size_t end) {
    for (std::size_t k = first; k < end; ++k) {
      const std::uint64_t weight = demands.weight(k),
                          weighted_points = std::uint64_t{counts[k]} * demands.point_weight(k);
      sums.weight += weight;
      if (static_cast<double>(weighted_points) >= goal) {
        sums.saturated += weight;
      } else {
        sums.partial_points += weight * weighted_points;
      }
    }
    if (masks.empty()) return;
    std::array<std::span<const std::uint64_t>, mask_words(max_stations)> words;
    for (std::size_t w = 0; w < mask_words(stations); ++w) words[w] = masks.words(w, first, end);
    add_pairs(std::span(words).first(mask_words(stations)), end - first, stations, sums.seen, sums.shared);
  };
  const Sums sums = parallel::reduce(
      tbb::blocked_range<std::size_t>(0, parts, kGrain), zero,
      [&](const tbb::blocked_range<std::size_t>& range, Sums part) {
        for (std::size_t p = range.begin(); p != range.end(); ++p)
          add_part(part, p * kAtOnce, std::min(counts.size(), (p + 1) * kAtOnce));
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

}  // namespace

void add_pairs(std::span<const std::span<const std::uint64_t>> words, std::size_t n, std::size_t stations,
               std::span<std::uint64_t> seen, std::span<std::uint64_t> shared) {
  if (stations > mask_bits)
    add_many_pairs(words, n, stations, seen.data(), shared.data());
  else if (!words.front().empty())
    add_few_pairs(words.front().data(), n, stations, seen.data(), shared.data());
}

NetworkCounts reduce_field(std::span<const std::uint32_t> counts, std::span<const std::uint64_t> masks,
                           std::uint32_t stations, double goal_density, const VoxelDemands& demands) {
  return reduce(counts, DenseMasks{masks, counts.size()}, stations, goal_density, demands);
}

NetworkCounts reduce_field(const VoxelField& field, std::uint32_t stations, double goal_density,
                           const VoxelDemands& demands) {
  return reduce(field.count, KeptMasks{field.stations}, stations, goal_density, demands);
}

}  // namespace vantage
