// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/seen_triangle.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "cast_one.hpp"
#include "support/trace_scenes.hpp"

namespace vantage {
namespace {

// If these tests are certain, Embree agrees.
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
    const RayCaster caster = test::caster_over(test::SceneBuilder().mesh(Role::surveyed, corners).finish());
    const SeenTriangle seen(widen(corners[0]), widen(corners[1]), widen(corners[2]));
    for (int r = 0; r < 200; ++r) {
      // Mostly near an edge.
      double u = random.uniform(), v = random.uniform() * (1 - u);
      if (r % 2) u = 1e-7 * (random.uniform() - 0.5);
      const Vec3 p = widen(corners[0]) * (1 - u - v) + widen(corners[1]) * u + widen(corners[2]) * v;
      const Vec3 unit = p * (1 / std::sqrt(dot(p, p)));
      const Float3 d{static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)};
      float t = 0;
      const bool hit = test::nearest_hit(caster, {}, d, 0.1f, 100, t) != RayBundle::no_hit;
      hits += hit;
      if (!seen.is_steep(widen(d)) || !seen.must_hit(widen(d))) continue;
      ++certain;
      ASSERT_TRUE(hit) << "triangle " << k << ", ray " << r;
      EXPECT_NEAR(t, seen.distance(widen(d)), t * SeenTriangle::distance_doubt);
    }
  }
  EXPECT_GT(certain, hits / 4) << "certain too seldom to be of use";
}

}  // namespace
}  // namespace vantage
