// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "voxel/voxel_grid.hpp"
#include "voxel/voxel_triangles.hpp"

namespace vantage {

// Voxels of a sample, each with the surveyed triangles that can be hit in it. Immutable.
class SampledVoxels {
 public:
  static constexpr std::size_t kMostPlanes = 16;  // most planes of a voxel for which tests pay
  // Part of a plane covered by a triangle, relative to the middle of the voxel's cube. Valid only for that cube.
  struct Piece {
    struct Edge {
      Float3 inwards;  // unit, in the plane; the triangle lies where inwards · p >= offset
      float offset;
      float ratio;  // longest edge divided by this one
    };
    std::array<Edge, 3> edge;
    float longest;  // edge
  };
  // Triangles of one plane, normal · p = offset for p from the middle of the cube.
  struct Plane {
    Float3 normal;  // unit; 0 if a triangle has no area
    float offset;
    float slenderness;  // largest SeenTriangle::slenderness; infinite if a triangle has no area
    float diffuse;      // least of its triangles
    // Largest distance of a hit's normal from the plane's, as unit vectors; 1 or above: unknown.
    float tilt;
    std::uint32_t first, end;
  };
  using Cell = std::array<std::vector<std::int32_t>, 3>;  // by axis and voxel
  // Box around the triangles of a voxel's planes that pass its cube, and around all hits on them, relative to the
  // cube's middle.
  struct Around {
    Float3 low, high;
  };

  // Cells of a group of `size` voxels with neighbouring numbers, from a multiple of `size` on.
  struct Cells {
    std::array<std::int32_t, 3> low, high;
  };
  static constexpr std::array<std::size_t, 3> kGroupSizes{512, 64, 8};

  // `pad`: rounding_pad() of everything in sight. `reach`: how far noise moves a point. `margin`: largest distance of a
  // triangle's hit from its voxel's cube if its point still counts there. Metres.
  SampledVoxels(const SceneData& scene, const VoxelGrid& grid, SampleTriangles& triangles,
                std::span<const std::uint32_t> voxel_indices, double pad, double reach, double margin);

  bool made_for(std::span<const std::uint32_t> voxel_indices, double pad, double reach) const;
  std::size_t size() const { return voxel_indices_.size(); }
  std::array<std::uint32_t, 3> cell(std::size_t i) const {
    return {static_cast<std::uint32_t>(cells_[0][i]), static_cast<std::uint32_t>(cells_[1][i]),
            static_cast<std::uint32_t>(cells_[2][i])};
  }
  // Returns the planes that pass the cube, followed by the others. Empty if they are too many for tests to pay.
  std::span<const Plane> planes(std::size_t i) const {
    return {planes_.data() + offset_[i], planes_.data() + offset_[i + 1]};
  }
  std::uint32_t crossing(std::size_t i) const { return crossing_[i]; }
  const Piece& piece(std::size_t k) const { return pieces_[k]; }
  const Cell& cells() const { return cells_; }
  const Around& around(std::size_t i) const { return around_[i]; }
  // Returns group k of kGroupSizes[level] voxels.
  const Cells& group(std::size_t level, std::size_t k) const { return groups_[level][k]; }

 private:
  double pad_, reach_;
  std::vector<std::uint32_t> voxel_indices_;
  std::vector<std::uint32_t> offset_, crossing_;
  std::vector<Plane> planes_;
  std::vector<Piece> pieces_;
  Cell cells_;
  std::vector<Around> around_;
  std::array<std::vector<Cells>, kGroupSizes.size()> groups_;
};

}  // namespace vantage
