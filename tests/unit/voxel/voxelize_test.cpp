// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <random>

#include "clipped_voxels.hpp"
#include "voxel/triangle_cells.hpp"
#include "voxel/voxel_grid.hpp"
#include "voxel_scenes.hpp"

namespace vantage {
namespace {

std::vector<std::uint64_t> clipped_keys(std::span<const Float3> positions, std::span<const Triangle> triangles,
                                        const std::array<double, 3>& min, double size, int depth) {
  std::vector<std::uint64_t> keys;
  for (const auto& c : test::clipped_voxels(positions, triangles, min, size, depth))
    keys.push_back(morton_encode(c[0], c[1], c[2]));
  std::sort(keys.begin(), keys.end());
  return keys;
}

TEST(Voxelize, EqualsClippingOnRandomTriangles) {
  std::mt19937 rng(11);
  for (const auto& [depth, size, count] :
       {std::tuple{1, 0.9f, 40}, {2, 0.3f, 100}, {4, 0.7f, 60}, {6, 0.2f, 200}, {6, 0.95f, 20}, {9, 0.02f, 200}}) {
    const auto positions = test::random_triangles(rng, count, 1.0f, size);
    const auto triangles = test::separate_triangles(positions.size());
    const std::array<double, 3> min{-1.0013, -1.0007, -1.0021};
    const double voxel = 2.0037 / (1 << depth);
    EXPECT_EQ(voxelize(positions, triangles, min, voxel, depth), clipped_keys(positions, triangles, min, voxel, depth))
        << depth << ' ' << size;
  }
}

// Corners at quarters of a voxel touch many faces, edges and corners exactly.
RC_GTEST_PROP(Voxelize, EqualsClippingInFractionsWhereTrianglesTouchFacesEdgesAndCorners, ()) {
  constexpr int n = 8;
  std::vector<Float3> positions;
  test::Polygon<test::Fraction> polygon;
  for (int i = 0; i < 3; ++i) {
    std::array<int, 3> quarters;
    for (int& q : quarters) q = *rc::gen::inRange(0, 4 * n + 1);
    positions.push_back({static_cast<float>(quarters[0]) / 4, static_cast<float>(quarters[1]) / 4,
                         static_cast<float>(quarters[2]) / 4});
    polygon.push_back({test::Fraction(quarters[0], 4), test::Fraction(quarters[1], 4), test::Fraction(quarters[2], 4)});
  }
  std::vector<std::uint64_t> expected;
  for (std::uint32_t x = 0; x < n; ++x)
    for (std::uint32_t y = 0; y < n; ++y)
      for (std::uint32_t z = 0; z < n; ++z)
        if (test::touches_box<test::Fraction>(polygon, {x, y, z}, {x + 1, y + 1, z + 1}))
          expected.push_back(morton_encode(x, y, z));
  std::sort(expected.begin(), expected.end());
  RC_ASSERT(voxelize(positions, std::vector<Triangle>{{0, 1, 2}}, {0, 0, 0}, 1.0, 3) == expected);
}

TEST(Voxelize, MarksBothSidesOfAFaceAndAllAroundACorner) {
  const std::vector<Float3> positions{{4, 1.25f, 1.25f}, {4, 1.75f, 1.25f}, {4, 1.25f, 1.75f},
                                      {2, 2, 2},         {2, 2, 2},         {2, 2, 2}};
  EXPECT_EQ(voxelize(positions, std::vector<Triangle>{{0, 1, 2}}, {0, 0, 0}, 1.0, 3).size(), 2u);
  EXPECT_EQ(voxelize(positions, std::vector<Triangle>{{3, 4, 5}}, {0, 0, 0}, 1.0, 3).size(), 8u);
}

TEST(Voxelize, LeavesOutWhatLiesOutsideTheCube) {
  const std::vector<Float3> positions{{-5, 0.5f, 0.5f}, {20, 0.5f, 0.5f}, {20, 0.6f, 0.5f},
                                      {-3, -3, -3},     {-2, -3, -3},     {-3, -2, -3}};
  EXPECT_EQ(voxelize(positions, std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}}, {0, 0, 0}, 1.0, 3).size(), 8u);
}

TEST(Voxelize, DoesNotDependOnTheNumberOfThreads) {
  std::mt19937 rng(5);
  const auto positions = test::random_triangles(rng, 20000, 1.0f, 0.05f);
  const auto triangles = test::separate_triangles(positions.size());
  const auto all = voxelize(positions, triangles, {-1, -1, -1}, 2.0 / 512, 9);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(voxelize(positions, triangles, {-1, -1, -1}, 2.0 / 512, 9), all);
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
}

// A whole wall at full depth: the number of columns is that of cells, each with one or two voxels.
TEST(Voxelize, CountsALargeInclinedTriangle) {
  const int n = 2048;
  const std::vector<Float3> positions{{0, 0, 3.5f}, {2048, 0, 3.5f}, {2048, 2048, 3.5f}, {0, 2048, 3.5f}};
  const auto keys = voxelize(positions, std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}, {0, 0, 0}, 1.0, 11);
  EXPECT_EQ(keys.size(), std::size_t{n} * n);
}

TEST(TriangleCells, WidenedCellsEqualClipping) {
  std::mt19937 rng(3);
  for (const double margin : {0.0, 0.01, 0.6, 2.25}) {
    const auto positions = test::random_triangles(rng, 60, 8.0f, 3.0f);
    for (const Triangle& t : test::separate_triangles(positions.size())) {
      std::array<TriangleCells::Point, 3> corners;
      for (int c = 0; c < 3; ++c)
        corners[c] = {positions[t[c]].x + 8.0, positions[t[c]].y + 8.0, positions[t[c]].z + 8.0};
      const TriangleCells cells(corners, 16, margin);
      std::set<std::array<std::uint32_t, 3>> walked;
      cells.for_each([&](const TriangleCells::Cell& c) {
        EXPECT_TRUE(walked.insert({std::uint32_t(c[0]), std::uint32_t(c[1]), std::uint32_t(c[2])}).second);
      });
      EXPECT_EQ(walked, test::clipped_voxels(positions, std::span(&t, 1), {-8, -8, -8}, 1.0, 4, margin));
      const TriangleCells::Cell low{5, 3, 7}, high{12, 8, 7};
      std::size_t within = 0;
      for (const auto& c : walked) {
        bool in = true;
        for (std::size_t axis = 0; axis < 3; ++axis) in = in && c[axis] >= low[axis] && c[axis] <= high[axis];
        within += in;
      }
      cells.for_each_within(low, high, [&](const TriangleCells::Cell& c) {
        EXPECT_TRUE(walked.contains({std::uint32_t(c[0]), std::uint32_t(c[1]), std::uint32_t(c[2])}));
        --within;
      });
      EXPECT_EQ(within, 0u);
      for (int x = 0; x < 16; ++x)
        for (int y = 0; y < 16; ++y)
          for (int z = 0; z < 16; ++z)
            ASSERT_EQ(cells.touches({x, y, z}),
                      walked.contains({std::uint32_t(x), std::uint32_t(y), std::uint32_t(z)}));
    }
  }
}

}  // namespace
}  // namespace vantage
