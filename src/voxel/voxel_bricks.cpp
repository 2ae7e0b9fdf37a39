// SPDX-License-Identifier: Apache-2.0
#include "voxel/voxel_bricks.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <string>

#include "core/glm.hpp"
#include "vantage/error.hpp"
#include "voxel/triangle_cells.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {
namespace {

constexpr std::size_t compact_at = std::size_t{1} << 22;  // keys a thread collects before it drops its duplicates

void sort_unique(std::vector<std::uint64_t>& keys) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

// Refuses a grid far beyond what ranks can number before any memory is spent on it. A triangle's area in voxels bounds
// its cells from below but for slivers; triangles lying on each other are counted more than once, hence the wide
// margin.
void check_area(std::span<const Float3> positions, std::span<const std::span<const Triangle>> triangles,
                const GridTransform& grid) {
  double area = 0;
  for (const auto& mesh : triangles)
    for (const Triangle& triangle : mesh) {
      const auto c = grid.corners(positions, triangle);
      const glm::dvec3 a = glm::make_vec3(c[0].data());
      area += 0.5 * length(cross(glm::make_vec3(c[1].data()) - a, glm::make_vec3(c[2].data()) - a));
    }
  if (!(area < 0x1p36))
    throw Error(Errc::invalid_argument,
                "the surveyed meshes would fill some " + std::to_string(area) +
                    " voxels, more than the 4294967294 that can be numbered; use a larger user size");
}

// Sorted keys of the bricks that a triangle touches. A brick's closed box is the union of its voxels' closed boxes, so
// these are exactly the bricks that hold a marked voxel.
std::vector<std::uint64_t> touched_bricks(std::span<const Float3> positions,
                                          std::span<const std::span<const Triangle>> triangles,
                                          const GridTransform& grid, std::int64_t bricks_per_side) {
  tbb::enumerable_thread_specific<std::vector<std::uint64_t>> collected;
  for (const auto& mesh : triangles)
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, mesh.size()), [&](const tbb::blocked_range<std::size_t>& range) {
          std::vector<std::uint64_t>& keys = collected.local();
          for (std::size_t t = range.begin(); t != range.end(); ++t)
            TriangleCells(grid.corners(positions, mesh[t]), bricks_per_side)
                .for_each([&](const TriangleCells::Cell& cell) {
                  const std::uint64_t key =
                      morton_encode(static_cast<std::uint32_t>(cell[0]), static_cast<std::uint32_t>(cell[1]),
                                    static_cast<std::uint32_t>(cell[2]));
                  if (keys.empty() || keys.back() != key) keys.push_back(key);
                });
          if (keys.size() > compact_at) sort_unique(keys);
        });
  std::vector<std::uint64_t> all;
  for (auto& keys : collected) {
    sort_unique(keys);
    all.insert(all.end(), keys.begin(), keys.end());
    keys = {};
  }
  tbb::parallel_sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
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

}  // namespace

std::array<std::array<double, 3>, 3> GridTransform::corners(std::span<const Float3> positions,
                                                            const Triangle& triangle) const {
  std::array<std::array<double, 3>, 3> result;
  for (int c = 0; c < 3; ++c) {
    const Float3& p = positions[triangle[c]];
    result[c] = {(p.x - min[0]) * inverse_size, (p.y - min[1]) * inverse_size, (p.z - min[2]) * inverse_size};
  }
  return result;
}

std::uint32_t brick_bit(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  static constexpr std::array<std::uint32_t, 8> spread{0, 1, 8, 9, 64, 65, 72, 73};
  return spread[x & 7] | spread[y & 7] << 1 | spread[z & 7] << 2;
}

std::uint32_t find_brick(std::span<const BrickSlot> slots, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  if (slots.empty()) return no_brick;
  const std::size_t mask = slots.size() - 1;
  for (std::size_t slot = brick_hash(x, y, z) & mask;; slot = (slot + 1) & mask) {
    const BrickSlot& s = slots[slot];
    if (s.brick == empty_slot || (s.x == x && s.y == y && s.z == z)) return s.brick;
  }
}

