// SPDX-License-Identifier: Apache-2.0
// What each surveyed voxel counts in coverage.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scene/scene_data.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {

// By rank, the largest weight of the surveyed meshes that touch the voxel. Empty where all surveyed meshes weigh alike:
// only ratios matter. Nothing where it was stopped. Parallel; the result does not depend on the number of threads.
std::optional<std::vector<std::uint8_t>> voxel_weights(const SceneData& scene, const VoxelGrid& grid,
                                                       const Progress& progress);

}  // namespace vantage
