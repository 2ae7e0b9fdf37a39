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
  static constexpr std::size_t kMostPlanes = 16;  // most planes of a voxel that are worth testing
  // A triangle within its plane, relative to the middle of the voxel's cube. Valid for that cube only.
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
    float diffuse;      // the least of a triangle
    // No hit has a normal farther from that of the plane, as vectors of unit length; 1 or above: nothing is known.
    float tilt;
    std::uint32_t first, end;
  };
  using Cell = std::array<std::vector<std::int32_t>, 3>;  // by axis and voxel
  // Corners of a box around the triangles of a voxel's planes that pass its cube, and all hits on them, from its
  // middle.
  struct Around {
    Float3 low, high;
  };

  // Neighbouring voxels, by their number: `size` of them from a multiple of it on lie in these cells.
  struct Cells {
    std::array<std::int32_t, 3> low, high;
  };
  static constexpr std::array<std::size_t, 3> kGroupSizes{512, 64, 8};

  // `pad`: rounding_pad() of everything in sight. `reach`: how far noise moves a point. `margin`: how far outside its
  // voxel's cube a triangle's hit may lie whose point still counts in it. Metres.
  SampledVoxels(const SceneData& scene, const VoxelGrid& grid, SampleTriangles& triangles,
                std::span<const std::uint32_t> voxel_indices, double pad, double reach, double margin);

  bool made_for(std::span<const std::uint32_t> voxel_indices, double pad, double reach) const;
  std::size_t size() const { return voxel_indices_.size(); }
  std::array<std::uint32_t, 3> cell(std::size_t i) const {
    return {static_cast<std::uint32_t>(cells_[0][i]), static_cast<std::uint32_t>(cells_[1][i]),
            static_cast<std::uint32_t>(cells_[2][i])};
  }
  // Planes that pass the cube, followed by the others. Empty: too many to be worth testing.
  std::span<const Plane> planes(std::size_t i) const {
    return {planes_.data() + offset_[i], planes_.data() + offset_[i + 1]};
  }
  std::uint32_t crossing(std::size_t i) const { return crossing_[i]; }
  const Piece& piece(std::size_t k) const { return pieces_[k]; }
  const Cell& cells() const { return cells_; }
  const Around& around(std::size_t i) const { return around_[i]; }
  // Number k of the groups of kGroupSizes[level] voxels.
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
