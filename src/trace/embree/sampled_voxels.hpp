// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "voxel/voxel_grid.hpp"
#include "voxel/voxel_triangles.hpp"

namespace vantage {

// The voxels of a sample, each with the surveyed triangles that can be hit in it. Immutable.
class SampledVoxels {
 public:
  static constexpr std::size_t most_planes = 16;  // of a voxel that are worth asking
  // A triangle within its plane. Relative to the middle of the voxel's cube, in which it matters alone.
  struct Piece {
    struct Edge {
      Float3 inwards;  // unit, in the plane; the triangle lies where inwards · p >= offset
      float offset;
      float ratio;  // longest edge to this one
    };
    std::array<Edge, 3> edge;
    float longest;  // edge
  };
  // Some triangles of one plane, normal · p = offset for p from the middle of the cube.
  struct Plane {
    Float3 normal;  // unit, or 0 where a triangle has no area
    float offset;
    float slenderness;  // largest, as SeenTriangle has it; infinite where a triangle has no area
    std::uint32_t first, end;
  };
  // By voxel: its cell, and a box that holds what of its planes can be hit there and count: middle, relative to that of
  // the cube, and half of the extent.
  struct Places {
    std::array<std::vector<std::int32_t>, 3> cell;
    std::array<std::vector<float>, 3> middle, half;
  };

  // `pad`: rounding_pad() of everything in sight. `reach`: how far noise moves a point. `margin`: how far outside its
  // voxel's cube a triangle may be hit whose point still counts in it. Metres.
  SampledVoxels(const SceneData& scene, const VoxelGrid& grid, SampleTriangles& triangles,
                std::span<const std::uint32_t> ranks, double pad, double reach, double margin);

  bool made_for(std::span<const std::uint32_t> ranks, double pad, double reach) const;
  std::size_t size() const { return ranks_.size(); }
  std::array<std::uint32_t, 3> cell(std::size_t i) const {
    return {static_cast<std::uint32_t>(places_.cell[0][i]), static_cast<std::uint32_t>(places_.cell[1][i]),
            static_cast<std::uint32_t>(places_.cell[2][i])};
  }
  // Those of them that pass the cube come first, so many. None at all: too many to be worth asking.
  std::span<const Plane> planes(std::size_t i) const {
    return {planes_.data() + offset_[i], planes_.data() + offset_[i + 1]};
  }
  std::uint32_t crossing(std::size_t i) const { return crossing_[i]; }
  const Piece& piece(std::size_t k) const { return pieces_[k]; }
  const Places& places() const { return places_; }

 private:
  double pad_, reach_;
  std::vector<std::uint32_t> ranks_;
  std::vector<std::uint32_t> offset_, crossing_;
  std::vector<Plane> planes_;
  std::vector<Piece> pieces_;
  Places places_;
};

}  // namespace vantage
