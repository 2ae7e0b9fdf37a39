// SPDX-License-Identifier: Apache-2.0
// A wall on a voxel face would mark two layers and scatter its points over both.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "voxel/grid_fit.hpp"
#include "voxel/voxel_bricks.hpp"
#include "voxel/voxel_grid.hpp"
#include "voxel_scenes.hpp"

namespace vantage {
namespace {

constexpr int steps = 200;

float coordinate(const Float3& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }
float& coordinate(Float3& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

// Four fixed walls and a floor, with a wall between them, perpendicular to `axis` at `place`; its top leans by
// `tilt_m`.
SceneData room(int axis, double place, double tilt_m = 0, int cut = 1) {
  SceneData scene;
  test::add_patch(scene, {-5, -5, 0}, {10, 0, 0}, {0, 0, 5});
  test::add_patch(scene, {5, -5, 0}, {0, 10, 0}, {0, 0, 5});
  test::add_patch(scene, {5, 5, 0}, {-10, 0, 0}, {0, 0, 5});
  test::add_patch(scene, {-5, 5, 0}, {0, -10, 0}, {0, 0, 5});
  test::add_patch(scene, {-5, -5, 0}, {10, 0, 0}, {0, 10, 0});
  if (axis == 0) test::add_patch(scene, {place, -3.3, 0.7}, {0, 6.1, 0}, {tilt_m, 0, 3.2}, cut, cut);
  if (axis == 1) test::add_patch(scene, {-3.3, place, 0.7}, {6.1, 0, 0}, {0, tilt_m, 3.2}, cut, cut);
  if (axis == 2) test::add_patch(scene, {-3.3, -2.9, place}, {6.1, 0, 0}, {0, 5.2, tilt_m}, cut, cut);
  return scene;
}

// Layers of voxels that the last mesh alone marks.
std::set<std::uint32_t> layers_of_wall(const SceneData& scene, const VoxelGrid& grid, int axis) {
  const MeshRange& wall = scene.ranges.back();
  std::set<std::uint32_t> layers;
  for (const std::uint64_t key :
       voxelize(scene.positions,
                std::span<const Triangle>(scene.triangles).subspan(wall.first_triangle, wall.triangle_count),
                {grid.min()[0], grid.min()[1], grid.min()[2]}, grid.voxel_size(), grid.depth()))
    layers.insert(morton_decode(key)[axis]);
  return layers;
}

// Points on the last mesh as an engine would report them, off by 2 ulp or 1e-6 m along the axis, whichever is more.
void expect_points_in_layer(const SceneData& scene, const VoxelGrid& grid, int axis, std::uint32_t layer,
                            std::mt19937& rng) {
  std::uniform_real_distribution<double> unit(0, 1);
  const MeshRange& wall = scene.ranges.back();
  for (int i = 0; i < 60; ++i) {
    const Triangle& t = scene.triangles[wall.first_triangle + rng() % wall.triangle_count];
    double s = unit(rng), r = unit(rng);
    if (s + r > 1) s = 1 - s, r = 1 - r;
    Float3 p;
    for (int k = 0; k < 3; ++k)
      coordinate(p, k) =
          static_cast<float>((1 - s - r) * coordinate(scene.positions[t[0]], k) +
                             s * coordinate(scene.positions[t[1]], k) + r * coordinate(scene.positions[t[2]], k));
    for (const double off : {0.0, -1e-6, 1e-6, -2.0, 2.0}) {
      Float3 q = p;
      float& c = coordinate(q, axis);
      if (std::abs(off) > 1)
        for (int ulp = 0; ulp < 2; ++ulp) c = std::nextafter(c, static_cast<float>(off * 1e9));
      else
        c = static_cast<float>(c + off);
      ASSERT_NE(grid.index_of(q), kNoVoxel) << "axis " << axis << " at " << c;
      ASSERT_EQ((*grid.cell_of(q))[axis], layer) << "axis " << axis << " at " << c;
    }
  }
}

TEST(WallOnFace, SweptThroughAVoxelItMarksOneLayerAtEachStep) {
  std::mt19937 rng(17);
  for (int axis = 0; axis < 3; ++axis) {
    const VoxelGrid fixed = VoxelGrid::build(room(axis, 1.03), 0.1);
    const double size = fixed.voxel_size();
    // From one face of the centred grid to the next, inclusive.
    const double face = fixed.min()[axis] + size * std::ceil((1.0 - fixed.min()[axis]) / size);
    std::set<std::uint64_t> sizes;
    for (int step = 0; step <= steps; ++step) {
      const SceneData scene = room(axis, face + size * step / steps);
      const VoxelGrid grid = VoxelGrid::build(scene, 0.1);
      const auto layers = layers_of_wall(scene, grid, axis);
      ASSERT_EQ(layers.size(), 1u) << "axis " << axis << " step " << step;
      expect_points_in_layer(scene, grid, axis, *layers.begin(), rng);
    }
  }
}

TEST(WallOnFace, TiltBelowTheClearanceIsHandledToo) {
  std::mt19937 rng(19);
  for (const int cut : {1, 25})
    for (int axis = 0; axis < 3; ++axis) {
      const VoxelGrid fixed = VoxelGrid::build(room(axis, 1.03), 0.1);
      const double size = fixed.voxel_size(), tilt = face_clearance(5.01, size);
      const double face = fixed.min()[axis] + size * std::ceil((1.0 - fixed.min()[axis]) / size);
      for (int step = -20; step <= 20; ++step) {
        const SceneData scene = room(axis, face + 0.1 * tilt * step, tilt, cut);
        const VoxelGrid grid = VoxelGrid::build(scene, 0.1);
        const auto layers = layers_of_wall(scene, grid, axis);
        ASSERT_EQ(layers.size(), 1u) << "axis " << axis << " step " << step << " cut " << cut;
        expect_points_in_layer(scene, grid, axis, *layers.begin(), rng);
      }
    }
}

TEST(WallOnFace, GridStaysCentredWhereNoPlaneIsNearAFace) {
  const SceneData scene = room(0, 1.03);
  const VoxelGrid grid = VoxelGrid::build(scene, 0.1);
  EXPECT_NEAR(grid.min()[0], -5.01, 1e-6);
  EXPECT_NEAR(grid.min()[1], -5.01, 1e-6);
}

TEST(WallOnFace, MovesAsLittleAsItMust) {
  const double size = VoxelGrid::build(room(0, 1.03), 0.1).voxel_size();
  const SceneData scene = room(0, -5.01 + 80 * size);
  const VoxelGrid grid = VoxelGrid::build(scene, 0.1);
  const double clearance = face_clearance(5.01, size), moved = grid.min()[0] + 5.01;
  EXPECT_GT(std::abs(moved), clearance);
  EXPECT_LT(std::abs(moved), 1.5 * clearance);
  EXPECT_NEAR(grid.min()[1], -5.01, 1e-6);  // the other axes stay
}

// If planes are too close to clear all, the largest area is cleared.
TEST(WallOnFace, ClearsTheLargestAreaWhereNotAllCanBeCleared) {
  const double size = VoxelGrid::build(room(0, 1.03), 0.1).voxel_size();
  SceneData scene = room(0, 1.03);
  for (int k = 0; k < 2000; ++k)
    test::add_patch(scene, {-4.9 + size * (k % 100) + size * k / 2000.0, 1, 1}, {0, 0.01, 0}, {0, 0, 0.01});
  test::add_patch(scene, {-5.01 + 80 * size, -3.3, 0.7}, {0, 6.1, 0}, {0, 0, 3.2});
  const VoxelGrid grid = VoxelGrid::build(scene, 0.1);
  EXPECT_GT(std::abs(grid.min()[0] + 5.01), 1e-5);
  EXPECT_EQ(layers_of_wall(scene, grid, 0).size(), 1u);
}

TEST(WallOnFace, HandlesWallsFarFromTheOrigin) {
  std::mt19937 rng(23);
  const double size = VoxelGrid::build(room(0, 1.03), 0.1).voxel_size();
  for (int step = 0; step < 16; ++step) {
    SceneData scene = room(0, -5.01 + 80 * size + size * step / 16);
    for (Float3& p : scene.positions) p = {p.x + 1000, p.y - 2000, p.z + 30};
    scene.local_bounds = {};
    for (const Float3& p : scene.positions) scene.local_bounds.extend({p.x, p.y, p.z});
    const VoxelGrid grid = VoxelGrid::build(scene, 0.1);
    const auto layers = layers_of_wall(scene, grid, 0);
    ASSERT_EQ(layers.size(), 1u) << step;
    expect_points_in_layer(scene, grid, 0, *layers.begin(), rng);
  }
}

}  // namespace
}  // namespace vantage
