// SPDX-License-Identifier: Apache-2.0
#include "voxel/voxel_demands.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "voxel/voxel_triangles.hpp"
#include "voxel_scenes.hpp"

namespace vantage {
namespace {

SceneData scene_of_weights(const std::vector<std::pair<Role, std::uint32_t>>& meshes) {
  std::mt19937 rng(11);
  SceneData scene;
  for (const auto& [role, weight] : meshes) {
    const auto positions = test::random_triangles(rng, 150, 2.0f, 0.5f);
    test::add_mesh(scene, positions, test::separate_triangles(positions.size()), role);
    scene.meshes.back().weight = weight;
  }
  return scene;
}

// Compares with each voxel's list of triangles, which has its own test.
TEST(VoxelWeights, AreTheLargestOfTheMeshesThatTouch) {
  const SceneData scene =
      scene_of_weights({{Role::surveyed, 2}, {Role::blocking, 200}, {Role::surveyed, 9}, {Role::surveyed, 5}});
  const VoxelGrid grid = VoxelGrid::build(scene, 0.1);
  std::vector<std::uint32_t> voxel_indices(grid.size());
  std::iota(voxel_indices.begin(), voxel_indices.end(), 0u);
  const VoxelTriangles touching = triangles_touching(scene, grid, voxel_indices, 0);
  std::uint64_t sum = 0;
  std::vector<int> met(10);
  for (const std::uint32_t voxel_index : voxel_indices) {
    std::uint32_t expected = 0;
    for (std::uint32_t k = touching.offset[voxel_index]; k < touching.offset[voxel_index + 1]; ++k)
      expected = std::max(expected, scene.meshes[scene.mesh_of(touching.triangle[k])].weight);
    ASSERT_EQ(grid.demands().weight(voxel_index), expected) << "voxel " << voxel_index;
    sum += expected;
    ++met[expected];
  }
  EXPECT_EQ(grid.total_weight(), sum);
  for (const int weight : {2, 5, 9}) EXPECT_GT(met[static_cast<std::size_t>(weight)], 100);
}

TEST(VoxelWeights, TakeNoMemoryWhereAllWeighAlike) {
  const SceneData scene = scene_of_weights({{Role::surveyed, 7}, {Role::blocking, 200}, {Role::surveyed, 7}});
  const VoxelGrid grid = VoxelGrid::build(scene, 0.1);
  EXPECT_TRUE(grid.demands().weights.empty());
  EXPECT_EQ(grid.demands().weight(3), 1u);
  EXPECT_EQ(grid.total_weight(), grid.size());
}

// Each voxel takes the finest spacing of the surveyed meshes in its list, and at least one point.
TEST(PointWorths, AreThoseOfTheFinestMeshThatTouches) {
  const SceneData scene =
      scene_of_weights({{Role::surveyed, 1}, {Role::blocking, 1}, {Role::surveyed, 1}, {Role::surveyed, 1}});
  const VoxelGrid grid = VoxelGrid::build(scene, 0.1);
  const std::vector<double> spacings{0.03, 0.001, 0.008, 5};
  const auto weights_of_points = point_weights(scene, grid, spacings, {});
  ASSERT_TRUE(weights_of_points);
  ASSERT_EQ(weights_of_points->size(), grid.size());
  std::vector<std::uint32_t> voxel_indices(grid.size());
  std::iota(voxel_indices.begin(), voxel_indices.end(), 0u);
  const VoxelTriangles touching = triangles_touching(scene, grid, voxel_indices, 0);
  const double densest = std::pow(grid.voxel_size() / 0.008, 2);
  std::array<int, 3> met{};
  for (const std::uint32_t voxel_index : voxel_indices) {
    double finest = 5;
    for (std::uint32_t k = touching.offset[voxel_index]; k < touching.offset[voxel_index + 1]; ++k)
      if (const std::uint32_t mesh = scene.mesh_of(touching.triangle[k]); scene.meshes[mesh].role == Role::surveyed)
        finest = std::min(finest, spacings[mesh]);
    const double goal = std::max(std::pow(grid.voxel_size() / finest, 2), 1.0);
    const double told = densest * kDensestPointWeight / (*weights_of_points)[voxel_index];
    ASSERT_LE(told, goal * (1 + 1e-12)) << "voxel " << voxel_index;
    ASSERT_GE(told, goal * (1 - 1.0 / kDensestPointWeight)) << "voxel " << voxel_index;
    ++met[finest == 0.008 ? 0 : finest == 0.03 ? 1 : 2];
  }
  for (const int count : met) EXPECT_GT(count, 100);
}

TEST(PointWorths, TakeNoMemoryWhereAllWantTheSame) {
  const SceneData scene = scene_of_weights({{Role::surveyed, 1}, {Role::blocking, 1}, {Role::surveyed, 1}});
  const VoxelGrid grid = VoxelGrid::build(scene, 0.1);
  EXPECT_TRUE(point_weights(scene, grid, std::vector{0.01, 0.5, 0.01}, {})->empty());
  EXPECT_EQ(grid.demands().point_weight(3), 1u);
  EXPECT_EQ(grid.demands().least_point_weight(), 1u);
}

TEST(PointWorths, AreThoseOfASample) {
  const VoxelDemands demands{.weights = {1, 2, 3, 4}, .point_weights = {10, 20, 30, 40}};
  const VoxelDemands some = demands.of(std::vector<std::uint32_t>{1, 3});
  EXPECT_EQ(some.weights, (std::vector<std::uint8_t>{2, 4}));
  EXPECT_EQ(some.point_weights, (std::vector<std::uint32_t>{20, 40}));
  EXPECT_TRUE(VoxelDemands().of(std::vector<std::uint32_t>{7}).point_weights.empty());
}

}  // namespace
}  // namespace vantage
