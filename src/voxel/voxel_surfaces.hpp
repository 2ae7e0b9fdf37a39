// SPDX-License-Identifier: Apache-2.0
// What lies in each voxel, as registration sees it: one plane.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {

// Normals closer than this, some 26°, are one plane: as far as scans of a curved surface still match each other.
inline constexpr double one_plane = 0.9;

// The plane that most of a voxel's surface lies in. Winding is not relied on: n and −n are one plane.
struct VoxelSurface {
  Float3 point;      // local frame: centroid of the plane's surface within the voxel
  Float3 normal;     // unit length, either way round
  float area = 0;    // m² of that surface; 0 where triangles touch the voxel and no more
  float share = 0;   // of it in all surface within the voxel, (0, 1]; less where the window has less
  float extent = 0;  // m² of all surface within the voxel, at most that of a face: what the voxel weighs in means
  std::uint32_t mesh = 0;  // that has most surface in the voxel
  float diffuse = 0;       // mean diffuse coefficient of that surface
};

// By clipping every surveyed triangle to the voxel's cube, in double. Of two parallel sheets in one voxel, as a wall
// thinner than it, the larger counts; no plane has more surface than the cube cuts from it, so that a sheet modelled
// twice is one. A window of `window_m` metres around each plane's point, where that is wider than a voxel, narrows its
// share to what is flat at that scale. Parallel; a voxel's surface depends neither on the other ranks nor on the number
// of threads. REQUIRES: ranks ascending, without duplicates, below grid.size(). Throws Error out_of_memory as
// `triangles_touching` does.
std::vector<VoxelSurface> voxel_surfaces(const SceneData& scene, const VoxelGrid& grid,
                                         std::span<const std::uint32_t> ranks, double window_m = 0);

}  // namespace vantage
