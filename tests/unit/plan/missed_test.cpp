// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "candidates/why_missed.hpp"
#include "support/quad_scene.hpp"
#include "support/site_of.hpp"
#include "vantage/error.hpp"
#include "vantage/planner.hpp"

namespace vantage {
namespace {

using test::QuadScene;

PlacedStation at(const Vec3& head) {
  PlacedStation station;
  station.position = head;
  return station;
}

// Walls around two heads near the origin, one for each reason.
struct Walls {
  Walls() {
    QuadScene quads;
    quads.quad({3, -2, -1}, {0, 4, 0}, {0, 0, 2});           // 0: near
    quads.quad({4, -1.5f, -0.8f}, {0, 3, 0}, {0, 0, 1.6f});  // 1: behind it
    quads.quad({-3, 15, -2}, {6, 0, 0}, {0, 0, 4});          // 2: beyond 10 m
    quads.quad({-8, -1, -0.3f}, {3, 0, 0}, {0, 2, 0});       // 3: level, hardly below the heads
    quads.quad({-2, -9.5f, -1}, {4, 0, 0}, {0, 0, 2});       // 4: in range, but few rays reach so far
    scanner.azimuth_step = scanner.zenith_step = Angle::degrees(1);
    scanner.max_range_m = 10;
    SimulatorConfig config;
    config.engine = Engine::embree;
    config.user_size_m = 0.5;
    config.point_spacing_m = 0.1;
    site.emplace(test::site_of(Simulator(quads.scene(), scanner, config)));
    voxels.resize(simulator().voxel_count());
    std::iota(voxels.begin(), voxels.end(), 0u);
    patches = simulator().voxel_patches(voxels);
  }

  Simulator& simulator() { return site->simulator(); }

