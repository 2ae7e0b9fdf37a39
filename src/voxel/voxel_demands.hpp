// SPDX-License-Identifier: Apache-2.0
// Coverage's demands on each surveyed voxel.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"
#include "vantage/progress.hpp"

namespace vantage {

class VoxelGrid;

// Element k belongs to voxel index k, or to the k-th voxel of a sample; empty if all voxels are alike.
struct VoxelDemands {
  std::vector<std::uint8_t> weights;  // weight of the voxel in coverage; empty: 1 each
  // Point weight per voxel: `kDensestPointWeight` at the densest goal, more if fewer points suffice. A voxel is full
  // once its point weights sum to those of the densest goal. Integers, so that sums do not depend on the order; rounded
  // up, by less than 1 in `kDensestPointWeight`. Empty: all voxels have one goal and point weight 1.
  std::vector<std::uint32_t> point_weights;

  std::uint32_t weight(std::size_t k) const { return weights.empty() ? 1 : weights[k]; }
  std::uint32_t point_weight(std::size_t k) const { return point_weights.empty() ? 1 : point_weights[k]; }
  // Returns the point weight in a voxel of the densest goal.
  std::uint32_t least_point_weight() const;
  // Returns the demands of a sample. REQUIRES: voxel_indices below the number of voxels.
  VoxelDemands of(std::span<const std::uint32_t> voxel_indices) const;
};

inline constexpr std::uint32_t kDensestPointWeight = 4096;

// Returns for each voxel index the largest weight of the surveyed meshes that touch the voxel. Empty if all surveyed
// meshes have equal weights, since only ratios matter. No value if stopped. Parallel; the result does not depend on the
// number of threads.
std::optional<std::vector<std::uint8_t>> voxel_weights(const SceneData& scene, const VoxelGrid& grid,
                                                       const Progress& progress);

// Returns the finest wanted spacing of surveyed meshes, metres; one spacing per mesh. REQUIRES: one is surveyed.
double finest_spacing(const SceneData& scene, std::span<const double> spacings_m);

// Returns for each voxel index the point weight if surveyed meshes want different spacings; the finest spacing of the
// meshes that touch the voxel applies. Every voxel wants at least one point. Empty if all want the same; no value if
// stopped. Parallel; the result does not depend on the number of threads.
std::optional<std::vector<std::uint32_t>> point_weights(const SceneData& scene, const VoxelGrid& grid,
                                                        std::span<const double> spacings_m, const Progress& progress);

}  // namespace vantage
