// SPDX-License-Identifier: Apache-2.0
#include "voxel/voxel_grid.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "clipped_voxels.hpp"
#include "vantage/error.hpp"
#include "voxel_scenes.hpp"

namespace vantage {
namespace {

SceneData four_walls() {
  SceneData scene;
  for (const auto& [corner, along] : {std::pair{Vec3{-5, -5, 0}, Vec3{10, 0, 0}},
                                      {Vec3{5, -5, 0}, Vec3{0, 10, 0}},
                                      {Vec3{5, 5, 0}, Vec3{-10, 0, 0}},
                                      {Vec3{-5, 5, 0}, Vec3{0, -10, 0}}})
    test::add_patch(scene, corner, along, {0, 0, 5}, 10, 5);
  return scene;
}

SceneData random_scene(unsigned seed) {
  std::mt19937 rng(seed);
  SceneData scene;
  const auto positions = test::random_triangles(rng, 300, 5.0f, 0.6f);
  test::add_mesh(scene, positions, test::separate_triangles(positions.size()));
  return scene;
}

TEST(VoxelGrid, FourWallsHaveTheGoalDensityOfTheMethod) {
  const VoxelGrid grid = VoxelGrid::build(four_walls(), 0.1);
  EXPECT_EQ(grid.depth(), 7);
  EXPECT_NEAR(grid.voxel_size(), 10.02 / 128, 1e-8);
  EXPECT_NEAR(grid.voxel_size() * grid.voxel_size() / 1e-4, 61.3, 0.1);
  EXPECT_NEAR(grid.min()[0], -5.01, 1e-6);  // centred: no wall is near a face
  EXPECT_NEAR(grid.min()[1], -5.01, 1e-6);
  EXPECT_NEAR(grid.min()[2], -2.51, 1e-6);
}

TEST(VoxelGrid, CountsWhatClippingCounts) {
  for (const SceneData& scene : {four_walls(), random_scene(1), random_scene(2)}) {
    const VoxelGrid grid = VoxelGrid::build(scene, 0.1);
    const auto expected =
        test::clipped_voxels(scene.positions, scene.triangles, {grid.min()[0], grid.min()[1], grid.min()[2]},
                             grid.voxel_size(), grid.depth());
    EXPECT_EQ(grid.size(), expected.size());
    for (const auto& c : expected) EXPECT_NE(grid.find(morton_encode(c[0], c[1], c[2])), kNoVoxel);
  }
}

TEST(VoxelGrid, RanksFollowTheKeysThereAndBack) {
  const VoxelGrid grid = VoxelGrid::build(random_scene(3), 0.05);
  ASSERT_GT(grid.size(), 1000u);
  std::uint64_t previous = 0;
  for (std::uint64_t voxel_index = 0; voxel_index < grid.size(); ++voxel_index) {
    const std::uint64_t key = grid.key(voxel_index);
    ASSERT_TRUE(voxel_index == 0 || previous < key);
    ASSERT_EQ(grid.find(key), voxel_index);
    previous = key;
  }
}

TEST(VoxelGrid, FindsNothingWhereNothingIsMarked) {
  const VoxelGrid grid = VoxelGrid::build(four_walls(), 1.0);
  std::uint64_t found = 0;
  const std::uint32_t n = 1u << grid.depth();
  for (std::uint64_t key = 0; key < std::uint64_t{n} * n * n; ++key) found += grid.find(key) != kNoVoxel;
  EXPECT_EQ(found, grid.size());
  EXPECT_EQ(grid.find(morton_encode(1u << 17, 3, 3)), kNoVoxel);
}

TEST(VoxelGrid, HashTableIsAsTheShadersExpect) {
  const VoxelGrid grid = VoxelGrid::build(random_scene(4), 0.02);
  EXPECT_TRUE(std::has_single_bit(grid.slots().size()));
  EXPECT_LE(2 * grid.bricks().size(), grid.slots().size());
  std::uint32_t first = 0;
  for (std::uint32_t b = 0; b < grid.bricks().size(); ++b) {
    const VoxelBrick& brick = grid.bricks()[b];
    EXPECT_EQ(brick.first, first);
    for (const std::uint32_t word : brick.mask) first += static_cast<std::uint32_t>(std::popcount(word));
    std::size_t slot = brick_hash(brick.x, brick.y, brick.z) & (grid.slots().size() - 1);
    while (grid.slots()[slot].brick != b) {
      ASSERT_NE(grid.slots()[slot].brick, empty_slot);
      slot = (slot + 1) & (grid.slots().size() - 1);
    }
  }
  EXPECT_EQ(first, grid.size());
}

RC_GTEST_PROP(VoxelGrid, KeepsEquationTwoAndHoldsWhatIsSurveyed, ()) {
  const double scale = std::pow(10.0, *rc::gen::inRange(-3, 4));
  const auto real = [](int low, int high) { return *rc::gen::inRange(low * 1000, high * 1000) / 1000.0; };
  const double user = scale * (0.01 + real(0, 3));
  SceneData scene;
  test::add_patch(scene, Vec3{real(-9, 9), real(-9, 9), real(-9, 9)} * scale,
                  Vec3{0.7 + real(0, 9), real(0, 9), 0} * scale, Vec3{0, real(0, 5), 0.3 + real(0, 5)} * scale);
  const VoxelGrid grid = VoxelGrid::build(scene, user);
  const Vec3 size = scene.local_bounds.size();
  const double extent = std::max({size.x, size.y, size.z}), side = std::ldexp(grid.voxel_size(), grid.depth());
  RC_ASSERT(grid.voxel_size() <= user);
  RC_ASSERT(grid.depth() == 0 || 2 * grid.voxel_size() > user * (1 - 1e-6));
  RC_ASSERT(std::abs(side / extent - 1.002) < 1e-6);
  RC_ASSERT(1.0 / grid.inverse_size() == grid.voxel_size());
  const auto& min = grid.min();
  RC_ASSERT(min[0] < scene.local_bounds.min.x && min[1] < scene.local_bounds.min.y &&
            min[2] < scene.local_bounds.min.z);
  RC_ASSERT(min[0] + side > scene.local_bounds.max.x && min[1] + side > scene.local_bounds.max.y &&
            min[2] + side > scene.local_bounds.max.z);
  for (const Float3& p : scene.positions) RC_ASSERT(grid.index_of(p) != kNoVoxel);
}

TEST(VoxelGrid, CellsAreHalfOpenAndOutsideIsEmpty) {
  const VoxelGrid grid = VoxelGrid::build(four_walls(), 0.1);
  const auto& m = grid.min();
  EXPECT_EQ(grid.cell_of({m[0], m[1], m[2]}), (std::array<std::uint32_t, 3>{0, 0, 0}));
  EXPECT_FALSE(grid.cell_of({std::nextafter(m[0], -100.0f), m[1], m[2]}));
  EXPECT_FALSE(grid.cell_of({m[0] + 10.03f, m[1], m[2]}));
  EXPECT_FALSE(grid.cell_of({NAN, 0, 0}));
  EXPECT_FALSE(grid.cell_of({0, INFINITY, 0}));
  EXPECT_EQ(grid.index_of({0, 0, 2}), kNoVoxel);  // inside the cube, but on no surface
}

TEST(VoxelGrid, OnlySurveyedMeshesMark) {
  SceneData scene = four_walls();
  const VoxelGrid alone = VoxelGrid::build(scene, 0.1);
  test::add_patch(scene, {-20, -20, 0}, {40, 0, 0}, {0, 40, 0}, 4, 4, Role::blocking);
  const VoxelGrid with_ground = VoxelGrid::build(scene, 0.1);
  EXPECT_EQ(alone.size(), with_ground.size());
  EXPECT_EQ(alone.min(), with_ground.min());
}

TEST(VoxelGrid, ASceneWithoutSurveyedMeshesHasNoVoxels) {
  SceneData scene;
  test::add_patch(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, 1, Role::blocking);
  const VoxelGrid grid = VoxelGrid::build(scene, 0.1);
  EXPECT_EQ(grid.size(), 0u);
  EXPECT_EQ(grid.index_of({0.5f, 0.5f, 0}), kNoVoxel);
}

TEST(VoxelGrid, RefusesSizesThatMakeNoSense) {
  for (const double size : {0.0, -1.0, std::nan(""), HUGE_VAL, 1e-5}) {
    try {
      VoxelGrid::build(four_walls(), size);
      FAIL() << size;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), Errc::invalid_argument);
      EXPECT_NE(std::string(e.what()).find("user size"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace vantage
