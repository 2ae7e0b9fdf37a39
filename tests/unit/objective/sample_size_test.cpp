// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <vector>

#include "support/quad_scene.hpp"
#include "vantage/error.hpp"
#include "vantage/objective.hpp"
#include "vantage/simulator.hpp"

namespace vantage {
namespace {

TEST(SampleSize, HoldsTheWantedError) {
  SimulatorConfig config;
  config.engine = Engine::embree;
  config.user_size_m = 0.03, config.point_spacing_m = 0.02;
  Simulator simulator(test::wall_and_floor().scene(), test::coarse_scanner(0.5), config);
  const std::vector<Network> networks{{{{0, 0, 0}}}, {{{1, -2, 0.5}}, {{3, 1, -0.4}}, {{2, 2, 0}}}};
  ASSERT_GT(simulator.voxel_count(), 20'000u);
  for (const bool overlap : {false, true}) {
    std::uint64_t before = 0;
    for (const double wanted : {0.02, 0.003, 0.002}) {
      const std::uint64_t size = voxels_for_standard_error(simulator, networks, wanted, overlap);
      EXPECT_GE(size, before);
      EXPECT_LE(size, simulator.voxel_count());
      before = size;
      for (const NetworkCounts& counts : simulator.evaluate_sampled(networks, {.voxels = size, .overlap = overlap})) {
        EXPECT_LE(coverage_estimate(counts, simulator.goal_density(), simulator.voxel_count()).standard_error, wanted);
        EXPECT_LE(overlap ? overlap_estimate(counts, simulator.voxel_count()).standard_error : 0.0, wanted);
      }
    }
    EXPECT_GT(before, 5000u);
  }
  EXPECT_EQ(voxels_for_standard_error(simulator, networks, 1e-9), simulator.voxel_count());
  EXPECT_THROW(voxels_for_standard_error(simulator, networks, 0), Error);
}

}  // namespace
}  // namespace vantage
