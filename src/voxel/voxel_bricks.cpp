// SPDX-License-Identifier: Apache-2.0
#include "voxel/voxel_bricks.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <string>

#include "core/parallel.hpp"
#include "vantage/error.hpp"
#include "voxel/triangle_walk.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {
namespace {

constexpr std::size_t kLeastCompacted = std::size_t{1} << 22;  // keys that a thread collects before it removes
                                                               // duplicates

void sort_unique(std::vector<std::uint64_t>& keys) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

// Rejects a grid with far more voxels than indices can number before it allocates memory. The area is a loose bound, so
// the margin is wide.
void check_area(const TriangleWalk& triangles) {
  if (!(triangles.area() < 0x1p36))
    throw Error(Errc::invalid_argument,
                "the surveyed meshes would fill some " + std::to_string(triangles.area()) +
                    " voxels, more than the 4294967294 that can be numbered; use a larger user size");
}

// Returns the sorted keys of the bricks that a triangle touches; empty if stopped. A brick's closed box is the union of
// its voxels' closed boxes, so these are exactly the bricks that hold a marked voxel.
std::optional<std::vector<std::uint64_t>> touched_bricks(const TriangleWalk& triangles, const GridTransform& grid,
                                                         std::int64_t bricks_per_side, const Progress& progress) {
  struct Keys {
    std::vector<std::uint64_t> keys;
    std::size_t compact_at = kLeastCompacted;
  };
  tbb::enumerable_thread_specific<Keys> collected;
  const bool whole = triangles.for_each(grid, bricks_per_side, progress, [&](std::size_t) {
    Keys& own = collected.local();
    if (own.keys.size() > own.compact_at) {
      sort_unique(own.keys);
      own.compact_at = std::max(kLeastCompacted, 2 * own.keys.size());
    }
    return [&keys = own.keys](const TriangleCells::Cell& cell) {
      const std::uint64_t key = morton_encode(static_cast<std::uint32_t>(cell[0]), static_cast<std::uint32_t>(cell[1]),
                                              static_cast<std::uint32_t>(cell[2]));
      if (keys.empty() || keys.back() != key) keys.push_back(key);
    };
  });
  if (!whole) return std::nullopt;
  std::vector<std::vector<std::uint64_t>*> each;
  for (Keys& own : collected) each.push_back(&own.keys);
  parallel::for_all(std::size_t{0}, each.size(), [&](std::size_t k) { sort_unique(*each[k]); });
  std::vector<std::uint64_t> all;
  for (std::vector<std::uint64_t>* const own : each) {
    all.insert(all.end(), own->begin(), own->end());
    *own = {};
  }
  parallel::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace

void number_bricks(VoxelBricks& marked) {
  marked.voxels = 0;
  for (VoxelBrick& brick : marked.bricks) {
    brick.first = static_cast<std::uint32_t>(marked.voxels);
    for (const std::uint32_t word : brick.mask) marked.voxels += static_cast<std::uint64_t>(std::popcount(word));
    if (marked.voxels >= kNoVoxel)
      throw Error(
          Errc::invalid_argument,
          "the surveyed meshes fill more than the 4294967294 voxels that can be numbered; use a larger user size");
  }
}

std::vector<BrickSlot> hash_bricks(std::span<const VoxelBrick> bricks) {
  const std::size_t count = std::bit_ceil(std::max<std::size_t>(2 * bricks.size(), 2));
  std::vector<BrickSlot> slots(count, BrickSlot{0, 0, 0, empty_slot});
  for (std::size_t b = 0; b < bricks.size(); ++b) {
    const VoxelBrick& brick = bricks[b];
    std::size_t slot = brick_hash(brick.x, brick.y, brick.z) & (count - 1);
    while (slots[slot].brick != empty_slot) slot = (slot + 1) & (count - 1);
    slots[slot] = {brick.x, brick.y, brick.z, static_cast<std::uint32_t>(b)};
  }
  return slots;
}

std::array<std::array<double, 3>, 3> GridTransform::corners(const std::array<Float3, 3>& triangle) const {
  std::array<std::array<double, 3>, 3> result;
  for (int c = 0; c < 3; ++c) {
    const Float3& p = triangle[c];
    result[c] = {(p.x - min[0]) * inverse_size, (p.y - min[1]) * inverse_size, (p.z - min[2]) * inverse_size};
  }
  return result;
}

std::uint32_t brick_bit(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  static constexpr std::array<std::uint32_t, 8> kSpread{0, 1, 8, 9, 64, 65, 72, 73};
  return kSpread[x & 7] | kSpread[y & 7] << 1 | kSpread[z & 7] << 2;
}

std::uint32_t find_brick(std::span<const BrickSlot> slots, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  if (slots.empty()) return kNoBrick;
  const std::size_t mask = slots.size() - 1;
  for (std::size_t slot = brick_hash(x, y, z) & mask;; slot = (slot + 1) & mask) {
    const BrickSlot& s = slots[slot];
    if (s.brick == empty_slot || (s.x == x && s.y == y && s.z == z)) return s.brick;
  }
}

std::optional<VoxelBricks> mark_bricks(const SceneData& scene, std::span<const MeshRange> triangles,
                                       const GridTransform& grid, int depth, const Progress& progress) {
  const TriangleWalk walk(scene, triangles, grid);
  check_area(walk);
  VoxelBricks result;
  const int shift = static_cast<int>(brick_bits);
  const std::int64_t bricks_per_side = depth > shift ? std::int64_t{1} << (depth - shift) : 1;
  {
    const auto keys = touched_bricks(walk, grid.coarser(shift), bricks_per_side, {.stop = progress.stop});
    if (!keys) return std::nullopt;
    if (keys->size() >= empty_slot / 2)
      throw Error(Errc::invalid_argument, "the surveyed meshes fill " + std::to_string(keys->size()) +
                                              " bricks of voxels, more than can be numbered; use a larger user size");
    result.bricks.resize(keys->size());
    for (std::size_t b = 0; b < keys->size(); ++b) {
      const auto [x, y, z] = morton_decode((*keys)[b]);
      result.bricks[b].x = x;
      result.bricks[b].y = y;
      result.bricks[b].z = z;
    }
  }
  result.slots = hash_bricks(result.bricks);
  if (!walk.for_each(grid, std::int64_t{1} << depth, progress, [&](std::size_t) { return MarkVoxels(result); }))
    return std::nullopt;

  // A brick may be empty if rounding drops all its voxels; it stays, since indices skip it.
  number_bricks(result);
  return result;
}

std::vector<MeshRange> surveyed_ranges(const SceneData& scene) {
  std::vector<MeshRange> result;
  for (std::size_t m = 0; m < scene.ranges.size(); ++m)
    if (scene.meshes[m].role == Role::surveyed && scene.ranges[m].triangle_count > 0) result.push_back(scene.ranges[m]);
  return result;
}

}  // namespace vantage
