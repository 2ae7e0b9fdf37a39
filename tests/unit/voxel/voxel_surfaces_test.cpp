// SPDX-License-Identifier: Apache-2.0
#include "voxel/voxel_surfaces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "clipped_voxels.hpp"
#include "voxel_scenes.hpp"

namespace vantage {
namespace {

std::vector<VoxelSurface> all_surfaces(const SceneData& scene, const VoxelGrid& grid) {
  std::vector<std::uint32_t> voxel_indices(grid.size());
  std::iota(voxel_indices.begin(), voxel_indices.end(), 0u);
  return voxel_surfaces(scene, grid, voxel_indices);
}

double along(const Float3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// Each voxel has the plane itself, however voxels and triangles cut it.
TEST(VoxelSurfaces, OfATiltedPatchAreItsOwn) {
  SceneData scene;
  const Vec3 u{3, 1, 0.5}, v{-0.4, 2, 0.7}, corner{0.2, -0.3, 0.1};
  test::add_patch(scene, corner, u, v, 7, 5);
  const VoxelGrid grid = VoxelGrid::build(scene, 0.1);
  const Vec3 n = cross(u, v);
  const double area = std::sqrt(dot(n, n));
  double sum = 0;
  for (const VoxelSurface& surface : all_surfaces(scene, grid)) {
    sum += surface.area;
    if (!(surface.area > 1e-9f)) continue;
    EXPECT_NEAR(std::abs(along(surface.normal, n * (1 / area))), 1, 1e-6);
    EXPECT_NEAR(along(surface.point, n * (1 / area)) - dot(corner, n * (1 / area)), 0, 1e-6);
    EXPECT_NEAR(surface.share, 1, 1e-6);
    EXPECT_LE(surface.extent, grid.voxel_size() * grid.voxel_size() * (1 + 1e-6));
    EXPECT_FLOAT_EQ(surface.diffuse, 0.5f);
  }
  EXPECT_NEAR(sum, area, 1e-5 * area);
}

// Uses the reference voxelization's own clipping, on single triangles.
TEST(VoxelSurfaces, HaveTheAreaThatClippingLeaves) {
  std::mt19937 rng(3);
  for (int k = 0; k < 20; ++k) {
    SceneData scene;
    test::add_mesh(scene, test::random_triangles(rng, 1, 2.0f, 1.0f), {{0, 1, 2}});
    const VoxelGrid grid = VoxelGrid::build(scene, 0.1);
    const auto surfaces = all_surfaces(scene, grid);
    for (std::uint64_t voxel_index = 0; voxel_index < grid.size(); ++voxel_index) {
      const auto cell = morton_decode(grid.key(voxel_index));
      test::Polygon<double> polygon;
      for (const Float3& p : scene.positions) polygon.push_back({p.x, p.y, p.z});
      for (int axis = 0; axis < 3 && !polygon.empty(); ++axis) {
        const double low = grid.min()[axis] + cell[axis] * grid.voxel_size();
        polygon = test::clip(test::clip(polygon, axis, low, -1), axis, low + grid.voxel_size(), 1);
      }
      Vec3 sum;
      for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        const auto at = [&](std::size_t c) { return Vec3{polygon[c][0], polygon[c][1], polygon[c][2]}; };
        sum = sum + cross(at(i) - at(0), at(i + 1) - at(0)) * 0.5;
      }
      ASSERT_NEAR(surfaces[voxel_index].area, std::sqrt(dot(sum, sum)), 1e-6);
    }
  }
}

TEST(VoxelSurfaces, ShareOfTheLargerPlaneAtAnEdge) {
  SceneData scene;  // a floor with a wall on it: within one voxel, 0.09 m of floor meet 0.03 m of wall
  test::add_patch(scene, {0, 0, 0}, {0.09, 0, 0}, {0, 0.1, 0});
  test::add_patch(scene, {0, 0, 0}, {0, 0.1, 0}, {0, 0, 0.03});
  const VoxelGrid grid = VoxelGrid::build(scene, 1);
  ASSERT_EQ(grid.size(), 1u);
  const VoxelSurface surface = all_surfaces(scene, grid)[0];
  EXPECT_NEAR(surface.share, 0.75, 1e-6);
  EXPECT_NEAR(surface.area, 0.009, 1e-8);
  EXPECT_NEAR(surface.extent, std::min(0.012, grid.voxel_size() * grid.voxel_size()), 1e-8);
  EXPECT_NEAR(std::abs(surface.normal.z), 1, 1e-6);
  EXPECT_NEAR(surface.point.x, 0.045, 1e-6);
}

TEST(VoxelSurfaces, OfAThinWallAreOneOfItsSheets) {
  for (const double thickness : {0.02, 0.0}) {
    SceneData scene;  // two sheets, wound apart; without thickness, one sheet modelled twice
    test::add_patch(scene, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 3, 3);
    test::add_patch(scene, {-thickness, 0, 0}, {0, 0, 1}, {0, 1, 0}, 3, 3);
    test::add_patch(scene, {1.3, 0, 0}, {0, 1, 0}, {0, 0, 1});  // moves the grid's middle elsewhere
    const VoxelGrid grid = VoxelGrid::build(scene, 0.3);
    double sum = 0;
    for (const VoxelSurface& surface : all_surfaces(scene, grid)) {
      if (surface.point.x > 1) continue;
      EXPECT_TRUE(surface.area == 0 || std::abs(surface.share - 1) < 1e-6);
      sum += surface.area;
    }
    // Voxels on the wall's outline hold less than the cube's section with its plane, so there a double sheet stays
    // double.
    const double s = grid.voxel_size();
    EXPECT_GE(sum, 1 - 1e-5);
    EXPECT_LE(sum, thickness > 0 ? 1 + 1e-5 : 1 + 4 * (1 + s) * s);
  }
}

TEST(VoxelSurfaces, DoNotDependOnWindingOrOnOtherVoxels) {
  SceneData scene;
  test::add_patch(scene, {0, 0, 0}, {1, 0.2, 0}, {0, 0.3, 1}, 6, 6);
  SceneData mixed = scene;
  for (std::size_t t = 0; t < mixed.triangles.size(); t += 2) std::swap(mixed.triangles[t][0], mixed.triangles[t][1]);
  const VoxelGrid grid = VoxelGrid::build(scene, 0.2);
  const auto all = all_surfaces(scene, grid), other = all_surfaces(mixed, grid);
  std::vector<std::uint32_t> some;
  for (std::uint32_t voxel_index = 1; voxel_index < grid.size(); voxel_index += 3) some.push_back(voxel_index);
  const auto few = voxel_surfaces(scene, grid, some);
  for (std::size_t k = 0; k < all.size(); ++k) {
    EXPECT_NEAR(all[k].area, other[k].area, 1e-7);
    EXPECT_NEAR(all[k].share, other[k].share, 1e-6);
    EXPECT_NEAR(all[k].point.x, other[k].point.x, 1e-6);
  }
  for (std::size_t k = 0; k < some.size(); ++k) {
    EXPECT_EQ(few[k].point, all[some[k]].point);
    EXPECT_EQ(few[k].normal, all[some[k]].normal);
    EXPECT_EQ(few[k].area, all[some[k]].area);
  }
}

}  // namespace
}  // namespace vantage
