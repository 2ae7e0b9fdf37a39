// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "core/parallel.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {

// Number of set voxels in each brick before each 64 bits of its mask, so that a voxel index takes one population count.
// 16 bytes a brick. Immutable.
class BrickPrefixes {
 public:
  static constexpr std::uint32_t kWords = 8;

  explicit BrickPrefixes(const VoxelGrid& grid) : before_(grid.bricks().size()) {
    parallel::for_all(std::size_t{0}, before_.size(), [&](std::size_t k) {
      int sum = 0;
      for (std::uint32_t w = 0; w < kWords; ++w) {
        before_[k][w] = static_cast<std::uint16_t>(sum);
        sum += std::popcount(word(grid.bricks()[k], w));
      }
    });
  }
  static std::uint64_t word(const VoxelBrick& brick, std::uint32_t w) {
    return brick.mask[2 * w] | std::uint64_t{brick.mask[2 * w + 1]} << 32;
  }
  void prefetch(std::uint32_t brick) const { __builtin_prefetch(&before_[brick]); }
  std::uint32_t before(std::uint32_t brick, std::uint32_t w) const { return before_[brick][w]; }

 private:
  std::vector<std::array<std::uint16_t, kWords>> before_;
};

// VoxelGrid::index_of for the points of a bundle, step by step over all of them. Arithmetic uses vector registers, and
// many loads are in flight at once: at practical resolutions neither hash table nor bricks fit into a cache.
class VoxelLookup {
 public:
  static constexpr std::uint32_t kCapacity = 256;

  VoxelLookup(const VoxelGrid& grid, const BrickPrefixes& prefixes)
      : prefixes_(prefixes),
        bricks_(grid.bricks().data()),
        slots_(grid.slots().data()),
        slot_mask_(static_cast<std::uint32_t>(grid.slots().size()) - 1),
        min_(grid.min()),
        inverse_size_(grid.inverse_size()),
        cells_(grid.slots().empty() ? 0.0f : static_cast<float>(1u << grid.depth())) {}

  void clear() { size_ = 0; }
  // REQUIRES: at most `kCapacity` calls since clear().
  void add(const Float3& p) {
    x_[size_] = p.x;
    y_[size_] = p.y;
    z_[size_] = p.z;
    ++size_;
  }

  // Works as n calls of add() after clear(), with point(0), point(1), …, in a vectorised loop.
  template <class Point>
  [[gnu::always_inline]] void set(std::uint32_t n, const Point& point) {
    size_ = n;
    for (std::uint32_t k = 0; k < n; ++k) {
      const Float3 p = point(k);
      x_[k] = p.x;
      y_[k] = p.y;
      z_[k] = p.z;
    }
  }

  // Calls f(index, begin, end) with the surveyed voxel of each run of points that lie in one, in order. Points are
  // numbered as they were added. Inlined, to be compiled for the caller's target.
  template <class F>
  [[gnu::always_inline]] void each_run(const F& f) {
    if (size_ == 0) return;
    find_cells();
    const std::uint32_t cells = find_changes();
    const std::uint32_t runs = find_runs(cells);
    for (std::uint32_t r = 0; r < runs; ++r) find_brick(runs_[r]);
    std::uint32_t c = 0;
    for (std::uint32_t r = 0; r < runs; ++r) {
      const std::uint32_t index = runs_[r].slot, end = runs_[r].end;
      if (index == empty_slot) {
        c = end;
        continue;
      }
      const VoxelBrick& brick = bricks_[index];
      for (; c < end; ++c) {
        const std::uint32_t code = code_[begin_[c]], w = code / 64;
        const std::uint64_t word = BrickPrefixes::word(brick, w), flag = std::uint64_t{1} << (code % 64);
        if ((word & flag) == 0) continue;
        f(brick.first + prefixes_.before(index, w) + static_cast<std::uint32_t>(std::popcount(word & (flag - 1))),
          begin_[c], begin_[c + 1]);
      }
    }
  }

 private:
  struct Run {            // cells of one brick
    std::uint32_t point;  // in any of them
    std::uint32_t slot;   // slot to look up; then the brick's index
    std::uint32_t end;
  };

