// SPDX-License-Identifier: Apache-2.0
// Finds the surveyed triangles that can be hit within a voxel.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {

// Lists of scene triangles, one per voxel: voxel number i has triangle[offset[i]] … triangle[offset[i + 1] − 1],
// ascending.
struct VoxelTriangles {
  std::vector<std::uint32_t> offset;  // n + 1
  std::vector<std::uint32_t> triangle;
};

// Returns the surveyed triangles that touch each voxel's cube widened by `margin_m` on every side. Parallel; the result
// does not depend on the number of threads. REQUIRES: voxel_indices ascending, without duplicates, below grid.size();
// margin_m >= 0. Throws Error out_of_memory if the lists would hold more than 2^32 − 1 triangles.
VoxelTriangles triangles_touching(const SceneData& scene, const VoxelGrid& grid,
                                  std::span<const std::uint32_t> voxel_indices, double margin_m);

// Does the same for a series of samples. The second call makes lists of each brick's triangles; from then on a sample's
// cost depends on the bricks that it touches, not on the whole scene. Callable from several threads at once.
class SampleTriangles {
 public:
  SampleTriangles(std::shared_ptr<const SceneData> scene, std::shared_ptr<const VoxelGrid> grid);
  VoxelTriangles touching(std::span<const std::uint32_t> voxel_indices, double margin_m);

 private:
  struct Bricks {
    double margin_m;
    VoxelTriangles triangles;  // one list per brick
  };
  // Returns null while a walk over the scene is as fast.
  std::shared_ptr<const Bricks> bricks_for(std::span<const std::uint32_t> voxel_indices, double margin_m);
  VoxelTriangles by_bricks(const Bricks& bricks, std::span<const std::uint32_t> voxel_indices, double margin_m) const;

  std::shared_ptr<const SceneData> scene_;
  std::shared_ptr<const VoxelGrid> grid_;
  std::mutex mutex_;
  std::vector<std::uint32_t> first_;  // the first sample asked for
  std::shared_ptr<const Bricks> bricks_;
};

}  // namespace vantage
