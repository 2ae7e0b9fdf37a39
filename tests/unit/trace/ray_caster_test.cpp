// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/ray_caster.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "cast_one.hpp"
#include "support/trace_scenes.hpp"

namespace vantage {
namespace {

// Random directions in a cone, as a bundle from the origin.
std::unique_ptr<RayBundle> cone(RandomStream& random, double spread, std::uint32_t size, float end) {
  auto rays = std::make_unique<RayBundle>();
  rays->size = size;
  const double zenith = 0.1 + 2.9 * random.uniform(), azimuth = 6.28 * random.uniform();
  for (std::uint32_t i = 0; i < size; ++i) {
    const double t = zenith + spread * (random.uniform() - 0.5), p = azimuth + spread * (random.uniform() - 0.5);
    rays->x[i] = static_cast<float>(std::sin(t) * std::cos(p));
    rays->y[i] = static_cast<float>(std::sin(t) * std::sin(p));
    rays->z[i] = static_cast<float>(std::cos(t));
    rays->end[i] = end;
  }
  return rays;
}

// Random triangles on a few planes, each three times with its corners in another order, to force ties.
std::shared_ptr<const SceneData> ties() {
  RandomStream random(3);
  std::vector<Float3> corners;
  for (int copy = 0; copy < 3; ++copy) {
    RandomStream same(17);
    for (int k = 0; k < 300; ++k) {
      const float z = static_cast<float>(1 + k % 3), x = test::between(same, -6, 6), y = test::between(same, -6, 6);
      const Float3 a{x, y, k % 2 ? z : -z}, b{x + test::between(same, 0.5, 3), y, a.z},
          c{x, y + test::between(same, 0.5, 3), a.z};
      const std::array<Float3, 3> t{a, b, c};
      for (int v = 0; v < 3; ++v) corners.push_back(t[static_cast<std::size_t>((v + copy) % 3)]);
    }
  }
  return test::SceneBuilder().mesh(Role::surveyed, corners).finish();
}

TEST(RayCaster, HitsDoNotDependOnTheBundle) {
  const RayCaster caster = test::caster_over(ties());
  RandomStream random(11);
  std::size_t hits = 0;
  for (int k = 0; k < 200; ++k) {
    const auto rays = cone(random, k % 2 ? 0.05 : 1.5, 1 + random.bits() % RayBundle::kCapacity, 100);
    caster.cast(*rays);
    std::vector<Probe> probes;
    for (std::uint32_t i = 0; i < rays->size; ++i) probes.push_back({{rays->x[i], rays->y[i], rays->z[i]}, 100});
    caster.any_hits(rays->origin, 0, probes);
    for (std::uint32_t i = 0; i < rays->size; ++i) {
      const Float3 d{rays->x[i], rays->y[i], rays->z[i]};
      float t = 0;
      ASSERT_EQ(probes[i].hit == RayBundle::kNoHit, rays->primitive[i] == RayBundle::kNoHit);
      ASSERT_EQ(test::nearest_hit(caster, rays->origin, d, 0, 100, t), rays->primitive[i]);
      ASSERT_EQ(t, rays->t[i]);
      ASSERT_EQ(test::is_stopped(caster, rays->origin, d, 0, 100), rays->primitive[i] != RayBundle::kNoHit);
      if (rays->primitive[i] == RayBundle::kNoHit) continue;
      ++hits;
      // An end just behind the hit, or a start just before it, changes nothing; an end before it leaves no hit.
      float again = 0;
      ASSERT_EQ(test::nearest_hit(caster, rays->origin, d, std::nextafter(t, 0.0f), std::nextafter(t, 1e9f), again),
                rays->primitive[i]);
      ASSERT_EQ(again, t);
      ASSERT_EQ(test::nearest_hit(caster, rays->origin, d, 0, std::nextafter(t, 0.0f), again), RayBundle::kNoHit);
      ASSERT_FALSE(test::is_stopped(caster, rays->origin, d, 0, std::nextafter(t, 0.0f)));
      probes[i].end = std::nextafter(t, 0.0f);
    }
    caster.any_hits(rays->origin, 0, probes);
    for (const Probe& probe : probes) ASSERT_EQ(probe.hit, RayBundle::kNoHit);
  }
  EXPECT_GT(hits, 1000u);
}

TEST(RayCaster, OfCoincidentTrianglesTheFirstIsHit) {
  std::vector<Float3> corners;
  for (int copy = 0; copy < 5; ++copy) {
    const auto wall = test::quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2});
    corners.insert(corners.end(), wall.begin(), wall.end());
  }
  const RayCaster caster = test::caster_over(test::SceneBuilder().mesh(Role::surveyed, corners).finish());
  RandomStream random(5);
  for (int k = 0; k < 200; ++k) {
    const Float3 d{test::between(random, -0.4, 0.4), 1, test::between(random, -0.4, 0.4)};
    float t = 0;
    EXPECT_LT(test::nearest_hit(caster, {}, d, 0, 10, t), 2u);
    EXPECT_NEAR(t, 2, 1e-6);
  }
}

