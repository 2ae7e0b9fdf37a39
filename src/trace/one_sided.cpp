// SPDX-License-Identifier: Apache-2.0
// Counts a voxel with stations on several sides of its planes as several voxels, one for each side's stations.
#include "trace/one_sided.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "core/parallel.hpp"
#include "trace/field_counts.hpp"

namespace vantage {
namespace {

constexpr std::size_t kAtOnce = StationMasks::block_voxels;

struct Pairs {
  std::vector<std::uint64_t> seen, shared;
  explicit Pairs(std::size_t stations) : seen(stations), shared(stations * (stations - 1) / 2) {}
  void add(const Pairs& other) {
    for (std::size_t k = 0; k < seen.size(); ++k) seen[k] += other.seen[k];
    for (std::size_t k = 0; k < shared.size(); ++k) shared[k] += other.shared[k];
  }
};

class SideCounter {
 public:
  SideCounter(const VoxelPlanes& planes, std::span<const TraceStation> stations, std::size_t station_count)
      : planes_(planes), heads_(station_count) {
    for (const TraceStation& station : stations) heads_[station.place] = station.origin;
  }

  // Counts pairs in `many` voxels. `index_of(k)`: index of voxel number k. `words(w, first, end)`: word w of their
  // masks, or nothing.
  template <class IndexOf, class Words>
  Pairs count(std::size_t many, const IndexOf& index_of, const Words& words) const {
    return parallel::reduce(
        tbb::blocked_range<std::size_t>(0, (many + kAtOnce - 1) / kAtOnce, 1), Pairs(heads_.size()),
        [&](const tbb::blocked_range<std::size_t>& range, Pairs pairs) {
          Masks masks(mask_words(heads_.size()));
          for (std::size_t part = range.begin(); part != range.end(); ++part) {
            const std::size_t first = part * kAtOnce, end = std::min(many, first + kAtOnce);
            std::array<std::span<const std::uint64_t>, mask_words(max_stations)> of_part;
            for (std::size_t w = 0; w < masks.size(); ++w) {
              of_part[w] = words(w, first, end);
              masks[w].assign(of_part[w].begin(), of_part[w].end());
              masks[w].resize(end - first);
            }
            for (std::size_t k = first; k < end; ++k) split(index_of(k), k - first, masks);
            std::array<std::span<const std::uint64_t>, mask_words(max_stations)> split_words;
            std::ranges::copy(masks, split_words.begin());
            add_pairs(std::span(split_words).first(masks.size()), masks.front().size(), heads_.size(), pairs.seen,
                      pairs.shared);
          }
          return pairs;
        },
        [](Pairs a, const Pairs& b) {
          a.add(b);
          return a;
        });
  }

 private:
  using Masks = std::vector<std::vector<std::uint64_t>>;  // word by word

  // Leaves one side's stations in row `k` of the masks, and appends a row for each other side.
  void split(std::uint64_t voxel_index, std::size_t k, Masks& masks) const {
    const std::uint32_t sides = planes_.sides(voxel_index);
    if (sides == 1) return;
    int seers = 0;
    for (const std::vector<std::uint64_t>& word : masks) seers += std::popcount(word[k]);
    if (seers < 2) return;
    std::array<std::size_t, std::size_t{1} << VoxelPlanes::kMost> row_of;
    row_of.fill(kNone);
    for (std::size_t w = 0; w < masks.size(); ++w)
      for (std::uint64_t rest = masks[w][k]; rest != 0; rest &= rest - 1) {
        const std::uint64_t bit = rest & (~rest + 1);
        const std::size_t place = w * mask_bits + static_cast<std::size_t>(std::countr_zero(rest));
        std::size_t& row = row_of[planes_.side(voxel_index, heads_[place])];
        if (row == kNone) {
          const bool first = std::ranges::all_of(row_of, [](std::size_t r) { return r == kNone; });
          row = first ? k : masks.front().size();
          if (!first)
            for (std::vector<std::uint64_t>& word : masks) word.push_back(0);
        }
        if (row == k) continue;
        masks[w][k] &= ~bit;
        masks[w][row] |= bit;
      }
  }

  static constexpr std::size_t kNone = ~std::size_t{0};
  const VoxelPlanes& planes_;
  std::vector<Float3> heads_;  // by place
};

}  // namespace

void share_one_sided(NetworkCounts& counts, std::span<const TraceStation> stations, const VoxelPlanes& planes,
                     const StationMasks& masks) {
  const SideCounter counter(planes, stations, counts.stations);
  counts.shared = counter
                      .count(
                          masks.voxels(), [](std::size_t k) { return k; },
                          [&](std::size_t w, std::size_t first, std::size_t end) {
                            const auto own = masks.block(w, first / kAtOnce);
                            return own.empty() ? own : own.first(end - first);
                          })
                      .shared;
}

void share_one_sided(NetworkCounts& counts, std::span<const TraceStation> stations, const VoxelPlanes& planes,
                     std::span<const std::uint32_t> voxel_indices, std::span<const std::uint64_t> masks) {
  const SideCounter counter(planes, stations, counts.stations);
  const std::size_t n = voxel_indices.size(), groups = std::max<std::size_t>(counts.groups.size(), 1);
  Pairs all(counts.stations);
  std::vector<std::uint64_t> own;
  for (std::size_t g = 0; g < groups; ++g) {
    const std::size_t many = n > g ? (n - g + groups - 1) / groups : 0;
    own.resize(many * mask_words(counts.stations));
    for (std::size_t w = 0; w < mask_words(counts.stations); ++w)
      for (std::size_t k = 0; k < many; ++k) own[w * many + k] = masks[w * n + g + k * groups];
    Pairs pairs = counter.count(
        many, [&](std::size_t k) { return voxel_indices[g + k * groups]; },
        [&](std::size_t w, std::size_t first, std::size_t end) {
          return std::span<const std::uint64_t>(own).subspan(w * many + first, end - first);
        });
    all.add(pairs);
    if (!counts.groups.empty()) counts.groups[g].shared = std::move(pairs.shared);
  }
  counts.shared = std::move(all.shared);
}

}  // namespace vantage
