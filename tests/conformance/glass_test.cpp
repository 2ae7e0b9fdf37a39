// SPDX-License-Identifier: Apache-2.0
// Every engine traces a site with glass as if the glass were not there.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <numeric>
#include <vector>

#include "conformance/engines_under_test.hpp"
#include "scan/noise_model.hpp"
#include "scan/pattern.hpp"
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
    std::array<VoxelField, 2> fields;
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

INSTANTIATE_TEST_SUITE_P(Engines, GlassConformance, testing::ValuesIn(engines_under_test()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace vantage::test
