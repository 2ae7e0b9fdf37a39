// SPDX-License-Identifier: Apache-2.0
#include "voxel/voxel_demands.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>

#include "voxel/triangle_walk.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {
namespace {

// Returns for each voxel index, among the demands of surveyed meshes that touch the voxel, the first in the order of
// `before`. `last` is the last in that order, demanded by some surveyed mesh. Empty if all demand it.
template <class T, class Before>
std::optional<std::vector<T>> foremost(const SceneData& scene, const VoxelGrid& grid, std::span<const T> of_mesh,
                                       T last, Before before, const Progress& progress) {
  std::vector<MeshRange> triangles;
  std::vector<T> own;
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    if (scene.meshes[m].role != Role::surveyed || of_mesh[m] == last) continue;
    triangles.push_back(scene.ranges[m]);
    own.push_back(of_mesh[m]);
  }
  if (own.empty()) return std::vector<T>{};
  std::vector<T> found(grid.size(), last);
  const auto bring_forward = [&](T& at, T asked) {
    std::atomic_ref<T> shared(at);
    T now = shared.load(std::memory_order_relaxed);
    while (before(asked, now) && !shared.compare_exchange_weak(now, asked, std::memory_order_relaxed)) {
    }
  };
  const GridTransform transform{{grid.min()[0], grid.min()[1], grid.min()[2]}, grid.inverse_size()};
  const bool whole = TriangleWalk(scene, triangles, transform)
                         .for_each(transform, std::int64_t{1} << grid.depth(), progress, [&](std::size_t mesh) {
                           return [&, asked = own[mesh]](const TriangleCells::Cell& c) {
                             const std::uint32_t voxel_index = grid.find(
                                 morton_encode(static_cast<std::uint32_t>(c[0]), static_cast<std::uint32_t>(c[1]),
                                               static_cast<std::uint32_t>(c[2])));
                             if (voxel_index != kNoVoxel) bring_forward(found[voxel_index], asked);
                           };
                         });
  if (!whole) return std::nullopt;
  return found;
}

// Returns the demand that comes last among surveyed meshes. REQUIRES: one is surveyed.
template <class T, class Before>
T last_of(const SceneData& scene, std::span<const T> of_mesh, Before before) {
  std::optional<T> last;
  for (std::size_t m = 0; m < scene.meshes.size(); ++m)
    if (scene.meshes[m].role == Role::surveyed && (!last || before(*last, of_mesh[m]))) last = of_mesh[m];
  return last.value_or(T{});
}

}  // namespace

std::uint32_t VoxelDemands::least_point_weight() const { return point_weights.empty() ? 1 : kDensestPointWeight; }

VoxelDemands VoxelDemands::of(std::span<const std::uint32_t> voxel_indices) const {
  VoxelDemands some;
  if (!weights.empty())
    for (const std::uint32_t voxel_index : voxel_indices) some.weights.push_back(weights[voxel_index]);
  if (!point_weights.empty())
    for (const std::uint32_t voxel_index : voxel_indices) some.point_weights.push_back(point_weights[voxel_index]);
  return some;
}

std::optional<std::vector<std::uint8_t>> voxel_weights(const SceneData& scene, const VoxelGrid& grid,
                                                       const Progress& progress) {
  std::vector<std::uint8_t> of_mesh;
  for (const MeshInfo& mesh : scene.meshes) of_mesh.push_back(static_cast<std::uint8_t>(mesh.weight));
  const std::span<const std::uint8_t> all = of_mesh;
  return foremost(scene, grid, all, last_of(scene, all, std::greater<>()), std::greater<>(), progress);
}

double finest_spacing(const SceneData& scene, std::span<const double> spacings_m) {
  double finest = std::numeric_limits<double>::infinity();
  for (std::size_t m = 0; m < scene.meshes.size(); ++m)
    if (scene.meshes[m].role == Role::surveyed) finest = std::min(finest, spacings_m[m]);
  return finest;
}

std::optional<std::vector<std::uint32_t>> point_weights(const SceneData& scene, const VoxelGrid& grid,
                                                        std::span<const double> spacings_m, const Progress& progress) {
  const double finest = finest_spacing(scene, spacings_m);
  std::vector<std::uint32_t> of_mesh;
  for (const double spacing : spacings_m) {
    const double wide = std::min(spacing, grid.voxel_size()) / finest;
    of_mesh.push_back(static_cast<std::uint32_t>(std::min(std::ceil(kDensestPointWeight * wide * wide), 4294967295.0)));
  }
  const std::span<const std::uint32_t> all = of_mesh;
  return foremost(scene, grid, all, last_of(scene, all, std::less<>()), std::less<>(), progress);
}

}  // namespace vantage
