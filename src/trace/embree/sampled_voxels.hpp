// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "voxel/voxel_grid.hpp"

namespace vantage {

// The voxels of a sample, each with the surveyed triangles that can be hit in it. Immutable.
class SampledVoxels {
 public:
  struct Listed {
    Float3 a, b, c;
    float longest = 0;      // edge
    float gap = 0;          // it is at least so far outside the cube
    float slenderness = 0;  // as SeenTriangle has it
    Vec3 normal;            // unit; its plane is normal · p = offset
    double offset = 0;
  };

  // `margin_m`: how far outside its voxel's cube a triangle may be hit whose point still counts in it.
  SampledVoxels(const SceneData& scene, const VoxelGrid& grid, std::span<const std::uint32_t> ranks, double margin_m);

  bool made_for(std::span<const std::uint32_t> ranks, double margin_m) const;
  std::size_t size() const { return cells_.size(); }
  const std::array<std::uint32_t, 3>& cell(std::size_t i) const { return cells_[i]; }
  // Nearest to the cube first.
  std::span<const Listed> triangles(std::size_t i) const {
    return {listed_.data() + offset_[i], listed_.data() + offset_[i + 1]};
  }

 private:
  double margin_m_;
  std::vector<std::uint32_t> ranks_, offset_;
  std::vector<std::array<std::uint32_t, 3>> cells_;
  std::vector<Listed> listed_;
};

}  // namespace vantage
