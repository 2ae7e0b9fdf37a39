// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "voxel/voxel_grid.hpp"

namespace vantage {

// The voxels of a sample, each with the corners of the surveyed triangles that can be hit in it. Immutable.
class SampledVoxels {
 public:
  struct Corners {
    Float3 a, b, c;
  };

  // `margin_m`: how far outside its voxel's cube a triangle may be hit whose point still counts in it.
  SampledVoxels(const SceneData& scene, const VoxelGrid& grid, std::span<const std::uint32_t> ranks, double margin_m);

  bool made_for(std::span<const std::uint32_t> ranks, double margin_m) const;
  std::size_t size() const { return cells_.size(); }
  const std::array<std::uint32_t, 3>& cell(std::size_t i) const { return cells_[i]; }
  std::span<const Corners> triangles(std::size_t i) const {
    return {corners_.data() + offset_[i], corners_.data() + offset_[i + 1]};
  }

 private:
  double margin_m_;
  std::vector<std::uint32_t> ranks_, offset_;
  std::vector<std::array<std::uint32_t, 3>> cells_;
  std::vector<Corners> corners_;
};

}  // namespace vantage
