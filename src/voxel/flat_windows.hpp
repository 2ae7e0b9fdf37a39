// SPDX-License-Identifier: Apache-2.0
// Whether the surface around a voxel is flat at a scale of its own, be voxels ever so fine.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {

struct VoxelSurface;

// Of all surveyed surface within the cube of side `window_m`, metres, around each voxel's plane point, the share that
// lies in the plane: its normal is the plane's (`one_plane`), n and −n being one. Surface that is parallel, but
// displaced along the normal, counts for nothing: the other face of a wall is seen from its other side. 1 where a voxel
// has no surface. Triangles much smaller than the window are taken whole, by their middle, others are clipped.
//
// Parallel; a voxel's share depends neither on the other ranks nor on the number of threads. Beside the lists it takes
// 28 bytes a small triangle. REQUIRES: surfaces are those of the ranks, which ascend, without duplicates, below
// grid.size(); window_m > 0. Throws Error out_of_memory as `triangles_touching` does.
std::vector<float> flat_shares(const SceneData& scene, const VoxelGrid& grid, std::span<const std::uint32_t> ranks,
                               std::span<const VoxelSurface> surfaces, double window_m);

}  // namespace vantage
