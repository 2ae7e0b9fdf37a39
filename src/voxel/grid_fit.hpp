// SPDX-License-Identifier: Apache-2.0
// Fits the voxel grid: equation 2, and the remedy for walls on voxel faces.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"
#include "scene/scene_difference.hpp"

namespace vantage {

struct GridFit {
  int depth = 0;
  float inverse_size = 1;  // the voxel size is its exact reciprocal
  std::array<float, 3> min{};
};

// A surveyed triangle nearly perpendicular to an axis: its extent along that axis, relative to the grid's min.
struct Slab {
  double low, high;
  std::uint64_t weight;  // area, as an integer so that sums do not depend on the order
};
// Slabs of each axis, ascending; those at the same heights add up their weights.
using AxisSlabs = std::array<std::vector<Slab>, 3>;

// The cube around the surveyed meshes before it is moved, and the values that determine its move.
struct GridCube {
  GridFit fit;
  std::array<double, 3> low{}, high{};  // of the surveyed meshes
  double extent = 0, margin = 0, clearance = 0;
  friend bool operator==(const GridCube& a, const GridCube& b) {
    return a.fit.depth == b.fit.depth && a.fit.inverse_size == b.fit.inverse_size && a.fit.min == b.fit.min &&
           a.low == b.low && a.high == b.high && a.clearance == b.clearance;
  }
};

struct FitBasis {
  std::vector<Box> bounds;  // of each surveyed mesh with triangles
  GridCube cube;
  bool has_slabs = false;  // not if there are too many to keep
  AxisSlabs slabs;
};

// Returns the cube of `VoxelGrid::build`.
//
// Host and device must find the same voxel, so the grid is *defined* by the floats that the device reads. `min` and
// `inverse_size` are rounded once, here, and the voxel size is 1 / inverse_size in double. A face then lies at a whole
// number of (p − min) · inverse_size. Double evaluates this without error for nearly all float coordinates, float with
// two roundings.
//
// A plane on a face would mark the voxels on both sides of it, while rounding scatters its points between them. The
// cube is therefore moved along each axis, by as little as possible, until no axis-aligned surveyed plane lies within
// `face_clearance` of a face. If there are too many planes for that, their area within it is minimised.
//
// `basis`: receives the data that the grid was fitted to, if given.
GridFit fit_grid(const SceneData& scene, std::span<const MeshRange> surveyed, double user_size_m,
                 FitBasis* basis = nullptr);

// Does the same for a changed scene, from the basis of the scene before. Empty if the cube, before its move, is another
// one, or if no basis was kept because of too many planes. Both spans are the scenes' surveyed_ranges().
std::optional<GridFit> refit_grid(const FitBasis& before, const SceneData& scene_before, const SceneData& scene,
                                  std::span<const MeshRange> surveyed, const SceneDifference& difference,
                                  double user_size_m, FitBasis& basis);

// Returns the distance that a plane must keep from a voxel face: 16 ulp of the largest coordinate or of the cube's
// side, at least a thousandth and at most an eighth of a voxel. A hit's position carries the roundings of t, t·d and o
// + t·d, its cell those of two more operations; 4 ulp were the worst seen. The upper limit keeps most of each voxel
// free in very fine grids.
double face_clearance(double reach_m, double voxel_size_m);

}  // namespace vantage
