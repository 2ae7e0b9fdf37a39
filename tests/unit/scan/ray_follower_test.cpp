// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

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
    EXPECT_EQ(points.voxel[k], kNoVoxel);
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

// A pane at x = 1 is passed on the way to the mirror, and again on the way from it to the wall.
TEST(Mirrors, PanesOnTheWayWeakenAGhost) {
  test::QuadScene scene = with_mirrors(false);
  scene.quad({1, -20, -20}, {0, 40, 0}, {0, 0, 40}, Role::blocking, 0);
  scene.data().meshes.back().glass = true;
  Scanner scanner = scanner_of(0.7);
  scanner.detection_range_m = 13;
  scanner.detection_reflectivity = 0.5;
  const ScanPoints clear = scanned(with_mirrors(false), scanner_of(0.7)), points = scanned(scene, scanner);
  const auto ghosts_of = [](const ScanPoints& scan) {
    std::vector<std::uint64_t> rays;
    for (std::size_t k = 0; k < scan.ray.size(); ++k)
      if (scan.ghost[k] != 0) rays.push_back(scan.ray[k]);
    return rays;
  };
  const std::vector<std::uint64_t> all = ghosts_of(clear), ghosts = ghosts_of(points);
  std::size_t lost_to_glass = 0;
  for (const std::uint64_t ray : all) {
    const RayAngles angles = scanner.angles(ray);
    const double cosine = std::sin(angles.zenith.in_radians()) * std::cos(angles.azimuth.in_radians());
    const double inner = std::sqrt(1.25 + cosine * cosine);
    const double t =
        cosine * inner * (1 / (cosine * cosine + inner * inner) + 2.25 / (5.0625 * cosine * cosine + inner * inner));
    const double reach = 169 * cosine / (100 / (cosine * cosine)), left = reach * std::pow(t, 4);
    if (std::abs(left - 1) < 1e-4 || std::abs(std::acos(cosine) - 0.01745) < 1e-4) continue;
    const bool expected = left > 1 && std::acos(cosine) > 0.01745;
    EXPECT_EQ(std::ranges::binary_search(ghosts, ray), expected) << std::acos(cosine) << " " << left;
    lost_to_glass += reach > 1 && left < 1 ? 1 : 0;
  }
  EXPECT_GT(ghosts.size(), 100u);
  EXPECT_GT(lost_to_glass, 100u);
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
