// SPDX-License-Identifier: Apache-2.0
// Noise of metres, more than the distances themselves. A point stays on its ray, at the head if the range would be
// below 0, and a sample finds it wherever it lands.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "conformance/agreement.hpp"
#include "conformance/engines_under_test.hpp"
#include "conformance/sites.hpp"
#include "scan/noise_model.hpp"
#include "scan/pattern.hpp"
#include "support/expect_counts.hpp"
#include "support/reference_counts.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage::test {
namespace {

constexpr double goal_density = 2;

// The three walls, from the middle of a surveyed voxel and from between the walls.
TestSite noisy_site() {
  TestSite site = sites()[0];
  site.name = "three-walls, noise of metres";
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(1);
  scanner.min_range_m = 0.4;
  scanner.max_range_m = 60;
  scanner.noise = {.distances_m = {1, 20}, .reflectivities = {0.5}, .sigma_m = {5, 8}};
  site.pattern = std::make_shared<const RayPattern>(make_pattern(scanner));
  site.noise = std::make_shared<const NoiseModel>(make_noise_model(scanner, 4711));
  const VoxelGrid& grid = *site.grid;
  const auto cell = morton_decode(grid.key(grid.size() / 2));
  const auto middle = [&](std::size_t axis) {
    return grid.min()[axis] + static_cast<float>((cell[axis] + 0.5) * grid.voxel_size());
  };
  site.stations.resize(2);
  site.stations[0].origin = {middle(0), middle(1), middle(2)};
  return site;
}

class LargeNoiseConformance : public testing::TestWithParam<EngineUnderTest> {};

TEST_P(LargeNoiseConformance, SamplesAndExactCountsAreThePointsOfTheScans) {
  const TestSite site = noisy_site();
  const auto stations = static_cast<std::uint32_t>(site.stations.size());
  const std::unique_ptr<Tracer> tracer = GetParam().make(site.trace_scene(true));
  tracer->set_goal_density(goal_density);

  PassField expected;
  expected.count.resize(site.grid->size());
  expected.stations.resize(site.grid->size());
  std::size_t at_head = 0, undecided = 0;
  for (std::uint32_t s = 0; s < stations; ++s) {
    Tracer::RawChunk chunk;
    tracer->scan(site.stations[s], 0, site.rays(), all_outputs, chunk);
    compare_with_reference(*site.scene, site.reference(s, true), chunk, undecided);
    at_head += static_cast<std::size_t>(std::ranges::count(chunk.range, 0.0f));
    for (const float range : chunk.range) ASSERT_FALSE(range < 0) << "station " << s;
    for (const std::uint32_t voxel : chunk.voxel) {
      if (voxel == kNoVoxel) continue;
      ++expected.count[voxel];
      expected.stations[voxel] |= std::uint64_t{1} << s;
    }
  }
  EXPECT_GT(at_head, 100u);
  EXPECT_GT(expected.count[site.grid->size() / 2], 100u) << "what noise leaves at the first head";

  PassField field;
  const NetworkCounts exact = tracer->count(site.stations, stations, {true, false, &field}, {});
  EXPECT_EQ(field.count, expected.count);
  EXPECT_EQ(field.stations, expected.stations);
  const NetworkCounts reference = reference_counts(expected, stations, goal_density);
  EXPECT_GT(reference.saturated, 0u);
  EXPECT_GT(reference.partial_points, 0u);
  expect_equal_counts(exact, reference);
  PassField skipped;
  expect_equal_counts(tracer->count(site.stations, stations, {true, true, &skipped}, {}), reference);
  EXPECT_EQ(skipped.count, expected.count);

  // Any triangle may affect any voxel, so only some voxels are tested.
  std::vector<std::uint32_t> sample, points, expected_points;
  for (std::size_t voxel_index = 0; voxel_index < site.grid->size(); ++voxel_index) {
    if (expected.count[voxel_index] == 0 && voxel_index % 97 != 0) continue;
    sample.push_back(static_cast<std::uint32_t>(voxel_index));
    expected_points.push_back(expected.count[voxel_index]);
  }
  Tracer::SampleJob job{sample, 20, true, 0};
  job.points = [&](std::size_t, std::span<const std::uint32_t> of) { points.assign(of.begin(), of.end()); };
  const std::vector<std::vector<TraceStation>> networks{site.stations};
  const std::vector<NetworkCounts> sampled = tracer->count_sampled(networks, std::array{stations}, job, {});
  EXPECT_EQ(points, expected_points);
  EXPECT_GT(std::ranges::count_if(points, [](std::uint32_t count) { return count > 0; }), 20);
  EXPECT_EQ(sampled.at(0).voxels, sample.size());
}

INSTANTIATE_TEST_SUITE_P(Engines, LargeNoiseConformance, testing::ValuesIn(engines_under_test()),
                         [](const auto& engine) { return engine.param.name; });

}  // namespace
}  // namespace vantage::test
