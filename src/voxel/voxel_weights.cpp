// SPDX-License-Identifier: Apache-2.0
#include "voxel/voxel_weights.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>

#include "voxel/triangle_cells.hpp"
#include "voxel/voxel_bricks.hpp"

namespace vantage {
namespace {

void raise_to(std::uint8_t& weight, std::uint8_t least) {
  std::atomic_ref<std::uint8_t> shared(weight);
  std::uint8_t now = shared.load(std::memory_order_relaxed);
  while (now < least && !shared.compare_exchange_weak(now, least, std::memory_order_relaxed)) {
  }
}

}  // namespace

std::vector<std::uint8_t> voxel_weights(const SceneData& scene, const VoxelGrid& grid) {
  std::uint32_t lowest = 255, highest = 1;
  for (const MeshInfo& mesh : scene.meshes) {
    if (mesh.role != Role::surveyed) continue;
    lowest = std::min(lowest, mesh.weight);
    highest = std::max(highest, mesh.weight);
  }
  if (lowest >= highest) return {};
  // Every surveyed voxel is touched by some surveyed mesh, so it weighs `lowest` at least.
  std::vector<std::uint8_t> weights(grid.size(), static_cast<std::uint8_t>(lowest));
  const GridTransform transform{{grid.min()[0], grid.min()[1], grid.min()[2]}, grid.inverse_size()};
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    const MeshInfo& mesh = scene.meshes[m];
    if (mesh.role != Role::surveyed || mesh.weight == lowest) continue;
    const std::uint32_t first = scene.ranges[m].first_triangle;
    tbb::parallel_for(
        tbb::blocked_range<std::uint32_t>(first, first + scene.ranges[m].triangle_count),
        [&](const tbb::blocked_range<std::uint32_t>& range) {
          for (std::uint32_t t = range.begin(); t != range.end(); ++t)
            TriangleCells(transform.corners(scene.positions, scene.triangles[t]), std::int64_t{1} << grid.depth())
                .for_each([&](const TriangleCells::Cell& c) {
                  const std::uint32_t rank =
                      grid.find(morton_encode(static_cast<std::uint32_t>(c[0]), static_cast<std::uint32_t>(c[1]),
                                              static_cast<std::uint32_t>(c[2])));
                  if (rank != no_voxel) raise_to(weights[rank], static_cast<std::uint8_t>(mesh.weight));
                });
        });
  }
  return weights;
}

}  // namespace vantage
