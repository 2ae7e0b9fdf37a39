// SPDX-License-Identifier: Apache-2.0
// Every engine traces a site with glass as if the glass were not there; if echoes are limited, as Fresnel says.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "conformance/engines_under_test.hpp"
#include "scan/limit_model.hpp"
#include "scan/noise_model.hpp"
#include "scan/pattern.hpp"
#include "shared/trace_types.h"
#include "support/expect_counts.hpp"
#include "support/quad_scene.hpp"

namespace vantage::test {
namespace {

constexpr double goal_density = 4;

// A wall, a floor, and panes between the heads and the wall: one square on, one slanted, and one in the wall's plane.
QuadScene room(bool glass) {
  QuadScene scene = wall_and_floor();
  if (!glass) return scene;
  scene.quad({3, -4, -1.5f}, {0, 8, 0}, {0, 0, 4}, Role::blocking);
  scene.quad({1, -4, -1.5f}, {3, 8, 0}, {0, 0, 4}, Role::blocking);
  scene.quad({5, 3, -1.5f}, {0, 2, 0}, {0, 0, 4}, Role::blocking);
  for (std::size_t m = 2; m < 5; ++m) scene.data().meshes[m].glass = true;
  return scene;
}

TraceScene trace_scene(bool glass, bool noisy) {
  const auto scene = std::make_shared<const SceneData>(room(glass).data());
  Scanner scanner = coarse_scanner(0.7);
  scanner.noise = {.distances_m = {5}, .reflectivities = {0.5}, .sigma_m = {0.01}};
  return {.scene = scene,
          .grid = std::make_shared<const VoxelGrid>(VoxelGrid::build(*scene, 0.25)),
          .scanners = {{std::make_shared<const RayPattern>(make_pattern(scanner)),
                        std::make_shared<const NoiseModel>(noisy ? make_noise_model(scanner, 7) : NoiseModel())}}};
}

class GlassConformance : public testing::TestWithParam<EngineUnderTest> {};

TEST_P(GlassConformance, ChangesNoPointAndNoCount) {
  const std::vector<TraceStation> stations{{{0, 0, 0}, 0}, {{2.5f, 1, 0.2f}, 1}, {{4, -1, 0.3f}, 2}};
  const std::vector<std::uint32_t> sizes{3};
  const std::vector<std::vector<TraceStation>> networks{stations};
  for (const bool noisy : {false, true}) {
    const TraceScene with = trace_scene(true, noisy), without = trace_scene(false, noisy);
    ASSERT_EQ(with.scene->triangles.size(), without.scene->triangles.size() + 6);
    ASSERT_EQ(with.grid->size(), without.grid->size()) << "panes are not surveyed";
    std::array<std::unique_ptr<Tracer>, 2> tracers{GetParam().make(with), GetParam().make(without)};
    std::array<PassField, 2> fields;
    std::array<NetworkCounts, 2> counts, sampled;
    std::array<Tracer::RawChunk, 2> chunks;
    std::vector<std::uint32_t> voxels(with.grid->size());
    std::iota(voxels.begin(), voxels.end(), 0u);
    const RayPattern& pattern = *with.scanners[0].pattern;
    for (std::size_t k = 0; k < 2; ++k) {
      tracers[k]->set_goal_density(goal_density);
      counts[k] = tracers[k]->count(stations, 3, {true, true, &fields[k]}, {});
      sampled[k] = tracers[k]->count_sampled(networks, sizes, {voxels, 1, true, 0}, {}).at(0);
      tracers[k]->scan(stations[0], 0, std::uint64_t{pattern.rows()} * pattern.columns(),
                       Tracer::range | Tracer::primitive | Tracer::voxel | Tracer::reflectivity, chunks[k]);
    }
    EXPECT_GT(counts[0].points_on_surveyed[0], 1000u);
    EXPECT_EQ(counts[0].points_on_surveyed, counts[1].points_on_surveyed);
    EXPECT_EQ(fields[0].count, fields[1].count);
    EXPECT_EQ(fields[0].stations, fields[1].stations);
    expect_equal_counts(counts[0], counts[1]);
    expect_equal_counts(sampled[0], sampled[1]);
    EXPECT_EQ(chunks[0].range, chunks[1].range);
    EXPECT_EQ(chunks[0].primitive, chunks[1].primitive);
    EXPECT_EQ(chunks[0].voxel, chunks[1].voxel);
    EXPECT_EQ(chunks[0].reflectivity, chunks[1].reflectivity);
  }
}

// A wall at x = 5 behind a pane at x = 3, both square on: of a ray at α the echo comes from 5 / cos α, is weaker by cos
// α and by the pane's T². Each ray is decided by these closed forms, and the pane returns those within 1° of its
// normal.
TEST_P(GlassConformance, EchoesBehindAPaneFollowFresnel) {
  QuadScene quads;
  quads.quad({5, -9, -9}, {0, 18, 0}, {0, 0, 18});
  quads.quad({3, -9, -9}, {0, 18, 0}, {0, 0, 18}, Role::blocking);
  quads.data().meshes[1].glass = true;
  const auto scene = std::make_shared<const SceneData>(quads.data());
  Scanner scanner = coarse_scanner(0.5);
  scanner.max_range_m = 20;
  scanner.detection_range_m = 9;
  scanner.detection_reflectivity = 0.5;
  const TraceScene traced{
      .scene = scene,
      .grid = std::make_shared<const VoxelGrid>(VoxelGrid::build(*scene, 0.25)),
      .scanners = {{std::make_shared<const RayPattern>(make_pattern(scanner)), std::make_shared<const NoiseModel>(),
                    std::make_shared<const LimitModel>(make_limit_model(*scene, scanner, {}))}}};
  const auto tracer = GetParam().make(traced);
  tracer->set_goal_density(goal_density);
  Tracer::RawChunk chunk;
  tracer->scan({{0, 0, 0}, 0}, 0, scanner.rays(), Tracer::range | Tracer::primitive | Tracer::voxel, chunk);
  const NetworkCounts counts = tracer->count(std::vector<TraceStation>{{{0, 0, 0}, 0}}, 1, {true, true, nullptr}, {});
  std::size_t counted = 0, on_pane = 0, lost = 0, lost_to_glass = 0;
  for (std::uint64_t ray = 0; ray < scanner.rays(); ++ray) {
    const RayAngles angles = scanner.angles(ray);
    const double sine = std::sin(angles.zenith.in_radians());
    const double x = sine * std::cos(angles.azimuth.in_radians()), y = sine * std::sin(angles.azimuth.in_radians()),
                 z = std::cos(angles.zenith.in_radians());
    if (x <= 0 || std::abs(5 * y / x) > 8.9 || std::abs(5 * z / x) > 8.9) continue;
    const double s = std::sqrt(1.25 + x * x), t = 2 * x * s;
    const double across = t / (x * x + s * s), along = t / (x * x * 2.25 + s * s / 2.25);
    const double pane = std::pow((across + along) / 2, 2);
    const double reach = 81 * x * pane / (25 / (x * x));  // above 1: detected
    if (std::abs(reach - 1) < 1e-5) continue;
    const float at_wall = static_cast<float>(5 / x), at_pane = static_cast<float>(3 / x);
    if (std::acos(x) < 0.01745) {
      EXPECT_NEAR(chunk.range[ray], at_pane, 1e-5);
      EXPECT_EQ(chunk.voxel[ray], kNoVoxel);
      EXPECT_EQ(scene->mesh_of(chunk.primitive[ray]), 1u);
      ++on_pane;
    } else if (reach > 1) {
      EXPECT_NEAR(chunk.range[ray], at_wall, 1e-5) << std::acos(x);
      EXPECT_NE(chunk.voxel[ray], kNoVoxel);
      ++counted;
    } else {
      EXPECT_EQ(chunk.primitive[ray], no_primitive) << std::acos(x);
      ++lost;
      lost_to_glass += reach > pane ? 1 : 0;
    }
  }
  EXPECT_GT(on_pane, 5u);
  EXPECT_GT(lost_to_glass, 500u);
  EXPECT_GT(lost, lost_to_glass);
  EXPECT_NEAR(static_cast<double>(counts.points_on_surveyed[0]), static_cast<double>(counted), 40) << "beyond 8.9 m";
  EXPECT_GE(counts.dropped[0].echo, lost + on_pane);
  const auto voxels = chunk.voxel;
  EXPECT_EQ(counts.points_on_surveyed[0],
            static_cast<std::uint64_t>(std::ranges::count_if(voxels, [](auto v) { return v != kNoVoxel; })));
}

INSTANTIATE_TEST_SUITE_P(Engines, GlassConformance, testing::ValuesIn(engines_under_test()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace vantage::test
