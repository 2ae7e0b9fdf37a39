// SPDX-License-Identifier: Apache-2.0
// Networks with more stations than a mask word has bits: counted in passes, they equal the sum of their stations'
// scans.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "conformance/engines_under_test.hpp"
#include "conformance/sites.hpp"
#include "support/expect_counts.hpp"
#include "support/reference_counts.hpp"
#include "trace/passes.hpp"

namespace vantage::test {
namespace {

// The site's stations repeatedly, slightly shifted each time; every ninth is left out.
std::vector<TraceStation> many_stations(const TestSite& site, std::uint32_t count) {
  std::vector<TraceStation> stations;
  for (std::uint32_t k = 0; k < count; ++k) {
    if (k % 9 == 4) continue;
    TraceStation station = site.stations[k % site.stations.size()];
    station.origin.x += 0.003f * static_cast<float>(k), station.origin.y -= 0.002f * static_cast<float>(k);
    station.place = k;
    stations.push_back(station);
  }
  return stations;
}

PassField field_of_scans(Tracer& tracer, const TestSite& site, std::span<const TraceStation> stations,
                         std::uint32_t count) {
  const std::size_t voxels = site.grid->size();
  PassField field;
  field.count.resize(voxels);
  field.stations.resize(voxels * mask_words(count));
  Tracer::RawChunk chunk;
  for (const TraceStation& station : stations) {
    tracer.scan(station, 0, site.rays(), Tracer::voxel, chunk);
    for (const std::uint32_t voxel_index : chunk.voxel) {
      if (voxel_index == kNoVoxel) continue;
      ++field.count[voxel_index];
      field.stations[station.place / 64 * voxels + voxel_index] |= std::uint64_t{1} << (station.place % 64);
    }
  }
  return field;
}

class LargeNetworksConformance : public testing::TestWithParam<EngineUnderTest> {};

TEST_P(LargeNetworksConformance, CountWhatTheirScansAddUpTo) {
  const TestSite& site = sites()[0];
  std::vector<std::uint32_t> all(site.grid->size());
  std::iota(all.begin(), all.end(), 0u);
  for (const bool noisy : {false, true}) {
    const std::unique_ptr<Tracer> tracer = GetParam().make(site.trace_scene(noisy));
    for (const std::uint32_t count : {65u, 200u}) {
      if (count > 65 && !noisy) continue;
      SCOPED_TRACE(std::to_string(count) + (noisy ? " stations, noise" : " stations"));
      const std::vector<TraceStation> stations = many_stations(site, count);
      const PassField expected = field_of_scans(*tracer, site, stations, count);
      // Some voxels reach this goal, others do not.
      const double goal_density = 0.5 * *std::ranges::max_element(expected.count) + 0.25;
      tracer->set_goal_density(goal_density);
      const NetworkCounts reference = reference_counts(expected, count, goal_density);
      EXPECT_GT(reference.saturated, 0u);
      EXPECT_GT(reference.partial_points, 0u);
      VoxelField field;
      const NetworkCounts exact =
          count_in_passes(*tracer, stations, count, {true, true}, &field, *site.grid, goal_density, {});
      expect_equal_counts(exact, reference);
      EXPECT_EQ(field.count, expected.count);
      EXPECT_EQ(field.stations.all_words(), expected.stations);
      const NetworkCounts sampled = count_sampled_in_passes(*tracer, stations, count, {.sample = all, .masks = true},
                                                            *site.grid, goal_density, {});
      expect_equal_counts(sampled, reference);
      ASSERT_EQ(sampled.groups.size(), 20u);
      std::uint64_t shared = 0;
      for (const NetworkCounts& group : sampled.groups) shared += group.shared_by(63, 64);
      EXPECT_EQ(shared, reference.shared_by(63, 64));
      const NetworkCounts coverage = count_sampled_in_passes(
          *tracer, stations, count,
          {.sample = all, .masks = false, .stop_at = static_cast<std::uint32_t>(std::ceil(goal_density))}, *site.grid,
          goal_density, {});
      EXPECT_EQ(coverage.saturated, reference.saturated);
      EXPECT_EQ(coverage.partial_points, reference.partial_points);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, LargeNetworksConformance, testing::ValuesIn(engines_under_test()),
                         [](const auto& engine) { return engine.param.name; });

}  // namespace
}  // namespace vantage::test