VoxelBricks mark_bricks(std::span<const Float3> positions, std::span<const std::span<const Triangle>> triangles,
                        const GridTransform& grid, int depth) {
  check_area(positions, triangles, grid);
  VoxelBricks result;
  const int shift = static_cast<int>(brick_bits);
  const std::int64_t bricks_per_side = depth > shift ? std::int64_t{1} << (depth - shift) : 1;
  {
    const auto keys = touched_bricks(positions, triangles, grid.coarser(shift), bricks_per_side);
    if (keys.size() >= empty_slot / 2)
      throw Error(Errc::invalid_argument, "the surveyed meshes fill " + std::to_string(keys.size()) +
                                              " bricks of voxels, more than can be numbered; use a larger user size");
    result.bricks.resize(keys.size());
    for (std::size_t b = 0; b < keys.size(); ++b) {
      const auto [x, y, z] = morton_decode(keys[b]);
      result.bricks[b].x = x;
      result.bricks[b].y = y;
      result.bricks[b].z = z;
    }
  }
  result.slots = hash_bricks(result.bricks);

  const std::int64_t voxels_per_side = std::int64_t{1} << depth;
  for (const auto& mesh : triangles)
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.size()), [&](const tbb::blocked_range<std::size_t>&
                                                                               range) {
      std::array<std::uint32_t, 3> at{no_voxel, 0, 0};
      VoxelBrick* brick = nullptr;
      for (std::size_t t = range.begin(); t != range.end(); ++t)
        TriangleCells(grid.corners(positions, mesh[t]), voxels_per_side).for_each([&](const TriangleCells::Cell& cell) {
          const std::array<std::uint32_t, 3> c{static_cast<std::uint32_t>(cell[0]), static_cast<std::uint32_t>(cell[1]),
                                               static_cast<std::uint32_t>(cell[2])};
          const std::array<std::uint32_t, 3> b{c[0] >> shift, c[1] >> shift, c[2] >> shift};
          if (b != at) {
            const std::uint32_t index = find_brick(result.slots, b[0], b[1], b[2]);
            // Rounding may take a voxel for touched where it does not take its brick for it; it lies 2^-50 beyond the
            // triangle.
            brick = index == no_brick ? nullptr : &result.bricks[index];
            at = b;
          }
          if (!brick) return;
          const std::uint32_t bit = brick_bit(c[0], c[1], c[2]);
          const std::atomic_ref<std::uint32_t> word(brick->mask[bit / 32]);
          const std::uint32_t flag = std::uint32_t{1} << (bit % 32);
          if (!(word.load(std::memory_order_relaxed) & flag)) word.fetch_or(flag, std::memory_order_relaxed);
        });
    });

  // A brick whose every voxel fell to the same rounding would be empty; it may stay, ranks pass over it.
  for (VoxelBrick& brick : result.bricks) {
    brick.first = static_cast<std::uint32_t>(result.voxels);
    for (const std::uint32_t word : brick.mask) result.voxels += static_cast<std::uint64_t>(std::popcount(word));
    if (result.voxels >= no_voxel)
      throw Error(
          Errc::invalid_argument,
          "the surveyed meshes fill more than the 4294967294 voxels that can be numbered; use a larger user size");
  }
  return result;
}

std::vector<std::span<const Triangle>> surveyed_triangles(const SceneData& scene) {
  std::vector<std::span<const Triangle>> result;
  for (std::size_t m = 0; m < scene.ranges.size(); ++m)
    if (scene.meshes[m].role == Role::surveyed && scene.ranges[m].triangle_count > 0)
      result.push_back(std::span<const Triangle>(scene.triangles)
                           .subspan(scene.ranges[m].first_triangle, scene.ranges[m].triangle_count));
  return result;
}

}  // namespace vantage
