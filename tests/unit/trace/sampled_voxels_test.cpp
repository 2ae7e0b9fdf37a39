// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/sampled_voxels.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "support/trace_scenes.hpp"

namespace vantage {
namespace {

// The piece stored for the only triangle of a scene, in its voxel.
SampledVoxels::Piece piece_of(const std::array<Float3, 3>& corners) {
  const auto scene = test::SceneBuilder().mesh(Role::surveyed, {corners[0], corners[1], corners[2]}).finish();
  const auto grid = std::make_shared<const VoxelGrid>(VoxelGrid::build(*scene, 100));
  SampleTriangles triangles(scene, grid);
  const std::array<std::uint32_t, 1> voxel_indices{0};
  return SampledVoxels(*scene, *grid, triangles, voxel_indices, 1e-5, 0, 1e-4).piece(0);
}

// Uncertainty about a hit near an edge grows with the longest edge over that edge, whichever edge is the longest.
TEST(SampledVoxels, KnowTheEdgesOfEachTriangle) {
  const std::array<Float3, 3> corners{Float3{0, 0, 0}, Float3{4, 0, 0}, Float3{4, 3, 0}};
  for (std::size_t first = 0; first < 3; ++first) {
    const std::array<Float3, 3> turned{corners[first], corners[(first + 1) % 3], corners[(first + 2) % 3]};
    const SampledVoxels::Piece piece = piece_of(turned);
    const double lengths[] = {4, 3, 5};
    EXPECT_FLOAT_EQ(piece.longest, 5) << first;
    EXPECT_GE(piece.longest, 5.0f);
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = lengths[(first + k) % 3];
      EXPECT_FLOAT_EQ(piece.edge[k].ratio, static_cast<float>(5 / length)) << first << ' ' << k;
      const Float3& inwards = piece.edge[k].inwards;
      EXPECT_NEAR(std::hypot(inwards.x, inwards.y, inwards.z), 1, 1e-6);
      // The triangle's middle lies inside all three edges, at a third of the height over that edge.
      EXPECT_NEAR(inwards.x * (8.0 / 3 - turned[k].x) + inwards.y * (1 - turned[k].y), 12 / length / 3, 1e-5);
    }
  }
}

}  // namespace
}  // namespace vantage
