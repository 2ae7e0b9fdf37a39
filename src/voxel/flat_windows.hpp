// SPDX-License-Identifier: Apache-2.0
// Tests whether the surface around a voxel is flat at a scale independent of the voxel size.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

#include "scene/scene_data.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {

struct VoxelSurface;

// The surveyed triangles of a scene, sorted once for windows of one size: 48 bytes per small triangle. Borrows scene
// and grid.
class FlatWindows {
 public:
  // REQUIRES: window_m > 0.
  FlatWindows(const SceneData& scene, const VoxelGrid& grid, double window_m);
  ~FlatWindows();
  double window_m() const;

  // Share of coplanar surface in all surveyed surface within the cube of side `window_m()`, metres, around each voxel's
  // plane point. Coplanar means the plane's normal (`kOnePlaneCosine`), with n and −n equal. Parallel surface displaced
  // along the normal is not coplanar, since the other face of a wall is seen from its other side. 1 if a voxel has no
  // surface. Triangles much smaller than the window count as a whole, by their middle; others are clipped.
  //
  // Parallel; a voxel's share depends neither on the other voxels nor on the number of threads. A stop ends it early,
  // without shares. REQUIRES: surfaces are those of the voxel_indices, which ascend, without duplicates, below
  // grid.size(). Throws Error out_of_memory as `triangles_touching` does.
  std::vector<float> shares(std::span<const std::uint32_t> voxel_indices, std::span<const VoxelSurface> surfaces,
                            const std::stop_token& stop = {}) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace vantage
