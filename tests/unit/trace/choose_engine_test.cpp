// SPDX-License-Identifier: Apache-2.0
#include "trace/choose_engine.hpp"

#include <gtest/gtest.h>

#include "support/engines.hpp"

namespace vantage {
namespace {

EngineInfo engine(Engine kind, std::uint32_t device, bool usable, bool software) {
  EngineInfo info;
  info.engine = kind;
  info.device = software ? "software" : "hardware";
  info.device_index = device;
  info.usable = usable;
  info.software = software;
  return info;
}

const EngineInfo cpu = engine(Engine::embree, 0, true, false);

// Engines listed on a machine with a GPU, followed by the software device.
std::vector<EngineInfo> machine(bool gpu_has_ray_queries, bool gpu_computes) {
  return {engine(Engine::ray_query, 0, gpu_has_ray_queries, false), engine(Engine::compute_bvh, 0, gpu_computes, false),
          engine(Engine::ray_query, 1, true, true), engine(Engine::compute_bvh, 1, true, true), cpu};
}

TEST(ChooseEngine, TakesTheBestThatTheGpuCan) {
  EXPECT_EQ(default_engine(machine(true, true)), 0u);
  EXPECT_EQ(default_engine(machine(false, true)), 1u);   // no ray queries: our own tree on the GPU
  EXPECT_EQ(default_engine(machine(false, false)), 4u);  // Embree is faster than software
  EXPECT_EQ(default_engine({cpu}), 0u);
}

TEST(ChooseEngine, OfADeviceTakesTheFirstThatRuns) {
  EXPECT_EQ(default_engine(machine(true, true), 0), 0u);
  EXPECT_EQ(default_engine(machine(false, true), 0), 1u);
  EXPECT_EQ(default_engine(machine(false, true), 1), 2u);
}

// Test suites over engines run ray queries on the software device if the GPU has none.
TEST(ChooseEngine, TestsFindRayQueriesWhereverTheyAre) {
  const std::vector<EngineInfo> usable = test::usable_of(machine(false, true));
  ASSERT_EQ(usable.size(), 4u);
  EXPECT_EQ(usable[1].engine, Engine::ray_query);
  EXPECT_EQ(usable[1].device_index, 1u);
  EXPECT_TRUE(usable[1].software);
}

}  // namespace
}  // namespace vantage
