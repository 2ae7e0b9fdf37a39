// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/voxel_lookup.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "support/trace_scenes.hpp"

namespace vantage {
namespace {

TEST(VoxelLookup, IsRankOfForEveryPoint) {
  RandomStream random(21);
  std::vector<Float3> corners;
  for (int k = 0; k < 600; ++k)
    corners.push_back({test::between(random, -3, 3), test::between(random, -2, 2), test::between(random, 0, 1.5)});
  const auto scene = test::SceneBuilder().mesh(Role::surveyed, corners).finish();
  for (const double size : {3.0, 0.31, 0.04}) {
    const VoxelGrid grid = VoxelGrid::build(*scene, size);
    const BrickPrefixes prefixes(grid);
    VoxelLookup lookup(grid, prefixes);
    std::size_t found = 0;
    for (int run = 0; run < 100; ++run) {
      lookup.clear();
      std::array<std::uint32_t, VoxelLookup::kCapacity> voxel_of;
      std::vector<std::uint32_t> expected, voxel_indices;
      const Float3 centre{test::between(random, -3.3, 3.3), test::between(random, -2.3, 2.3),
                          test::between(random, -0.3, 1.8)};
      const double spread = run % 3 == 0 ? 8 : 0.2;
      for (std::uint32_t k = 0; k < VoxelLookup::kCapacity; ++k) {
        Float3 p{centre.x + test::between(random, -spread, spread), centre.y + test::between(random, -spread, spread),
                 centre.z + test::between(random, -spread, spread)};
        if (k % 50 == 7) p.x = std::numeric_limits<float>::quiet_NaN();
        if (k % 50 == 8) p.y = -std::numeric_limits<float>::infinity();
        if (k % 50 == 9) p.z = 3e38f;
        if (k % 50 == 10) p = {grid.min()[0], grid.min()[1], grid.min()[2]};
        lookup.add(p);
        voxel_of[k] = grid.index_of(p);
        if (voxel_of[k] != kNoVoxel) expected.push_back(voxel_of[k]);
      }
      lookup.each_run([&](std::uint32_t voxel_index, std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t k = begin; k < end; ++k) ASSERT_EQ(voxel_index, voxel_of[k]);
        voxel_indices.insert(voxel_indices.end(), end - begin, voxel_index);
      });
      ASSERT_EQ(voxel_indices, expected);
      found += voxel_indices.size();
    }
    EXPECT_GT(found, 300u);
  }
}

}  // namespace
}  // namespace vantage
