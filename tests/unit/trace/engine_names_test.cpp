// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "vantage/error.hpp"
#include "vantage/simulator.hpp"

namespace vantage {
namespace {

TEST(EngineNames, GoThereAndBack) {
  for (const Engine engine : {Engine::automatic, Engine::ray_query, Engine::compute_bvh, Engine::embree})
    EXPECT_EQ(engine_from_string(to_string(engine)), engine);
  EXPECT_EQ(to_string(Engine::automatic), "auto");
  EXPECT_EQ(engine_from_string("automatic"), Engine::automatic);
}

TEST(EngineNames, AnUnknownOneIsRefusedWithTheList) {
  try {
    engine_from_string("optix");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::invalid_argument);
    const std::string what = error.what();
    for (const char* part : {"optix", "auto", "ray_query", "compute_bvh", "embree"})
      EXPECT_NE(what.find(part), std::string::npos) << part;
  }
}

}  // namespace
}  // namespace vantage
