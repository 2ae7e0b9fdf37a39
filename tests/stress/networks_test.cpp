// SPDX-License-Identifier: Apache-2.0
// Networks of 1, 2, 64 and 150 stations, all in holes, or with nothing in common; and more points than 32 bits hold.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "stress/engine_suite.hpp"
#include "stress/moved_scene.hpp"
#include "trace/field_counts.hpp"
#include "trace/pass_field.hpp"
#include "vantage/error.hpp"
#include "vantage/objective.hpp"

namespace vantage::test {
namespace {

using Networks = EngineSuite;

Network ring(std::size_t stations) {
  Network network;
  for (std::size_t k = 0; k < stations; ++k) {
    const double a = 6.2831853 * static_cast<double>(k) / static_cast<double>(stations);
    network.push_back({{0.1 + 3.6 * std::cos(a), 0.2 + 3.3 * std::sin(a), 1.2 + 0.01 * static_cast<double>(k)}});
  }
  return network;
}

Network ring_of(const Network& all, std::size_t stations) {
  return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(stations)};
}

Simulator simulator_of_wall(const EngineInfo& engine) {
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(3);
  return {yard({}),
          scanner,
          {.engine = engine.engine, .device_index = engine.device_index, .user_size_m = 0.2, .point_spacing_m = 0.02}};
}

TEST_P(Networks, OfAnySizeAddUpTheirStations) {
  Simulator engine = simulator_of_wall(GetParam());
  const Network all = ring(150);
  PassField sum;  // word after word of 64 stations
  sum.count.assign(engine.voxel_count(), 0);
  sum.stations.assign(mask_words(all.size()) * engine.voxel_count(), 0);
  for (std::size_t k = 0; k < all.size(); ++k) {
    VoxelField one;
    const NetworkCounts counts = engine.evaluate({all[k]}, {.field = &one});
    EXPECT_EQ(clustering_coefficient(overlap_matrix(counts)), 0);
    for (std::size_t v = 0; v < one.count.size(); ++v) {
      sum.count[v] += one.count[v];
      sum.stations[k / mask_bits * one.count.size() + v] |= one.stations.word(0, v) << (k % mask_bits);
      ASSERT_LE(one.stations.word(0, v), 1u);
    }
    if (k == 1) {
      VoxelField two;
      const NetworkCounts pair = engine.evaluate({all[0], all[1]}, {.field = &two});
      EXPECT_EQ(two.count, sum.count);
      EXPECT_TRUE(std::ranges::equal(two.stations.all_words(), std::span(sum.stations).first(two.count.size())));
      EXPECT_GT(pair.shared_by(0, 1), 0u);
      EXPECT_EQ(clustering_coefficient(overlap_matrix(pair)), 0) << "two stations make no triangle";
    }
    if (k == 63) {
      VoxelField word;
      engine.evaluate(ring_of(all, 64), {.field = &word});
      EXPECT_EQ(word.count, sum.count);
      EXPECT_TRUE(std::ranges::equal(word.stations.all_words(), std::span(sum.stations).first(word.count.size())));
    }
  }
  VoxelField field;
  const NetworkCounts counts = engine.evaluate(all, {.field = &field});
  EXPECT_EQ(field.count, sum.count);
  EXPECT_EQ(field.stations.all_words(), sum.stations);
  EXPECT_EQ(counts.seen.size(), 150u);
  EXPECT_EQ(counts.shared.size(), 150u * 149 / 2);
  const NetworkCounts sampled = engine.evaluate_sampled({&all, 1}, {.voxels = engine.voxel_count()}).front();
  EXPECT_EQ(sampled.shared, counts.shared);
  EXPECT_EQ(sampled.saturated, counts.saturated);
  EXPECT_EQ(sampled.partial_points, counts.partial_points);
  const double overlap = clustering_coefficient(overlap_matrix(counts));
  EXPECT_GT(overlap, 0.1);
  EXPECT_LE(overlap, 1);
  EXPECT_THROW(engine.evaluate(ring(max_stations + 1)), Error);
  EXPECT_THROW(engine.evaluate({}), Error);
}

TEST_P(Networks, WithoutAnActiveStationOrACommonVoxelHaveNoOverlap) {
  Simulator engine = simulator_of_wall(GetParam());
  for (const std::size_t n : {1u, 2u, 64u}) {
    Network holes = ring(n);
    for (Station& station : holes) station.active = false;
    VoxelField field;
    const NetworkCounts counts = engine.evaluate(holes, {.field = &field});
    EXPECT_EQ(counts.stations, n);
    EXPECT_EQ(counts.voxels, engine.voxel_count());
    EXPECT_EQ(coverage(counts, engine.goal_density()), 0);
    EXPECT_EQ(clustering_coefficient(overlap_matrix(counts)), 0);
    EXPECT_EQ(field.count, std::vector<std::uint32_t>(engine.voxel_count()));
    const NetworkCounts sampled = engine.evaluate_sampled({&holes, 1}, {.voxels = 100})[0];
    const Estimate covered = coverage_estimate(sampled, engine.goal_density(), engine.voxel_count());
    EXPECT_EQ(covered.value, 0);
    EXPECT_TRUE(std::isfinite(covered.standard_error));
    const Estimate overlap = overlap_estimate(sampled, engine.voxel_count());
    EXPECT_EQ(overlap.value, 0);
    EXPECT_TRUE(std::isfinite(overlap.standard_error));
  }
  // Three heads: in the boiler, in the ground and far away. The largest overlap is 0.
  const Network apart{{{0.7, 0.4, 1.31}}, {{0, 0, -3}}, {{500, 500, 1}}};
  const NetworkCounts counts = engine.evaluate(apart);
  EXPECT_GT(counts.seen[0], 0u);
  EXPECT_EQ(clustering_coefficient(overlap_matrix(counts)), 0);
  EXPECT_GT(coverage(counts, engine.goal_density()), 0);
}
// Five stations of 2³⁰ rays each, nearly all skipped. The clamp against wrapping comes in between, and must not change
// the counts.
TEST_P(Networks, OfMoreThan32BitsOfRaysAddUpTheirStations) {
  const std::vector<Vec3> corners{{-0.1, 20, 1.4}, {0.1, 20, 1.4}, {0.1, 20, 1.6}, {-0.1, 20, 1.6}};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}, {0, 2, 3}};
  Scanner scanner;
  scanner.azimuth_step = Angle::degrees(360.0 / 32'768);
  scanner.zenith_step = Angle::degrees(150.0 / 32'767);
  Simulator engine(Scene::from_triangles(corners, triangles), scanner,
                   {.engine = GetParam().engine,
                    .device_index = GetParam().device_index,
                    .user_size_m = 0.05,
                    .point_spacing_m = 0.001,
                    .max_rays_per_dispatch = std::uint64_t{1} << 29});
  Network network;
  for (const double x : {-2.0, -1.0, 0.0, 1.1, 2.3}) network.push_back({{x, 0.1 * x, 1.5}});
  ASSERT_GT(engine.scanner().rays() * network.size(), std::uint64_t{1} << 32);
  std::vector<std::uint32_t> sum(engine.voxel_count());
  for (const Station& station : network) {
    VoxelField one;
    engine.evaluate({station}, {.overlap = false, .field = &one});
    for (std::size_t v = 0; v < sum.size(); ++v) sum[v] += one.count[v];
  }
  VoxelField field;
  engine.evaluate(network, {.field = &field});
  EXPECT_EQ(field.count, sum);
  EXPECT_GT(*std::max_element(sum.begin(), sum.end()), 500u);
}
VANTAGE_EVERY_ENGINE(Networks);

// Totals of fields whose voxels hold up to 2³² − 1 points each, and together far more than 2³².
TEST(ManyPoints, AddUpBeyond32Bits) {
  constexpr std::uint32_t full = std::numeric_limits<std::uint32_t>::max();
  const std::vector<std::uint32_t> counts{full, full, full - 1, 0x80000000u, 7, 0};
  const std::vector<std::uint64_t> masks{~0ull, ~0ull, 1, 0, 2, 0};
  const NetworkCounts huge_goal = reduce_field(counts, masks, 64, 5e9);
  EXPECT_EQ(huge_goal.saturated, 0u);
  EXPECT_EQ(huge_goal.partial_points, 3 * (1ull << 32) - 4 + 0x80000000ull + 7);
  EXPECT_EQ(huge_goal.seen[63], 2u);
  EXPECT_EQ(huge_goal.shared.back(), 2u);
  EXPECT_NEAR(coverage(huge_goal, 5e9), (3 * 4294967296.0 - 4 + 2147483648.0 + 7) / 5e9 / 6, 1e-12);
  const NetworkCounts usual = reduce_field(counts, masks, 64, 61.3);
  EXPECT_EQ(usual.saturated, 4u);
  EXPECT_EQ(usual.partial_points, 7u);
}

}  // namespace
}  // namespace vantage::test