TEST(RayCaster, RaysStartAndEndWhereToldTo) {
  const RayCaster caster = test::caster_over(test::SceneBuilder()
                                                 .mesh(Role::surveyed, test::quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}))
                                                 .mesh(Role::blocking, test::quad({-1, 5, -1}, {2, 0, 0}, {0, 0, 2}))
                                                 .finish());
  RayBundle rays;
  rays.size = 3;
  for (std::uint32_t i = 0; i < 3; ++i) {
    rays.x[i] = rays.z[i] = 0.01f;
    rays.y[i] = 1;
    rays.end[i] = i == 0 ? 10.0f : i == 1 ? 1.9f : 4.9f;
  }
  caster.cast(rays);
  EXPECT_LT(rays.primitive[0], 2u);
  EXPECT_EQ(rays.primitive[1], RayBundle::kNoHit);
  EXPECT_EQ(rays.t[1], std::numeric_limits<float>::infinity());
  EXPECT_LT(rays.primitive[2], 2u);
  rays.start = 2.1f;
  caster.cast(rays);
  EXPECT_GE(rays.primitive[0], 2u);
  EXPECT_LT(rays.primitive[0], 4u);
  EXPECT_EQ(rays.primitive[2], RayBundle::kNoHit);
}

// A component slightly below 0 must not lose the ray, or its neighbours in the packet.
TEST(RayCaster, TinyComponentsLoseNoRay) {
  std::vector<Float3> ceiling;  // many triangles, so that there are boxes
  for (int i = 0; i < 400; ++i) {
    const float x = -3.1f + 0.3f * static_cast<float>(i % 20), y = -3.1f + 0.3f * static_cast<float>(i / 20);
    for (const Float3& p : {Float3{x, y, 2}, Float3{x + 0.3f, y, 2}, Float3{x + 0.3f, y + 0.3f, 2}, Float3{x, y, 2},
                            Float3{x + 0.3f, y + 0.3f, 2}, Float3{x, y + 0.3f, 2}})
      ceiling.push_back(p);
  }
  const RayCaster caster = test::caster_over(test::SceneBuilder().mesh(Role::surveyed, ceiling).finish());
  for (const float tiny : {-0.0f, -1e-44f, -1e-30f, -1.8e-23f, -0.9e-18f, -1.1e-18f, -1e-17f, -1e-12f, 1e-23f}) {
    RayBundle rays;
    rays.size = 16;
    for (std::uint32_t i = 0; i < rays.size; ++i) {
      rays.x[i] = i == 6 ? tiny : -1e-3f * static_cast<float>(8 - static_cast<int>(i));
      rays.y[i] = i == 9 ? tiny : -1e-3f;
      rays.z[i] = 1;
      rays.end[i] = 100;
    }
    caster.cast(rays);
    for (std::uint32_t i = 0; i < rays.size; ++i) {
      EXPECT_NE(rays.primitive[i], RayBundle::kNoHit) << "component " << tiny << ", ray " << i;
      float t = 0;
      EXPECT_EQ(test::nearest_hit(caster, rays.origin, {rays.x[i], rays.y[i], rays.z[i]}, 0, 100, t),
                rays.primitive[i]);
      EXPECT_TRUE(test::is_stopped(caster, rays.origin, {rays.x[i], rays.y[i], rays.z[i]}, 0, 100));
    }
  }
}

TEST(RayCaster, AnEmptySceneIsNeverHit) {
  const RayCaster caster = test::caster_over(std::make_shared<const SceneData>());
  RandomStream random(1);
  const auto rays = cone(random, 1, 100, 50);
  caster.cast(*rays);
  for (std::uint32_t i = 0; i < rays->size; ++i) EXPECT_EQ(rays->primitive[i], RayBundle::kNoHit);
}

}  // namespace
}  // namespace vantage
