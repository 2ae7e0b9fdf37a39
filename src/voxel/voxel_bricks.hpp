// SPDX-License-Identifier: Apache-2.0
// Marked voxels as bricks of 8³ with a bit mask each, and a hash table over the bricks (shaders/shared/voxel_types.h).
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"
#include "shared/voxel_types.h"
#include "vantage/progress.hpp"
#include "voxel/triangle_cells.hpp"

namespace vantage {

inline constexpr std::uint32_t kNoBrick = empty_slot;

// Local frame to grid units: (p − min) · inverse_size, in double. Voxel faces lie at whole numbers.
struct GridTransform {
  std::array<double, 3> min{};
  double inverse_size = 1;
  std::array<std::array<double, 3>, 3> corners(const std::array<Float3, 3>& triangle) const;
  // Returns the same grid in cells of 2^shift voxels; exact.
  GridTransform coarser(int shift) const { return {min, inverse_size / static_cast<double>(1 << shift)}; }
};

// Returns the bit of a voxel within its brick, from voxel coordinates.
std::uint32_t brick_bit(std::uint32_t x, std::uint32_t y, std::uint32_t z);

// Bricks in Morton order that hold every voxel, of 2^depth per side, touched by one of the triangles; `first` is the
// running count. Throws Error invalid_argument for more than 2^32 − 2 voxels.
struct VoxelBricks {
  std::vector<VoxelBrick> bricks;
  std::vector<BrickSlot> slots;
  std::uint64_t voxels = 0;
};
// Marks the bricks of some ranges of the scene's triangles. Empty if stopped.
std::optional<VoxelBricks> mark_bricks(const SceneData& scene, std::span<const MeshRange> triangles,
                                       const GridTransform& grid, int depth, const Progress& progress = {});

// Returns a hash table over bricks.
std::vector<BrickSlot> hash_bricks(std::span<const VoxelBrick> bricks);
// Counts the voxels, and fills `first` of the bricks. Throws as mark_bricks().
void number_bricks(VoxelBricks& marked);

// Returns the index of the brick with these brick coordinates, or kNoBrick.
std::uint32_t find_brick(std::span<const BrickSlot> slots, std::uint32_t x, std::uint32_t y, std::uint32_t z);

// Sets the bits of the voxels that a triangle touches, in existing bricks. Several may work at once.
class MarkVoxels {
 public:
  explicit MarkVoxels(VoxelBricks& bricks) : bricks_(bricks) {}
  void operator()(const TriangleCells::Cell& cell) {
    constexpr int kShift = static_cast<int>(brick_bits);
    const std::array<std::uint32_t, 3> c{static_cast<std::uint32_t>(cell[0]), static_cast<std::uint32_t>(cell[1]),
                                         static_cast<std::uint32_t>(cell[2])};
    const std::array<std::uint32_t, 3> b{c[0] >> kShift, c[1] >> kShift, c[2] >> kShift};
    if (b != at_) {
      const std::uint32_t index = find_brick(bricks_.slots, b[0], b[1], b[2]);
      // Rounding may mark a voxel 2^-50 beyond the triangle as touched, but not its brick.
      brick_ = index == kNoBrick ? nullptr : &bricks_.bricks[index];
      at_ = b;
    }
    if (!brick_) return;
    const std::uint32_t bit = brick_bit(c[0], c[1], c[2]);
    const std::atomic_ref<std::uint32_t> word(brick_->mask[bit / 32]);
    const std::uint32_t flag = std::uint32_t{1} << (bit % 32);
    if (!(word.load(std::memory_order_relaxed) & flag)) word.fetch_or(flag, std::memory_order_relaxed);
  }

 private:
  VoxelBricks& bricks_;
  std::array<std::uint32_t, 3> at_{0xFFFFFFFFu, 0, 0};
  VoxelBrick* brick_ = nullptr;
};

// Returns the ranges of surveyed meshes.
std::vector<MeshRange> surveyed_ranges(const SceneData& scene);

}  // namespace vantage
