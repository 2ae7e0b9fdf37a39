// SPDX-License-Identifier: Apache-2.0
#include "voxel/voxel_weights.hpp"

#include <algorithm>
#include <atomic>

#include "voxel/triangle_walk.hpp"

namespace vantage {
namespace {

void raise_to(std::uint8_t& weight, std::uint8_t least) {
  std::atomic_ref<std::uint8_t> shared(weight);
  std::uint8_t now = shared.load(std::memory_order_relaxed);
  while (now < least && !shared.compare_exchange_weak(now, least, std::memory_order_relaxed)) {
  }
}

}  // namespace

std::optional<std::vector<std::uint8_t>> voxel_weights(const SceneData& scene, const VoxelGrid& grid,
                                                       const Progress& progress) {
  std::uint32_t lowest = 255, highest = 1;
  for (const MeshInfo& mesh : scene.meshes) {
    if (mesh.role != Role::surveyed) continue;
    lowest = std::min(lowest, mesh.weight);
    highest = std::max(highest, mesh.weight);
  }
  if (lowest >= highest) return std::vector<std::uint8_t>{};
  // Every surveyed voxel is touched by some surveyed mesh, so it weighs `lowest` at least.
  std::vector<std::uint8_t> weights(grid.size(), static_cast<std::uint8_t>(lowest));
  std::vector<std::span<const Triangle>> heavier;
  std::vector<std::uint8_t> own;
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    if (scene.meshes[m].role != Role::surveyed || scene.meshes[m].weight == lowest) continue;
    heavier.push_back(
        std::span(scene.triangles).subspan(scene.ranges[m].first_triangle, scene.ranges[m].triangle_count));
    own.push_back(static_cast<std::uint8_t>(scene.meshes[m].weight));
  }
  const GridTransform transform{{grid.min()[0], grid.min()[1], grid.min()[2]}, grid.inverse_size()};
  const bool whole = TriangleWalk(scene.positions, heavier, transform)
                         .for_each(transform, std::int64_t{1} << grid.depth(), progress, [&](std::size_t mesh) {
                           return [&, weight = own[mesh]](const TriangleCells::Cell& c) {
                             const std::uint32_t rank = grid.find(morton_encode(static_cast<std::uint32_t>(c[0]),
                                                                                static_cast<std::uint32_t>(c[1]),
                                                                                static_cast<std::uint32_t>(c[2])));
                             if (rank != no_voxel) raise_to(weights[rank], weight);
                           };
                         });
  if (!whole) return std::nullopt;
  return weights;
}

}  // namespace vantage
