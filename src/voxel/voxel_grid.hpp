// SPDX-License-Identifier: Apache-2.0
// The surveyed voxels (section 4.1), in Morton order: the cells, touched by a surveyed triangle, of a cubic grid of
// 2^depth cells per side over the surveyed meshes. The single definition of "which voxel".
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "scene/scene_data.hpp"
#include "shared/voxel_types.h"
#include "vantage/progress.hpp"
#include "voxel/voxel_demands.hpp"

namespace vantage {

struct FitBasis;         // voxel/grid_fit.hpp
struct VoxelBricks;      // voxel/voxel_bricks.hpp
struct SceneDifference;  // scene/scene_difference.hpp

inline constexpr std::uint32_t kNoVoxel = 0xFFFFFFFFu;
inline constexpr int kMaxVoxelDepth = 18;  // 2^18 cells per side; 54-bit Morton keys

// Interleaves voxel coordinates, x lowest: bit 3k of the key is bit k of x.
std::uint64_t morton_encode(std::uint32_t x, std::uint32_t y, std::uint32_t z);
std::array<std::uint32_t, 3> morton_decode(std::uint64_t key);

class VoxelGrid {
 public:
  // Builds the grid by equation 2. The cube's side is 1.002 × the largest extent of the surveyed meshes, centred on
  // their bounds. It is moved within that margin to keep surveyed axis-aligned planes off voxel faces (docs/method.md).
  // Throws Error invalid_argument: user size not positive, or so small that the depth exceeds kMaxVoxelDepth.
  static VoxelGrid build(const SceneData& scene, double user_size_m);
  // Does the same with progress; empty if stopped.
  static std::optional<VoxelGrid> build(const SceneData& scene, double user_size_m, const Progress& progress);

  // Returns the grid of a changed scene, as build() would make it, without point weights: voxels are searched only
  // where meshes differ. Empty if build() is needed: the grid lies elsewhere, or meshes have several weights. REQUIRES:
  // this grid is of scene `before`, built with this user size.
  std::optional<VoxelGrid> changed(const SceneData& before, const SceneData& after, const SceneDifference& difference,
                                   double user_size_m) const;

  int depth() const { return depth_; }
  double voxel_size() const { return voxel_size_; }
  const std::array<float, 3>& min() const { return min_; }  // local frame; exactly what shaders use
  std::uint64_t size() const { return size_; }              // N_v
  // Returns the sorted Morton key of the voxel with this index; find() is the inverse.
  std::uint64_t key(std::uint64_t voxel_index) const;
  std::uint32_t find(std::uint64_t key) const;  // index, or kNoVoxel
  // Returns the voxel coordinates of a local-frame point, in float arithmetic: floor((p − min) · (1 / voxel_size));
  // empty outside the cube.
  std::optional<std::array<std::uint32_t, 3>> cell_of(const Float3& p) const;
  std::uint32_t index_of(const Float3& p) const;  // find(morton(cell_of(p))), kNoVoxel outside

  // Data for upload: bricks of 8³ voxels in Morton order and a hash table over them (shaders/shared/voxel_types.h).
  std::span<const VoxelBrick> bricks() const { return bricks_; }
  std::span<const BrickSlot> slots() const { return slots_; }  // a power of two of them
  float inverse_size() const { return inverse_size_; }
  // Coverage's demands on each voxel, by index: weights from the scene; point weights once set.
  const VoxelDemands& demands() const { return demands_; }
  std::uint64_t total_weight() const { return total_weight_; }
  void set_point_weights(std::vector<std::uint32_t> point_weights) {
    demands_.point_weights = std::move(point_weights);
  }

 private:
  void take(VoxelBricks&& marked);

  int depth_ = 0;
  double voxel_size_ = 0;
  float inverse_size_ = 0;
  std::array<float, 3> min_{};
  std::uint64_t size_ = 0;
  std::vector<VoxelBrick> bricks_;
  std::vector<BrickSlot> slots_;
  std::vector<std::uint32_t> brick_at_;  // of every kStep-th voxel: where key() begins
  VoxelDemands demands_;
  std::uint64_t total_weight_ = 0;
  std::shared_ptr<const FitBasis> basis_;  // data that the grid was fitted to
};

// Voxelizes conservatively: returns all cells of the grid whose closed box a triangle of `triangles` (local frame)
// touches, as sorted Morton keys without duplicates. Exact in double precision (separating axes: Akenine-Möller, Fast
// 3D Triangle-Box Overlap Testing, 2001). Parallel; the result does not depend on the number of threads.
std::vector<std::uint64_t> voxelize(std::span<const Float3> positions, std::span<const Triangle> triangles,
                                    const std::array<double, 3>& min, double voxel_size, int depth);

}  // namespace vantage
