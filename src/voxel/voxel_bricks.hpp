// SPDX-License-Identifier: Apache-2.0
// Marked voxels as bricks of 8³ with a bit mask each, and a hash table over the bricks (shaders/shared/voxel_types.h).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"
#include "shared/voxel_types.h"
#include "vantage/progress.hpp"

namespace vantage {

inline constexpr std::uint32_t no_brick = empty_slot;

// Local frame to grid units: (p − min) · inverse_size, in double. Voxel faces lie at whole numbers.
struct GridTransform {
  std::array<double, 3> min{};
  double inverse_size = 1;
  std::array<std::array<double, 3>, 3> corners(const std::array<Float3, 3>& triangle) const;
  // The same grid in cells of 2^shift voxels; exact.
  GridTransform coarser(int shift) const { return {min, inverse_size / static_cast<double>(1 << shift)}; }
};

// Bit of a voxel within its brick, from voxel coordinates.
std::uint32_t brick_bit(std::uint32_t x, std::uint32_t y, std::uint32_t z);

// Bricks in Morton order that hold every voxel, of 2^depth per side, touched by one of the triangles; `first` is the
// running count. Throws Error invalid_argument for more than 2^32 − 2 voxels.
struct VoxelBricks {
  std::vector<VoxelBrick> bricks;
  std::vector<BrickSlot> slots;
  std::uint64_t voxels = 0;
};
// Of some ranges of the scene's triangles. Empty if stopped.
std::optional<VoxelBricks> mark_bricks(const SceneData& scene, std::span<const MeshRange> triangles,
                                       const GridTransform& grid, int depth, const Progress& progress = {});

// Index of the brick with these brick coordinates, or no_brick.
std::uint32_t find_brick(std::span<const BrickSlot> slots, std::uint32_t x, std::uint32_t y, std::uint32_t z);

// Surveyed meshes.
std::vector<MeshRange> surveyed_ranges(const SceneData& scene);

}  // namespace vantage
