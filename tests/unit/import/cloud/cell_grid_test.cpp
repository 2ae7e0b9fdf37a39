// SPDX-License-Identifier: Apache-2.0
#include "import/cloud/cell_grid.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <tuple>

#include "import/cloud/plane.hpp"

namespace vantage::test {
namespace {

using importer::Cell;
using importer::CellGrid;
using importer::CellIndex;

TEST(CellGrid, CountsPointsWhereTheyAre) {
  CellGrid grid({1000, 2000, 3}, 0.05);
  std::map<std::tuple<int, int, int>, std::uint32_t> counts;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-3, 3);
  for (int k = 0; k < 50'000; ++k) {
    const Eigen::Vector3d p(1000 + place(random), 2000 + place(random), 3 + 0.01 * place(random));
    ASSERT_TRUE(grid.add(p, 0, Eigen::Vector3d::UnitZ()));
    const CellIndex at = grid.in_cells(p).array().floor().cast<int>();
    ++counts[{at.x(), at.y(), at.z()}];
  }
  ASSERT_EQ(grid.size(), counts.size());
  for (const auto& [at, count] : counts) {
    const CellIndex index(std::get<0>(at), std::get<1>(at), std::get<2>(at));
    const std::uint32_t k = grid.find(index);
    ASSERT_NE(k, CellGrid::kNone);
    EXPECT_EQ(grid[k].count, count);
    EXPECT_EQ(CellGrid::index_of(grid[k]), index);
  }
  EXPECT_EQ(grid.find({1000, 0, 0}), CellGrid::kNone);
  EXPECT_FALSE(grid.add({1e7, 0, 0}, 0, Eigen::Vector3d::Zero()));
}

TEST(CellGrid, KnowsWhichScanAloneSawACell) {
  CellGrid grid(Eigen::Vector3d::Zero(), 1);
  for (const std::uint16_t scan : {3, 3, 5}) grid.add({0.5, 0.5, 0.5}, scan, Eigen::Vector3d::Zero());
  grid.add({1.5, 0.5, 0.5}, 4, Eigen::Vector3d::Zero());
  EXPECT_EQ(grid[grid.find({0, 0, 0})].scan, Cell::kSeveralScans);
  EXPECT_EQ(grid[grid.find({1, 0, 0})].scan, 4);
}

TEST(CellGrid, NeighboursGiveThePlaneOfTheirPoints) {
  CellGrid grid({50, 0, 0}, 0.03);
  const Eigen::Vector3d normal = Eigen::Vector3d(0.2, -0.3, 0.9).normalized();
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-0.1, 0.1);
  std::normal_distribution<double> noise(0, 0.001);
  for (int k = 0; k < 20'000; ++k) {
    const double x = place(random), y = place(random);
    const double z = -(normal.x() * x + normal.y() * y) / normal.z();
    grid.add(Eigen::Vector3d(50 + x, y, z) + noise(random) * normal, 0, Eigen::Vector3d::Zero());
  }
  const std::uint32_t k = grid.find(grid.in_cells({50, 0, 0}).array().floor().cast<int>());
  ASSERT_NE(k, CellGrid::kNone);
  const auto plane = importer::plane_of(grid.around(k));
  EXPECT_GT(std::abs(plane.normal.dot(normal)), 0.9999);
  EXPECT_NEAR(plane.thickness, 0.001 / 0.03, 0.005);
}

}  // namespace
}  // namespace vantage::test
