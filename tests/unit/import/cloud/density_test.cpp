// SPDX-License-Identifier: Apache-2.0
#include "import/cloud/density.hpp"

#include <random>

#include "cloud_files.hpp"

namespace vantage::test {
namespace {

using importer::choose_cell;
using importer::Density;

// A floor of so many points a square metre.
Density floor_of(double per_m2, double side_m = 5) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0, side_m);
  Density density;
  for (int k = 0; k < per_m2 * side_m * side_m; ++k) density.add({place(random), place(random), 0.011});
  return density;
}

TEST(Density, CellsHoldEnoughPoints) {
  constexpr double kMuch = 1e12;
  // 6.67 points to a square centimetre of the cell's face: 0.02 m hold 6 at 16 700 a square metre.
  for (const auto& [per_m2, cell_m] : {std::pair{20'000.0, 0.02}, {9000.0, 0.03}, {3000.0, 0.05}, {100.0, 0.3}})
    EXPECT_EQ(Density::kSizes_m[choose_cell(floor_of(per_m2), kMuch, 100)], cell_m) << per_m2;
  expect_refused_for("too thin", [&] { choose_cell(floor_of(5, 15), kMuch, 100); });
}

TEST(Density, CellsAreCountedOnASampleOfThem) {
  const Density density = floor_of(20'000);
  EXPECT_NEAR(density.cells(0), 62'500, 0.05 * 62'500);  // of 2 cm
  EXPECT_NEAR(density.cells(4), 10'000, 0.05 * 10'000);  // of 5 cm
  EXPECT_NEAR(density.median(4), 50, 3);
}

TEST(Density, LittleMemoryTakesLargerCells) {
  const Density density = floor_of(20'000);
  EXPECT_EQ(Density::kSizes_m[choose_cell(density, 12'500 * 100.0, 100)], 0.05);
  expect_refused_for("more memory", [&] { choose_cell(density, 100, 100); });
}

TEST(Density, MiddleIgnoresSinglePointsFarAway) {
  Density density = floor_of(400);
  for (int k = 0; k < 10; ++k) density.add({1e8, 1e8, 1e8});
  density.add({1e30, 0, 0});
  EXPECT_LE((density.middle() - Eigen::Vector3d(2.5, 2.5, 0)).norm(), 1);
  EXPECT_EQ(density.points(), 10'010u);
}

}  // namespace
}  // namespace vantage::test
