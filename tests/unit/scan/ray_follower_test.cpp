// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/quad_scene.hpp"
#include "vantage/simulator.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {
namespace {

// A wall at x = -4 behind the head, and mirrors before it.
test::QuadScene with_mirrors(bool corner) {
  test::QuadScene scene;
  scene.quad({-4, -20, -20}, {0, 40, 0}, {0, 0, 40}, Role::surveyed, 0.5);
  if (corner) {
    // Two upright mirrors that meet at a right angle in the line x = 3, y = 0, each at 45° to the x axis.
    scene.quad({3, 0, -9}, {-3, 3, 0}, {0, 0, 18}, Role::blocking, 0);
    scene.quad({3, 0, -9}, {-3, -3, 0}, {0, 0, 18}, Role::blocking, 0);
  } else {
    scene.quad({3, -2, -9}, {0, 4, 0}, {0, 0, 18}, Role::blocking, 0);
  }
  for (std::size_t m = 1; m < scene.data().meshes.size(); ++m) scene.data().meshes[m].mirror = true;
  return scene;
}

ScanPoints scanned(const test::QuadScene& scene, const Scanner& scanner) {
  Simulator simulator(scene.scene(), scanner, {.engine = Engine::embree, .user_size_m = 0.5});
  return simulator.scan_points({{0, 0, 0}}, {.outputs = scan_position | scan_range | scan_normal | scan_ids |
                                                        scan_reflectivity | scan_voxel | scan_ghost});
}

Scanner scanner_of(double step_deg) {
  Scanner scanner = test::coarse_scanner(step_deg);
  scanner.max_range_m = 40;
  return scanner;
}

TEST(Mirrors, AFlatMirrorShowsTheWallBehindIt) {
  const ScanPoints points = scanned(with_mirrors(false), scanner_of(1));
  std::size_t ghosts = 0;
  for (std::size_t k = 0; k < points.position.size(); ++k) {
    EXPECT_EQ(points.mesh[k], 0) << "a mirror has no points";
    if (points.ghost[k] == 0) {
      EXPECT_NEAR(points.position[k].x, -4, 1e-5);
      continue;
    }
    ++ghosts;
    EXPECT_NEAR(points.position[k].x, 10, 1e-5) << "3 + 7";
    EXPECT_EQ(points.voxel[k], no_voxel);
    EXPECT_NEAR(points.normal[k][0], -1, 1e-6);
    const double cosine = points.position[k].x / static_cast<double>(points.range_m[k]);
    EXPECT_NEAR(static_cast<double>(points.reflectivity[k]), 0.5 * cosine, 1e-5);
  }
  EXPECT_GT(ghosts, 1000u);
  EXPECT_EQ(points.summary.ghosts, ghosts);
  EXPECT_EQ(points.summary.points, points.position.size());
  EXPECT_EQ(points.summary.hits_on_surveyed, points.position.size() - ghosts);
}

// Two mirrors at a right angle turn the ray about their common line: the wall appears where that half turn puts it, at
// x = 2·3 + 4, whichever mirror comes first.
TEST(Mirrors, ACornerOfTwoTurnsThePictureByHalf) {
  const ScanPoints points = scanned(with_mirrors(true), scanner_of(0.7));
  std::size_t ghosts = 0;
  for (std::size_t k = 0; k < points.position.size(); ++k) {
    if (points.ghost[k] == 0) continue;
    // A ray that meets one mirror alone sees the wall beside it.
    const Vec3& p = points.position[k];
    if (std::abs(p.y) > 2.9 * p.x / 10) continue;
    ++ghosts;
    EXPECT_NEAR(p.x, 10, 2e-5);
    EXPECT_NEAR(points.normal[k][0], -1, 1e-6);
  }
  EXPECT_GT(ghosts, 1000u);
}

TEST(Mirrors, AGhostsEchoComesFromAllOfItsWay) {
  Scanner scanner = scanner_of(1);
  scanner.detection_range_m = 12;
  scanner.detection_reflectivity = 0.5;
  const ScanPoints points = scanned(with_mirrors(false), scanner);
  const auto farthest = [&](bool ghost) {
    double most = 0;
    for (std::size_t k = 0; k < points.position.size(); ++k)
      if ((points.ghost[k] != 0) == ghost) most = std::max(most, static_cast<double>(points.range_m[k]));
    return most;
  };
  // t² = 12² cos α with cos α = 10 / t, and 4 / t for the wall itself.
  EXPECT_LE(farthest(true), std::cbrt(144.0 * 10));
  EXPECT_NEAR(farthest(true), std::cbrt(144.0 * 10), 0.2);
  EXPECT_NEAR(farthest(false), std::cbrt(144.0 * 4), 0.2);
}

TEST(Mirrors, NoPointOfAMirrorCounts) {
  const test::QuadScene scene = with_mirrors(false);
  Simulator simulator(scene.scene(), scanner_of(1), {.engine = Engine::embree, .user_size_m = 0.5});
  VoxelField field;
  const NetworkCounts counts = simulator.evaluate({{Vec3{0, 0, 0}}}, {.skip = false, .field = &field});
  const ScanPoints points = scanned(scene, scanner_of(1));
  EXPECT_EQ(counts.points_on_surveyed[0], points.summary.points - points.summary.ghosts);
  Simulator around = surroundings_of(simulator);
  for (const VoxelPatch& patch : around.voxel_patches(around.sampled_voxels(around.voxel_count()))) {
    EXPECT_EQ(patch.mesh, 0u);
  }
}

}  // namespace
}  // namespace vantage
