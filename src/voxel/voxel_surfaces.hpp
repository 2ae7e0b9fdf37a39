// SPDX-License-Identifier: Apache-2.0
// The surface in each voxel as registration sees it: one plane.
#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "scene/scene_data.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {

// Normals closer than this, some 26°, belong to one plane: scans of a curved surface still match up to this angle.
inline constexpr double one_plane = 0.9;

// The plane that holds most of a voxel's surface. Winding does not matter: n and −n are one plane.
struct VoxelSurface {
  Float3 point;            // local frame: centroid of the plane's surface within the voxel
  Float3 normal;           // unit length, either sign
  float area = 0;          // m² of that surface; 0 if triangles only touch the voxel
  float share = 0;         // its share of all surface within the voxel, (0, 1]; less if the window has less
  float extent = 0;        // m² of all surface within the voxel, at most that of a face: the voxel's weight in means
  std::uint32_t mesh = 0;  // mesh with most surface in the voxel
  float diffuse = 0;       // mean diffuse coefficient of that surface
};

// Clips every surveyed triangle to the voxel's cube, in double. Of two parallel sheets in one voxel, as of a thin wall,
// the larger counts. A plane has at most the area of its section with the cube, so a sheet modelled twice counts once.
// A window of `window_m` metres around each plane's point, if wider than a voxel, reduces its share to the flat part at
// that scale. A stop ends it early, with no surfaces. Parallel; a voxel's surface depends neither on the other voxels
// nor on the number of threads. REQUIRES: voxel_indices ascending, without duplicates, below grid.size(). Throws Error
// out_of_memory as `triangles_touching` does.
std::vector<VoxelSurface> voxel_surfaces(const SceneData& scene, const VoxelGrid& grid,
                                         std::span<const std::uint32_t> voxel_indices, double window_m = 0,
                                         const std::stop_token& stop = {});

}  // namespace vantage