  Scanner scanner;
  std::optional<Site> site;
  std::vector<std::uint32_t> voxels;
  std::vector<VoxelPatch> patches;
  std::vector<PlacedStation> candidates{at({0, 0, 0}), at({0.2, 0.2, 0})};
};

TEST(VoxelPatches, LieOnTheirSurfaces) {
  Walls walls;
  const std::array<Vec3, 5> normals{{{1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 0}}};
  std::array<double, 5> area{};
  for (const VoxelPatch& patch : walls.patches) {
    ASSERT_LT(patch.mesh, 5u);
    area[patch.mesh] += patch.area_m2;
    if (patch.area_m2 == 0) continue;
    EXPECT_NEAR(std::abs(dot(patch.normal, normals[patch.mesh])), 1, 1e-6);
    const Vec3& p = patch.point;
    const std::array<double, 5> off{p.x - 3, p.x - 4, p.y - 15, p.z + 0.3, p.y + 9.5};
    EXPECT_NEAR(off[patch.mesh], 0, 1e-4);
  }
  const std::array<double, 5> expected{8, 4.8, 24, 6, 8};
  for (std::size_t m = 0; m < 5; ++m) EXPECT_NEAR(area[m], expected[m], 0.01 * expected[m]) << m;
}

TEST(WhyMissed, TellsEachReason) {
  Walls walls;
  const std::vector<std::uint32_t> none(walls.voxels.size());
  const std::vector<VoxelStatus> status = why_missed(*walls.site, walls.candidates, walls.voxels, none);
  const std::array<WhyMissed, 5> expected{WhyMissed::not_chosen, WhyMissed::hidden, WhyMissed::far, WhyMissed::flat,
                                          WhyMissed::sparse};
  const double face = walls.simulator().voxel_size_m() * walls.simulator().voxel_size_m();
  std::array<std::size_t, 5> whole{};
  double points = 0, attainable = 0, sparse = 0;
  VoxelField field, other;
  walls.simulator().evaluate(to_network(std::span(walls.candidates).first(1)), {.field = &field});
  walls.simulator().evaluate(to_network(std::span(walls.candidates).last(1)), {.field = &other});
  for (std::size_t i = 0; i < status.size(); ++i) {
    const VoxelPatch& patch = walls.patches[i];
    if (patch.area_m2 < 0.95 * face) continue;  // a wall's rim
    ++whole[patch.mesh];
    const WhyMissed why = status[i].why;
    const std::uint32_t most = std::max(field.count[i], other.count[i]);
    EXPECT_EQ(why, expected[patch.mesh]) << i << " of wall " << patch.mesh;
    EXPECT_EQ(status[i].captured, 0);
    // Rays agree, since these are all the stations there are.
    if (why == WhyMissed::hidden || why == WhyMissed::far) {
      EXPECT_EQ(most, 0u);
      EXPECT_EQ(status[i].attainable, 0);
    }
    if (why == WhyMissed::sparse) {
      points += (field.count[i] + other.count[i]) / 2.0;
      attainable += status[i].attainable * walls.simulator().goal_density();
      ++sparse;
    }
    if (why == WhyMissed::not_chosen) {
      EXPECT_GE(most, walls.simulator().goal_density());
      EXPECT_EQ(status[i].attainable, 1);
    }
  }
  // A ray more or less falls into a voxel; in the mean they are as many as expected, 5.4 where 14.7 are wanted.
  EXPECT_NEAR(attainable / sparse, 5.4, 0.3);
  EXPECT_NEAR(points / sparse, attainable / sparse, 0.8);
  for (const std::size_t n : whole) EXPECT_GT(n, 5u);
}

// The near wall, at 3 m, if it is black; and behind glass it is not hidden.
TEST(WhyMissed, DarkSurfacesAndGlass) {
  for (const bool dark : {false, true}) {
    QuadScene quads;
    quads.quad({3, -2, -1}, {0, 4, 0}, {0, 0, 2}, Role::surveyed, dark ? 0.02 : 0.5);
    quads.quad({2, -3, -2}, {0, 6, 0}, {0, 0, 4}, Role::blocking);
    quads.data().meshes[1].glass = true;
    Scanner scanner;
    scanner.azimuth_step = scanner.zenith_step = Angle::degrees(1);
    scanner.max_range_m = 10, scanner.detection_range_m = 10;
    Site site = test::site_of(
        Simulator(quads.scene(), scanner, {.engine = Engine::embree, .user_size_m = 0.5, .point_spacing_m = 0.1}));
    const ClashChecker& clash = site.clash();
    EXPECT_FALSE(clash.sees({0, 0, 0}, {2.9, 0, 0}));
    EXPECT_TRUE(clash.ray_passes({0, 0, 0}, {2.9, 0, 0}));
    EXPECT_FALSE(clash.ray_passes({0, 0, 0}, {3.1, 0, 0}));
    std::vector<std::uint32_t> voxels(site.simulator().voxel_count());
    std::iota(voxels.begin(), voxels.end(), 0u);
    const std::vector<PlacedStation> candidates{at({0, 0, 0})};
    const std::vector<std::uint32_t> none(voxels.size());
    std::vector<WhyMissed> why;
    for (const VoxelStatus& status : why_missed(site, candidates, voxels, none)) why.push_back(status.why);
    EXPECT_EQ(std::ranges::count(why, WhyMissed::hidden), 0);
    EXPECT_EQ(std::ranges::count(why, WhyMissed::dark), dark ? std::ssize(why) : 0);
    EXPECT_GT(why.size(), 20u);
  }
}

TEST(WhyMissed, KnowsWhatIsCaptured) {
  Walls walls;
  const auto enough = static_cast<std::uint32_t>(std::ceil(walls.simulator().goal_density()));
  std::vector<std::uint32_t> points(walls.voxels.size(), enough);
  points[0] = enough - 1;
  const std::vector<VoxelStatus> status = why_missed(*walls.site, walls.candidates, walls.voxels, points);
  EXPECT_NE(status[0].why, WhyMissed::captured);
  EXPECT_TRUE(
      std::all_of(status.begin() + 1, status.end(), [](const VoxelStatus& s) { return s.why == WhyMissed::captured; }));
  const std::vector<MissedShare> shares = missed_by_node(walls.simulator(), walls.voxels, status);
  ASSERT_EQ(shares.size(), 6u);
  EXPECT_EQ(shares[0].voxels, walls.voxels.size());
  const double part = points[0] / walls.simulator().goal_density(), voxels = static_cast<double>(walls.voxels.size());
  EXPECT_NEAR(shares[0].share(WhyMissed::captured), 1 - (1 - part) / voxels, 1e-6);
  for (const MissedShare& share : shares)
    EXPECT_NEAR(std::accumulate(share.shares.begin(), share.shares.end(), 0.0), 1, 1e-6) << share.node;
  std::uint64_t sum = 0;
  for (std::size_t k = 1; k < 6; ++k) {
    EXPECT_EQ(shares[k].node, "quad " + std::to_string(k - 1));
    sum += shares[k].voxels;
  }
  EXPECT_EQ(sum, shares[0].voxels);
}

TEST(WhyMissed, RefusesWhatDoesNotFit) {
  Walls walls;
  const std::vector<std::uint32_t> none(walls.voxels.size()), one(1), outside{0xFFFFFFF0u};
  EXPECT_THROW(why_missed(*walls.site, walls.candidates, walls.voxels, one), Error);
  EXPECT_THROW(why_missed(*walls.site, {}, walls.voxels, none), Error);
  EXPECT_THROW(why_missed(*walls.site, walls.candidates, outside, one), Error);
}

}  // namespace
}  // namespace vantage
