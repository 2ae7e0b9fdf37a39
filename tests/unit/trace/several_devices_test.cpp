// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "support/trace_scenes.hpp"
#include "trace/tracer.hpp"

namespace vantage {
namespace {

TEST(SeveralDevices, AllThatWereAskedForAreTaken) {
  const TraceScene scene = test::trace_scene(
      test::SceneBuilder().mesh(Role::surveyed, test::quad({-1, 1, 0}, {2, 0, 0}, {0, 0, 2})).finish(), {}, 0.5);
  const DeviceChoice embree{.engine = Engine::embree};
  const std::string one = make_tracer(Engine::embree, std::nullopt, scene)->info().device;
  EXPECT_EQ(make_tracer(std::array{embree}, scene, {})->info().device, one);
  EXPECT_EQ(make_tracer(std::array{embree, embree}, scene, {})->info().device, "2 x " + one);
}

}  // namespace
}  // namespace vantage
