// SPDX-License-Identifier: Apache-2.0
#include "vantage/missed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "support/quad_scene.hpp"
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
    simulator = std::make_unique<Simulator>(quads.scene(), scanner, config);
    clash = std::make_unique<ClashChecker>(simulator->scene());
    ranks.resize(simulator->voxel_count());
    std::iota(ranks.begin(), ranks.end(), 0u);
    patches = simulator->voxel_patches(ranks);
  }

  Scanner scanner;
  std::unique_ptr<Simulator> simulator;
  std::unique_ptr<ClashChecker> clash;
  std::vector<std::uint32_t> ranks;
  std::vector<VoxelPatch> patches;
  std::vector<PlacedStation> candidates{at({0, 0, 0}), at({0.2, 0.2, 0})};
};

TEST(VoxelPatches, LieOnTheirSurfaces) {
  const Walls site;
  const std::array<Vec3, 5> normals{{{1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 0}}};
  std::array<double, 5> area{};
  for (const VoxelPatch& patch : site.patches) {
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
  const Walls site;
  const std::vector<std::uint32_t> none(site.ranks.size());
  const std::vector<WhyMissed> why = why_missed(*site.simulator, *site.clash, site.candidates, site.ranks, none);
  const std::array<WhyMissed, 5> expected{WhyMissed::not_chosen, WhyMissed::hidden, WhyMissed::far, WhyMissed::flat,
                                          WhyMissed::sparse};
  const double face = site.simulator->voxel_size_m() * site.simulator->voxel_size_m();
  std::array<std::size_t, 5> whole{};
  double points = 0, sparse = 0;
  VoxelField field;
  site.simulator->evaluate(to_network(site.candidates), {.field = &field});
  for (std::size_t i = 0; i < why.size(); ++i) {
    const VoxelPatch& patch = site.patches[i];
    if (patch.area_m2 < 0.95 * face) continue;  // a wall's rim
    ++whole[patch.mesh];
    EXPECT_EQ(why[i], expected[patch.mesh]) << i << " of wall " << patch.mesh;
    // And rays agree: these are all the stations there are.
    if (why[i] == WhyMissed::hidden || why[i] == WhyMissed::far) {
      EXPECT_EQ(field.count[i], 0u);
    }
    if (why[i] == WhyMissed::sparse) {
      points += field.count[i];
      ++sparse;
    }
    if (why[i] == WhyMissed::not_chosen) {
      EXPECT_GE(field.count[i], site.simulator->goal_density());
    }
  }
  // A ray more or less falls into a voxel; in the mean they are as many as expected, 10.7 where 14.7 are wanted.
  EXPECT_NEAR(points / sparse, 10.7, 1.5);
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
    const Simulator simulator(quads.scene(), scanner,
                              {.engine = Engine::embree, .user_size_m = 0.5, .point_spacing_m = 0.1});
    const ClashChecker clash(simulator.scene());
    EXPECT_FALSE(clash.sees({0, 0, 0}, {2.9, 0, 0}));
    EXPECT_TRUE(clash.ray_passes({0, 0, 0}, {2.9, 0, 0}));
    EXPECT_FALSE(clash.ray_passes({0, 0, 0}, {3.1, 0, 0}));
    std::vector<std::uint32_t> ranks(simulator.voxel_count());
    std::iota(ranks.begin(), ranks.end(), 0u);
    const std::vector<PlacedStation> candidates{at({0, 0, 0})};
    const std::vector<std::uint32_t> none(ranks.size());
    const std::vector<WhyMissed> why = why_missed(simulator, clash, candidates, ranks, none);
    EXPECT_EQ(std::ranges::count(why, WhyMissed::hidden), 0);
    EXPECT_EQ(std::ranges::count(why, WhyMissed::dark), dark ? std::ssize(why) : 0);
    EXPECT_GT(why.size(), 20u);
  }
}

TEST(WhyMissed, KnowsWhatIsCaptured) {
  const Walls site;
  const auto enough = static_cast<std::uint32_t>(std::ceil(site.simulator->goal_density()));
  std::vector<std::uint32_t> points(site.ranks.size(), enough);
  points[0] = enough - 1;
  const std::vector<WhyMissed> why = why_missed(*site.simulator, *site.clash, site.candidates, site.ranks, points);
  EXPECT_NE(why[0], WhyMissed::captured);
  EXPECT_TRUE(std::all_of(why.begin() + 1, why.end(), [](WhyMissed w) { return w == WhyMissed::captured; }));
  const std::vector<MissedShare> shares = missed_by_node(*site.simulator, site.ranks, why);
  ASSERT_EQ(shares.size(), 6u);
  EXPECT_EQ(shares[0].voxels, site.ranks.size());
  EXPECT_NEAR(shares[0].share(WhyMissed::captured), 1 - 1.0 / static_cast<double>(site.ranks.size()), 1e-12);
  std::uint64_t sum = 0;
  for (std::size_t k = 1; k < 6; ++k) {
    EXPECT_EQ(shares[k].node, "quad " + std::to_string(k - 1));
    sum += shares[k].voxels;
  }
  EXPECT_EQ(sum, shares[0].voxels);
}

TEST(WhyMissed, RefusesWhatDoesNotFit) {
  const Walls site;
  const std::vector<std::uint32_t> none(site.ranks.size()), one(1), outside{0xFFFFFFF0u};
  EXPECT_THROW(why_missed(*site.simulator, *site.clash, site.candidates, site.ranks, one), Error);
  EXPECT_THROW(why_missed(*site.simulator, *site.clash, {}, site.ranks, none), Error);
  EXPECT_THROW(why_missed(*site.simulator, *site.clash, site.candidates, outside, one), Error);
}

}  // namespace
}  // namespace vantage
