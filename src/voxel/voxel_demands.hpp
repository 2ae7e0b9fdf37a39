// SPDX-License-Identifier: Apache-2.0
// What coverage asks of each surveyed voxel.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"
#include "vantage/progress.hpp"

namespace vantage {

class VoxelGrid;

// Element k is of the voxel with rank k, or of the k-th of a sample; empty where all voxels are alike.
struct VoxelDemands {
  std::vector<std::uint8_t> weights;  // what the voxel counts; empty: 1 each
  // What a point in it is worth: `densest_worth` where the goal is the densest of all, more where fewer will do. A
  // voxel is full where its points are worth as many as those of the densest goal. Integers, so that sums do not depend
  // on their order; rounded up, by less than 1 in `densest_worth`. Empty: all have one goal, and a point is worth 1.
  std::vector<std::uint32_t> worths;

  std::uint32_t weight(std::size_t k) const { return weights.empty() ? 1 : weights[k]; }
  std::uint32_t worth(std::size_t k) const { return worths.empty() ? 1 : worths[k]; }
  // What a point in a voxel of the densest goal is worth.
  std::uint32_t least_worth() const;
  // Those of a sample. REQUIRES: ranks below the number of voxels.
  VoxelDemands of(std::span<const std::uint32_t> ranks) const;
};

inline constexpr std::uint32_t densest_worth = 4096;

// By rank, the largest weight of the surveyed meshes that touch the voxel. Empty where all surveyed meshes weigh alike:
// only ratios matter. Nothing where it was stopped. Parallel; the result does not depend on the number of threads.
std::optional<std::vector<std::uint8_t>> voxel_weights(const SceneData& scene, const VoxelGrid& grid,
                                                       const Progress& progress);

// Of what surveyed meshes want, metres, one spacing for each mesh of the scene. REQUIRES: one is surveyed.
double finest_spacing(const SceneData& scene, std::span<const double> spacings_m);

// By rank, what a point is worth where surveyed meshes want spacings of their own: of those that touch the voxel the
// finest holds. No voxel wants less than one point. Empty where all want the same; nothing where it was stopped.
// Parallel; the result does not depend on the number of threads.
std::optional<std::vector<std::uint32_t>> point_worths(const SceneData& scene, const VoxelGrid& grid,
                                                       std::span<const double> spacings_m, const Progress& progress);

}  // namespace vantage
