// SPDX-License-Identifier: Apache-2.0
// The surface in each voxel as registration sees it: one plane.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

#include "scene/scene_data.hpp"
#include "voxel/flat_windows.hpp"
#include "voxel/voxel_grid.hpp"
#include "voxel/voxel_triangles.hpp"

namespace vantage {

// Normals closer than this, some 26°, belong to one plane: scans of a curved surface still match up to this angle.
inline constexpr double kOnePlaneCosine = 0.9;

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

// Finds the surfaces of a series of samples of voxels. Makes data that do not depend on the sample only once.
class SurfaceFinder {
 public:
  SurfaceFinder(std::shared_ptr<const SceneData> scene, std::shared_ptr<const VoxelGrid> grid,
                std::shared_ptr<SampleTriangles> triangles);
  SurfaceFinder(const SceneData& scene, const VoxelGrid& grid);  // borrows both

  // Clips every surveyed triangle to the voxel's cube, in double. If two parallel sheets lie in one voxel, as in a thin
  // wall, the larger counts. A plane has at most the area of its section with the cube, so a sheet modelled twice
  // counts once. A window of `window_m` metres around each plane's point, if wider than a voxel, reduces its share to
  // the flat part at that scale. A stop ends it early, with no surfaces. Parallel; a voxel's surface depends neither on
  // the other voxels nor on the number of threads. REQUIRES: voxel_indices ascending, without duplicates, below the
  // grid's size. Throws Error out_of_memory as `triangles_touching` does.
  std::vector<VoxelSurface> find(std::span<const std::uint32_t> voxel_indices, double window_m = 0,
                                 const std::stop_token& stop = {});

 private:
  std::shared_ptr<const SceneData> scene_;
  std::shared_ptr<const VoxelGrid> grid_;
  std::shared_ptr<SampleTriangles> triangles_;
  std::unique_ptr<const FlatWindows> windows_;  // of the last window
};

// Does the same for one sample.
std::vector<VoxelSurface> voxel_surfaces(const SceneData& scene, const VoxelGrid& grid,
                                         std::span<const std::uint32_t> voxel_indices, double window_m = 0,
                                         const std::stop_token& stop = {});

}  // namespace vantage