  // Computes cells as VoxelGrid::cell_of.
  [[gnu::always_inline]] void find_cells() {
    const float min_x = min_[0], min_y = min_[1], min_z = min_[2], inverse = inverse_size_, cells = cells_;
    const std::uint32_t mask = slot_mask_;
    for (std::uint32_t p = 0; p < size_; ++p) {
      const float x = (x_[p] - min_x) * inverse, y = (y_[p] - min_y) * inverse, z = (z_[p] - min_z) * inverse;
      const bool inside = (x >= 0) & (x < cells) & (y >= 0) & (y < cells) & (z >= 0) & (z < cells);
      // Converts via int, which every processor supports.
      const std::uint32_t i = static_cast<std::uint32_t>(static_cast<int>(inside ? x : 0.0f));
      const std::uint32_t j = static_cast<std::uint32_t>(static_cast<int>(inside ? y : 0.0f));
      const std::uint32_t k = static_cast<std::uint32_t>(static_cast<int>(inside ? z : 0.0f));
      a_[p] = inside ? i >> brick_bits : empty_slot;
      b_[p] = j >> brick_bits;
      c_[p] = k >> brick_bits;
      slot_[p] = brick_hash(i >> brick_bits, j >> brick_bits, k >> brick_bits) & mask;
      code_[p] = spread(i) | spread(j) << 1 | spread(k) << 2;
    }
  }
  static std::uint32_t spread(std::uint32_t i) { return (i & 1) | (i & 2) << 2 | (i & 4) << 4; }

  // Finds where the cell changes from one point to the next. Avoids a branch, which would be unpredictable.
  [[gnu::always_inline]] std::uint32_t find_changes() {
    for (std::uint32_t p = 1; p < size_; ++p) {
      brick_changes_[p] = (a_[p] ^ a_[p - 1]) | (b_[p] ^ b_[p - 1]) | (c_[p] ^ c_[p - 1]);
      changes_[p] = brick_changes_[p] | (code_[p] ^ code_[p - 1]);
    }
    begin_[0] = 0;
    std::uint32_t cells = 1;
    for (std::uint32_t p = 1; p < size_; ++p) {
      begin_[cells] = p;
      cells += changes_[p] != 0;
    }
    begin_[cells] = size_;
    return cells;
  }

  [[gnu::always_inline]] std::uint32_t find_runs(std::uint32_t cells) {
    std::uint32_t runs = 0;
    for (std::uint32_t c = 0; c < cells; ++c) {
      const std::uint32_t p = begin_[c];
      if (p == 0 || brick_changes_[p] != 0) {
        runs_[runs++] = {p, slot_[p], 0};
        __builtin_prefetch(&slots_[slot_[p]]);
      }
      runs_[runs - 1].end = c + 1;
    }
    return runs;
  }

  [[gnu::always_inline]] void find_brick(Run& run) const {
    const std::uint32_t a = a_[run.point], b = b_[run.point], c = c_[run.point];
    if (a == empty_slot) {
      run.slot = empty_slot;
      return;
    }
    const BrickSlot* slot = &slots_[run.slot];
    while (slot->brick != empty_slot && (slot->x != a || slot->y != b || slot->z != c)) {
      run.slot = (run.slot + 1) & slot_mask_;
      slot = &slots_[run.slot];
    }
    run.slot = slot->brick;
    if (run.slot == empty_slot) return;
    __builtin_prefetch(&bricks_[run.slot]);  // a brick may span two cache lines
    __builtin_prefetch(&bricks_[run.slot].mask[brick_mask_words - 1]);
    prefixes_.prefetch(run.slot);
  }

  const BrickPrefixes& prefixes_;
  const VoxelBrick* bricks_;
  const BrickSlot* slots_;
  std::uint32_t slot_mask_;
  std::array<float, 3> min_;
  float inverse_size_, cells_;
  std::uint32_t size_ = 0;
  alignas(64) std::array<float, kCapacity> x_, y_, z_;
  alignas(64) std::array<std::uint32_t, kCapacity> a_, b_, c_;    // brick coordinates; a is empty_slot outside the cube
  alignas(64) std::array<std::uint32_t, kCapacity> slot_, code_;  // slot by the hash; Morton code in the brick
  alignas(64) std::array<std::uint32_t, kCapacity> changes_, brick_changes_;  // from the point before; 0: none
  std::array<std::uint32_t, kCapacity + 1> begin_;                            // first point of each run in one cell
  std::array<Run, kCapacity> runs_;
};

}  // namespace vantage
