// SPDX-License-Identifier: Apache-2.0
#include "report/coverage_cells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "support/quad_scene.hpp"

namespace vantage {
namespace {

struct Surveyed {
  Scene scene = test::wall_and_floor({1000, 2000, 50}).scene();
  Simulator simulator{
      scene, test::coarse_scanner(), {.engine = Engine::embree, .user_size_m = 0.2, .point_spacing_m = 0.1}};
};

TEST(CoverageCells, HoldEverySampledVoxelInItsCube) {
  Surveyed site;
  for (const std::size_t most : {100'000u, 60u, 7u}) {
    const CoverageCells cells = coverage_cells(site.simulator, 100'000, most);
    ASSERT_EQ(cells.voxels.size(), site.simulator.voxel_count());
    EXPECT_LE(cells.keys.size(), most);
    EXPECT_NEAR(std::remainder(cells.size_m, site.simulator.voxel_size_m()), 0, 1e-9);
    for (std::size_t i = 0; i < cells.voxels.size(); ++i) {
      const Vec3 p = site.simulator.voxel_centre(cells.voxels[i]) - site.simulator.origin() - cells.corner;
      const std::uint32_t key = cells.keys[cells.cell_of[i]];
      EXPECT_EQ(static_cast<std::uint32_t>(std::floor(p.x / cells.size_m)), key & 2047);
      EXPECT_EQ(static_cast<std::uint32_t>(std::floor(p.y / cells.size_m)), key >> 11 & 2047);
      EXPECT_EQ(static_cast<std::uint32_t>(std::floor(p.z / cells.size_m)), key >> 22);
    }
  }
  EXPECT_EQ(coverage_cells(site.simulator, 100'000, 100'000).keys.size(), site.simulator.voxel_count());
}

TEST(CoverageCells, ColoursAreMeansOfTheirVoxels) {
  Surveyed site;
  const CoverageCells cells = coverage_cells(site.simulator, 100'000, 60);
  const double goal = site.simulator.goal_density();
  std::vector<std::uint32_t> counts;  // up to nearly twice the goal
  std::vector<Seer> seen_by;
  for (std::size_t i = 0; i < cells.voxels.size(); ++i) {
    counts.push_back(static_cast<std::uint32_t>(static_cast<double>(i * 7 % 11) / 6 * goal));
    seen_by.push_back(counts.back() == 0 ? 0 : i % 5 == 0 ? kSeveralStations : 3);
  }
  const CellColours colours = cell_colours(cells, cells.voxels, counts, seen_by, site.simulator);
  ASSERT_EQ(colours.coverage.size(), cells.keys.size());
  for (std::uint32_t c = 0; c < cells.keys.size(); ++c) {
    double sum = 0, voxels = 0;
    bool third = false, several = false;
    for (std::size_t i = 0; i < cells.voxels.size(); ++i)
      if (cells.cell_of[i] == c)
        sum += std::min(counts[i] / goal, 1.0), ++voxels, third |= seen_by[i] == 3,
            several |= seen_by[i] == kSeveralStations;
    EXPECT_NEAR(colours.coverage[c], 254 * sum / voxels, 0.5 + 1e-9);
    EXPECT_EQ(colours.only[c], several ? 255 : third ? 3 : 0);
  }
}

TEST(CoverageCells, TellWhetherOneStationSeesAlone) {
  EXPECT_EQ(together(0, 0), 0);
  EXPECT_EQ(together(0, 70), 70);
  EXPECT_EQ(together(70, 0), 70);
  EXPECT_EQ(together(70, 70), 70);
  EXPECT_EQ(together(70, 6), kSeveralStations);
  EXPECT_EQ(together(kSeveralStations, 70), kSeveralStations);
  EXPECT_EQ(together(kSeveralStations, 0), kSeveralStations);
}

TEST(CoverageCells, AreAsTheNearestWhereNothingWasCounted) {
  Surveyed site;
  const CoverageCells cells = coverage_cells(site.simulator, 100'000, 100'000);
  // Only voxels of one end are known: all others copy the edge of the known ones.
  std::vector<std::uint32_t> voxel_indices, counts;
  std::vector<Seer> seen_by;
  for (const std::uint32_t voxel : cells.voxels) {
    if (site.simulator.voxel_centre(voxel).y > 1998) continue;
    voxel_indices.push_back(voxel), counts.push_back(1'000'000), seen_by.push_back(1);
  }
  ASSERT_GT(voxel_indices.size(), 0u);
  ASSERT_LT(voxel_indices.size(), cells.voxels.size());
  const CellColours colours = cell_colours(cells, voxel_indices, counts, seen_by, site.simulator);
  EXPECT_EQ(std::ranges::count(colours.coverage, 254), std::ssize(colours.coverage));
  EXPECT_EQ(std::ranges::count(colours.only, 1), std::ssize(colours.only));
}

TEST(CoverageCells, ReasonsAreTheCommonestAround) {
  Surveyed site;
  const CoverageCells cells = coverage_cells(site.simulator, 100'000, 60);
  std::vector<VoxelStatus> why;
  for (const std::uint32_t voxel : cells.voxels)
    why.push_back({site.simulator.voxel_centre(voxel).y < 2000 ? WhyMissed::hidden : WhyMissed::captured});
  const auto reasons = cell_reasons(cells, cells.voxels, why);
  for (std::uint32_t c = 0; c < cells.keys.size(); ++c) {
    const double y = cells.corner.y + (cells.keys[c] >> 11 & 2047) * cells.size_m;  // local: 0 is the border
    const bool below = y + 2 * cells.size_m<0, above = y - cells.size_m> 0;         // with all cells around it
    if (!below && !above) continue;
    EXPECT_EQ(reasons[c], static_cast<std::uint8_t>(below ? WhyMissed::hidden : WhyMissed::captured));
  }
}

}  // namespace
}  // namespace vantage
