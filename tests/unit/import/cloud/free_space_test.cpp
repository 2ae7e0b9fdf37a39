// SPDX-License-Identifier: Apache-2.0
#include "import/cloud/free_space.hpp"

#include <gtest/gtest.h>

#include "import/cloud/flat_regions.hpp"

namespace vantage::test {
namespace {

using importer::CellGrid;
using importer::FreeSpace;

// A square of points at x, from y = -0.25 to 0.25 and z = 0.75 to 1.25, seen by one scan.
void add_square(CellGrid& grid, double x, std::uint16_t scan) {
  for (int a = 0; a < 50; ++a)
    for (int b = 0; b < 50; ++b) grid.add({x, -0.245 + 0.01 * a, 0.755 + 0.01 * b}, scan, {-1, 0, 0});
}

TEST(FreeSpace, DropsWhatAnotherScanSawThrough) {
  CellGrid grid(Eigen::Vector3d::Zero(), 0.05);
  add_square(grid, 2.01, 0);  // somebody who stood there during the first scan
  add_square(grid, 4.01, 1);  // the wall behind
  const auto planes = importer::cell_planes(grid);
  FreeSpace free(grid, planes);
  const auto look = [&](const Eigen::Vector3d& from, double x, std::uint16_t scan) {
    for (int a = 0; a < 50; ++a)
      for (int b = 0; b < 50; ++b)
        free.add_ray(grid.in_cells(from), grid.in_cells({x, -0.245 + 0.01 * a, 0.755 + 0.01 * b}), scan);
  };
  look({0, 0, 1}, 2.01, 0);
  EXPECT_EQ(importer::drop_seen_through(grid), 0u);
  look({0, 0, 1}, 4.01, 1);
  const std::uint32_t before = grid.size();
  const std::uint32_t dropped = importer::drop_seen_through(grid);
  EXPECT_GT(dropped, 20u);
  for (std::uint32_t k = 0; k < before; ++k) {
    const bool wall = CellGrid::index_of(grid[k]).x() > 60;
    EXPECT_TRUE(!wall || grid[k].kept);
  }
  EXPECT_TRUE(free.known(grid.in_cells({3, 0, 1})));
  EXPECT_TRUE(free.known(grid.in_cells({4.01, 0, 1})));
  EXPECT_FALSE(free.known(grid.in_cells({5, 0, 1})));
  EXPECT_FALSE(free.known(grid.in_cells({3, 2, 1})));
}

TEST(FreeSpace, RaysAlongASurfaceDoNotDropIt) {
  CellGrid grid(Eigen::Vector3d::Zero(), 0.05);
  for (int a = 0; a < 400; ++a)
    for (int b = 0; b < 20; ++b) grid.add({0.01 * a, 0.01 * b, 0.02}, 0, Eigen::Vector3d::UnitZ());
  const auto planes = importer::cell_planes(grid);
  FreeSpace free(grid, planes);
  for (int k = 0; k < 100; ++k)  // slightly down, through the floor's cells
    free.add_ray(grid.in_cells({-1, 0.1, 0.06}), grid.in_cells({4, 0.1, 0.0001 * k}), 1);
  EXPECT_EQ(importer::drop_seen_through(grid), 0u);
}

TEST(FreeSpace, RaysFromFarAwayAreFollowedNearTheCloudAlone) {
  CellGrid grid(Eigen::Vector3d::Zero(), 0.05);
  add_square(grid, 2.01, 0);
  const auto planes = importer::cell_planes(grid);
  FreeSpace free(grid, planes);
  for (int k = 0; k < 1000; ++k)
    free.add_ray(grid.in_cells({-10'000, static_cast<double>(k), 1}), grid.in_cells({2.01, 0, 1}), 0);
  EXPECT_TRUE(free.known(grid.in_cells({0, 0, 1})));
  EXPECT_FALSE(free.known(grid.in_cells({-100, 0, 1})));
}

TEST(FreeSpace, SeveralScansOrTheSameProveACell) {
  CellGrid grid(Eigen::Vector3d::Zero(), 0.05);
  add_square(grid, 2.01, 0), add_square(grid, 2.01, 1);
  const auto planes = importer::cell_planes(grid);
  FreeSpace free(grid, planes);
  for (int k = 0; k < 10; ++k) free.add_ray(grid.in_cells({0, 0, 1}), grid.in_cells({4, 0.01 * k, 1}), 2);
  EXPECT_EQ(importer::drop_seen_through(grid), 0u);
}

}  // namespace
}  // namespace vantage::test
