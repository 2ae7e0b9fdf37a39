// SPDX-License-Identifier: Apache-2.0
#include "voxel/voxel_triangles.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "clipped_voxels.hpp"
#include "voxel_scenes.hpp"

namespace vantage {
namespace {

SceneData scene_with_blocking() {
  std::mt19937 rng(7);
  SceneData scene;
  const auto first = test::random_triangles(rng, 200, 5.0f, 0.6f);
  const auto blocking = test::random_triangles(rng, 100, 5.0f, 0.6f);
  const auto second = test::random_triangles(rng, 200, 5.0f, 0.2f);
  test::add_mesh(scene, first, test::separate_triangles(first.size()));
  test::add_mesh(scene, blocking, test::separate_triangles(blocking.size()), Role::blocking);
  test::add_mesh(scene, second, test::separate_triangles(second.size()));
  return scene;
}

// Lists of all voxels, by clipping each surveyed triangle against the cube.
std::vector<std::vector<std::uint32_t>> clipped_lists(const SceneData& scene, const VoxelGrid& grid,
                                                      std::span<const std::uint32_t> voxel_indices, double margin) {
  std::vector<std::vector<std::uint32_t>> lists;
  for (const std::uint32_t voxel_index : voxel_indices) {
    const auto cell = morton_decode(grid.key(voxel_index));
    std::array<double, 3> low, high;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = grid.min()[axis] + cell[axis] * grid.voxel_size() - margin;
      high[axis] = grid.min()[axis] + (cell[axis] + 1) * grid.voxel_size() + margin;
    }
    lists.emplace_back();
    for (std::size_t m = 0; m < scene.ranges.size(); ++m) {
      if (scene.meshes[m].role != Role::surveyed) continue;
      for (std::uint32_t t = scene.ranges[m].first_triangle;
           t < scene.ranges[m].first_triangle + scene.ranges[m].triangle_count; ++t) {
        test::Polygon<double> polygon;
        for (const std::uint32_t v : scene.triangles[t])
          polygon.push_back({scene.positions[v].x, scene.positions[v].y, scene.positions[v].z});
        if (test::touches_box(polygon, low, high)) lists.back().push_back(t);
      }
    }
  }
  return lists;
}

TEST(VoxelTriangles, EqualClippingForSparseAndDenseSamples) {
  const SceneData scene = scene_with_blocking();
  const VoxelGrid grid = VoxelGrid::build(scene, 0.1);
  for (const double margin : {0.0, 1e-5, 0.03, 0.25})
    for (const std::uint32_t stride : {1u, 20u, 100u}) {
      std::vector<std::uint32_t> voxel_indices;
      for (std::uint32_t r = stride / 2; r < grid.size(); r += stride * 7) voxel_indices.push_back(r);
      if (stride == 1) voxel_indices.resize(std::min<std::size_t>(voxel_indices.size(), grid.size() / 32 + 40));
      const VoxelTriangles found = triangles_touching(scene, grid, voxel_indices, margin);
      const auto expected = clipped_lists(scene, grid, voxel_indices, margin);
      ASSERT_EQ(found.offset.size(), voxel_indices.size() + 1);
      ASSERT_EQ(found.offset.back(), found.triangle.size());
      for (std::size_t i = 0; i < voxel_indices.size(); ++i) {
        const std::vector<std::uint32_t> list(found.triangle.begin() + found.offset[i],
                                              found.triangle.begin() + found.offset[i + 1]);
        ASSERT_EQ(list, expected[i]) << "voxel_index " << voxel_indices[i] << " margin " << margin;
        ASSERT_FALSE(list.empty());
      }
    }
}

TEST(VoxelTriangles, ListsOfAStretchEqualThoseOfAllVoxels) {
  const SceneData scene = scene_with_blocking();
  const VoxelGrid grid = VoxelGrid::build(scene, 0.02);
  std::vector<std::uint32_t> all(grid.size());
  std::iota(all.begin(), all.end(), 0u);
  for (const double margin : {0.0, 0.03}) {
    const VoxelTriangles of_all = triangles_touching(scene, grid, all, margin);
    for (std::uint32_t part = 0; part < 7; ++part) {
      const std::size_t first = part * grid.size() / 7, end = (part + 1) * grid.size() / 7;
      const VoxelTriangles found = triangles_touching(scene, grid, std::span(all).subspan(first, end - first), margin);
      ASSERT_EQ(found.offset.size(), end - first + 1);
      for (std::size_t i = first; i <= end; ++i)
        ASSERT_EQ(found.offset[i - first], of_all.offset[i] - of_all.offset[first]);
      EXPECT_TRUE(std::ranges::equal(found.triangle,
                                     std::span(of_all.triangle).subspan(of_all.offset[first], found.triangle.size())));
    }
  }
}

TEST(VoxelTriangles, SparseListsEqualThoseOfAllVoxels) {
  const SceneData scene = scene_with_blocking();
  const VoxelGrid grid = VoxelGrid::build(scene, 0.02);
  std::vector<std::uint32_t> all(grid.size()), some;
  std::iota(all.begin(), all.end(), 0u);
  for (std::uint32_t r = 3; r < grid.size(); r += 211) some.push_back(r);
  const VoxelTriangles of_all = triangles_touching(scene, grid, all, 0.004),
                       of_some = triangles_touching(scene, grid, some, 0.004);
  for (std::size_t i = 0; i < some.size(); ++i) {
    const auto a =
        std::span(of_all.triangle).subspan(of_all.offset[some[i]], of_all.offset[some[i] + 1] - of_all.offset[some[i]]);
    const auto b = std::span(of_some.triangle).subspan(of_some.offset[i], of_some.offset[i + 1] - of_some.offset[i]);
    ASSERT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
  }
}

// A series of samples; from the second on by lists of bricks, with margins that fit these and one that does not.
TEST(VoxelTriangles, OneSampleAfterAnotherFindsTheSame) {
  const auto scene = std::make_shared<const SceneData>(scene_with_blocking());
  for (const double size : {0.02, 0.1}) {
    const auto grid = std::make_shared<const VoxelGrid>(VoxelGrid::build(*scene, size));
    SampleTriangles triangles(scene, grid);
    for (const double margin : {0.004, 0.005, 0.0, 0.25, 0.01})
      for (std::uint32_t first : {3u, 3u, 40u, 117u}) {
        std::vector<std::uint32_t> voxel_indices;
        for (std::uint32_t r = first; r < grid->size(); r += 211) voxel_indices.push_back(r);
        const VoxelTriangles found = triangles.touching(voxel_indices, margin);
        const VoxelTriangles expected = triangles_touching(*scene, *grid, voxel_indices, margin);
        ASSERT_EQ(found.offset, expected.offset) << size << ' ' << margin << ' ' << first;
        ASSERT_EQ(found.triangle, expected.triangle) << size << ' ' << margin << ' ' << first;
      }
  }
}

TEST(VoxelTriangles, NoVoxelsGiveNoLists) {
  const SceneData scene = scene_with_blocking();
  const VoxelTriangles none = triangles_touching(scene, VoxelGrid::build(scene, 0.1), {}, 0.0);
  EXPECT_EQ(none.offset, std::vector<std::uint32_t>{0});
  EXPECT_TRUE(none.triangle.empty());
}

}  // namespace
}  // namespace vantage
