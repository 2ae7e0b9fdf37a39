// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/surface.hpp"

#include <gtest/gtest.h>

#include "support/trace_scenes.hpp"

namespace vantage {
namespace {

Surface surface_over(const std::shared_ptr<const SceneData>& scene) { return {scene, std::make_shared<Planes>(scene)}; }

TEST(Surface, NormalsFaceTheScannerAndFallBackToThePlane) {
  SceneData scene =
      *test::SceneBuilder().mesh(Role::surveyed, test::quad({-1, 3, -1}, {2, 0, 0}, {0, 0, 2}), 0.8).finish();
  const Float3 d{0, 1, 0};
  {
    const Surface surface = surface_over(std::make_shared<const SceneData>(scene));
    const Vec3 n = surface.facet(0).normal(d, {0.3, 0.3});
    EXPECT_EQ(n.y, -1);
    EXPECT_NEAR(surface.facet(0).reflectivity(d, n), 0.8, 1e-7);
  }
  scene.normals.assign(scene.positions.size(), Float3{});
  EXPECT_EQ(surface_over(std::make_shared<const SceneData>(scene)).facet(0).normal(d, {0.3, 0.3}).y, -1);
  scene.normals.assign(scene.positions.size(), Float3{0.6f, 0.8f, 0});
  const Vec3 n = surface_over(std::make_shared<const SceneData>(scene)).facet(0).normal(d, {0.3, 0.3});
  EXPECT_NEAR(n.x, -0.6, 1e-7);
  EXPECT_NEAR(n.y, -0.8, 1e-7);
}

TEST(Surface, KnowsWhatIsSurveyed) {
  const Surface surface = surface_over(test::SceneBuilder()
                                           .mesh(Role::blocking, test::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}))
                                           .mesh(Role::surveyed, test::quad({0, 0, 1}, {1, 0, 0}, {0, 1, 0}))
                                           .finish());
  for (std::uint32_t t = 0; t < 4; ++t) EXPECT_EQ(surface.surveyed(t), t >= 2);
}

}  // namespace
}  // namespace vantage
