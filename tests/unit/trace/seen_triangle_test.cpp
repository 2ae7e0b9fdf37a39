// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/seen_triangle.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "trace/embree/occluders.hpp"
#include "trace/embree/ray_caster.hpp"
#include "trace_scenes.hpp"

namespace vantage {
namespace {

Vec3 widen(const Float3& p) { return {p.x, p.y, p.z}; }

// The one thing that counts: where these tests are certain, Embree says the same.
TEST(SeenTriangle, MustHitIsNeverWrong) {
  RandomStream random(77);
  std::size_t certain = 0, hits = 0;
  for (int k = 0; k < 400; ++k) {
    std::vector<Float3> corners;
    for (int v = 0; v < 3; ++v)
      corners.push_back({test::between(random, -4, 4), test::between(random, 1, 12), test::between(random, -4, 4)});
    if (k % 4 == 0)
      corners[2] = {(corners[0].x + corners[1].x) / 2 + 1e-4f, (corners[0].y + corners[1].y) / 2,
                    (corners[0].z + corners[1].z) / 2};  // a sliver
    const RayCaster caster(test::SceneBuilder().mesh(Role::surveyed, corners).finish());
    const SeenTriangle seen(widen(corners[0]), widen(corners[1]), widen(corners[2]));
    for (int r = 0; r < 200; ++r) {
      // Near an edge more often than not.
      double u = random.uniform(), v = random.uniform() * (1 - u);
      if (r % 2) u = 1e-7 * (random.uniform() - 0.5);
      const Vec3 p = widen(corners[0]) * (1 - u - v) + widen(corners[1]) * u + widen(corners[2]) * v;
      const Vec3 unit = p * (1 / std::sqrt(dot(p, p)));
      const Float3 d{static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)};
      float t = 0;
      const bool hit = caster.nearest_hit({}, d, 0.1f, 100, t) != RayBundle::no_hit;
      hits += hit;
      if (!seen.is_steep(widen(d)) || !seen.must_hit(widen(d))) continue;
      ++certain;
      ASSERT_TRUE(hit) << "triangle " << k << ", ray " << r;
      EXPECT_NEAR(t, seen.distance(widen(d)), t * SeenTriangle::distance_doubt);
    }
  }
  EXPECT_GT(certain, hits / 4) << "certain too seldom to be of use";
}

TEST(SeenTriangle, WhatItCoversNoRayReaches) {
  RandomStream random(78);
  int covered = 0;
  for (int k = 0; k < 3000; ++k) {
    std::array<Vec3, 3> c;
    for (Vec3& p : c) p = {8 * random.uniform() - 4, 1 + 3 * random.uniform(), 8 * random.uniform() - 4};
    const SeenTriangle seen(c[0], c[1], c[2]);
    const Vec3 centre{4 * random.uniform() - 2, 4 + 4 * random.uniform(), 4 * random.uniform() - 2};
    const Vec3 half{0.05 + random.uniform() * 0.2, 0.05 + random.uniform() * 0.2, 0.05 + random.uniform() * 0.2};
    if (!seen.covers(centre - half, centre + half, 1.01)) continue;
    ++covered;
    for (int r = 0; r < 60; ++r) {
      const Vec3 p = centre + Vec3{half.x * (2 * random.uniform() - 1), half.y * (2 * random.uniform() - 1),
                                   half.z * (2 * random.uniform() - 1)};
      const double distance = std::sqrt(dot(p, p));
      const Vec3 d = p * (1 / distance);
      ASSERT_TRUE(seen.must_hit(d));
      ASSERT_TRUE(seen.is_steep(d));
      ASSERT_LT(seen.distance(d) * 1.01, distance);
    }
  }
  EXPECT_GT(covered, 100);
}

TEST(Occluders, ForgetTheOldestAndIgnoreWhatIsTooNear) {
  Occluders occluders(0.5);
  const auto wall = [](double y) { return SeenTriangle({-9, y, -9}, {9, y, -9}, {0, y, 20}); };
  const Vec3 low{-0.1, 5, -0.1}, high{0.1, 5.2, 0.1};
  EXPECT_FALSE(occluders.hide_box(low, high));
  occluders.add(1, wall(0.4));
  EXPECT_FALSE(occluders.hide_box(low, high)) << "a ray starts behind it";
  EXPECT_FALSE(occluders.stop_ray({0, 1, 0}, 4));
  occluders.add(2, wall(2));
  EXPECT_TRUE(occluders.hide_box(low, high));
  EXPECT_TRUE(occluders.stop_ray({0, 1, 0}, 4));
  EXPECT_FALSE(occluders.stop_ray({0, 1, 0}, 2)) << "not before itself";
  for (std::uint32_t id = 3; id < 10; ++id) occluders.add(id, SeenTriangle({-9, 3, 5}, {9, 3, 5}, {0, 3, 20}));
  EXPECT_FALSE(occluders.knows(2));
  EXPECT_TRUE(occluders.knows(9));
  EXPECT_FALSE(occluders.hide_box(low, high));
}

}  // namespace
}  // namespace vantage
