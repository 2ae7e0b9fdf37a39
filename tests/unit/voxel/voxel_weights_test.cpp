// SPDX-License-Identifier: Apache-2.0
#include "voxel/voxel_weights.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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

// By the lists of triangles of each voxel, which have a test of their own.
TEST(VoxelWeights, AreTheLargestOfTheMeshesThatTouch) {
  const SceneData scene =
      scene_of_weights({{Role::surveyed, 2}, {Role::blocking, 200}, {Role::surveyed, 9}, {Role::surveyed, 5}});
  const VoxelGrid grid = VoxelGrid::build(scene, 0.1);
  std::vector<std::uint32_t> ranks(grid.size());
  std::iota(ranks.begin(), ranks.end(), 0u);
  const VoxelTriangles touching = triangles_touching(scene, grid, ranks, 0);
  std::uint64_t sum = 0;
  std::vector<int> met(10);
  for (const std::uint32_t rank : ranks) {
    std::uint32_t expected = 0;
    for (std::uint32_t k = touching.offset[rank]; k < touching.offset[rank + 1]; ++k)
      expected = std::max(expected, scene.meshes[scene.mesh_of(touching.triangle[k])].weight);
    ASSERT_EQ(grid.weight(rank), expected) << "voxel " << rank;
    sum += expected;
    ++met[expected];
  }
  EXPECT_EQ(grid.total_weight(), sum);
  for (const int weight : {2, 5, 9}) EXPECT_GT(met[static_cast<std::size_t>(weight)], 100);
}

TEST(VoxelWeights, TakeNoMemoryWhereAllWeighAlike) {
  const SceneData scene = scene_of_weights({{Role::surveyed, 7}, {Role::blocking, 200}, {Role::surveyed, 7}});
  const VoxelGrid grid = VoxelGrid::build(scene, 0.1);
  EXPECT_TRUE(grid.weights().empty());
  EXPECT_EQ(grid.weight(3), 1u);
  EXPECT_EQ(grid.total_weight(), grid.size());
}

}  // namespace
}  // namespace vantage
