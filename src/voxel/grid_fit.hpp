// SPDX-License-Identifier: Apache-2.0
// Fits the voxel grid: equation 2, and the remedy for walls on voxel faces.
#pragma once

#include <array>
#include <span>

#include "scene/scene_data.hpp"

namespace vantage {

struct GridFit {
  int depth = 0;
  float inverse_size = 1;  // the voxel size is its exact reciprocal
  std::array<float, 3> min{};
};

// The cube of `VoxelGrid::build`.
//
// Host and device must find the same voxel, so the grid is *defined* by the floats that the device reads. `min` and
// `inverse_size` are rounded once, here, and the voxel size is 1 / inverse_size in double. A face then lies at a whole
// number of (p − min) · inverse_size. Double evaluates this without error for nearly all float coordinates, float with
// two roundings.
//
// A plane on a face would mark the voxels on both sides of it, while rounding scatters its points between them. The
// cube is therefore moved along each axis, by as little as possible, until no axis-aligned surveyed plane lies within
// `face_clearance` of a face. If there are too many planes for that, their area within it is minimised.
GridFit fit_grid(const SceneData& scene, std::span<const MeshRange> surveyed, double user_size_m);

// Distance that a plane must keep from a voxel face: 16 ulp of the largest coordinate or of the cube's side, at least a
// thousandth and at most an eighth of a voxel. A hit's position carries the roundings of t, t·d and o + t·d, its cell
// those of two more operations; 4 ulp were the worst seen. The upper limit keeps most of each voxel free in very fine
// grids.
double face_clearance(double reach_m, double voxel_size_m);

}  // namespace vantage
