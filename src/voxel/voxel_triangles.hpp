// SPDX-License-Identifier: Apache-2.0
// Which surveyed triangles can be hit within a voxel.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {

// Lists of scene triangles, one list a voxel: those of voxel number i are triangle[offset[i]] … triangle[offset[i + 1]
// − 1], ascending.
struct VoxelTriangles {
  std::vector<std::uint32_t> offset;  // n + 1
  std::vector<std::uint32_t> triangle;
};

// Surveyed triangles that touch each voxel's cube widened by `margin_m` on every side. Parallel; the result does not
// depend on the number of threads. REQUIRES: ranks ascending, without duplicates, below grid.size(); margin_m >= 0.
// Throws Error out_of_memory where the lists would hold more than 2^32 − 1 triangles.
VoxelTriangles triangles_touching(const SceneData& scene, const VoxelGrid& grid, std::span<const std::uint32_t> ranks,
                                  double margin_m);

// The same for one sample after another. From the second on it goes by lists of each brick's triangles, made then: so a
// sample takes the time of what it touches, not of the whole scene. From several threads at once.
class SampleTriangles {
 public:
  SampleTriangles(std::shared_ptr<const SceneData> scene, std::shared_ptr<const VoxelGrid> grid);
  VoxelTriangles touching(std::span<const std::uint32_t> ranks, double margin_m);

 private:
  struct Bricks {
    double margin_m;
    VoxelTriangles triangles;  // a list a brick
  };
  // Null while a walk over the scene is as good.
  std::shared_ptr<const Bricks> bricks_for(std::span<const std::uint32_t> ranks, double margin_m);
  VoxelTriangles by_bricks(const Bricks& bricks, std::span<const std::uint32_t> ranks, double margin_m) const;

  std::shared_ptr<const SceneData> scene_;
  std::shared_ptr<const VoxelGrid> grid_;
  std::mutex mutex_;
  std::vector<std::uint32_t> first_;  // the first sample that was asked for
  std::shared_ptr<const Bricks> bricks_;
};

}  // namespace vantage
