// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/planes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/trace_scenes.hpp"

namespace vantage {
namespace {

float distance(const Planes& planes, std::uint32_t triangle, const Float3& o, const Float3& d) {
  float t = 0;
  planes.distances<1>(planes.seen(triangle, o), triangle, o, &d.x, &d.y, &d.z, &t);
  return t;
}

TEST(Planes, DistanceIsThePlanesToTheLastBit) {
  const Planes planes(
      test::SceneBuilder().mesh(Role::surveyed, test::quad({-50, 3, -50}, {100, 0, 0}, {0, 0, 100})).finish());
  EXPECT_EQ(distance(planes, 0, {0, 0, 0}, {0.1f, 0.5f, 0.2f}), 6.0f);
  EXPECT_EQ(distance(planes, 0, {0, 1, 0}, {0, 1, 0}), 2.0f);
}

// Eight rays together get the same bits as each alone, grazing ones included.
TEST(Planes, DistancesDoNotDependOnTheRaysBeside) {
  RandomStream random(23);
  for (int k = 0; k < 300; ++k) {
    std::vector<Float3> corners;
    for (int v = 0; v < 3; ++v)
      corners.push_back({test::between(random, -9, 9), test::between(random, -9, 9), test::between(random, -9, 9)});
    const Planes planes(test::SceneBuilder().mesh(Role::surveyed, corners).finish());
    const Float3 o{test::between(random, -9, 9), test::between(random, -9, 9), test::between(random, -9, 9)};
    float x[8], y[8], z[8], t[8];
    for (int i = 0; i < 8; ++i) {
      // Every other ray nearly follows an edge.
      const Float3 edge{corners[1].x - corners[0].x, corners[1].y - corners[0].y, corners[1].z - corners[0].z};
      x[i] = i % 2 ? edge.x / 20 : test::between(random, -1, 1);
      y[i] = i % 2 ? edge.y / 20 : test::between(random, -1, 1);
      z[i] = i % 2 ? edge.z / 20 : test::between(random, -1, 1);
    }
    planes.distances<8>(planes.seen(0, o), 0, o, x, y, z, t);
    for (int i = 0; i < 8; ++i) EXPECT_EQ(t[i], distance(planes, 0, o, {x[i], y[i], z[i]})) << k << ", " << i;
  }
}

// A ray in the plane stays within the triangle, and its distance is a number.
TEST(Planes, ARayInThePlaneStaysWithinTheTriangle) {
  const Planes planes(
      test::SceneBuilder().mesh(Role::surveyed, test::quad({-50, 3, -50}, {100, 0, 0}, {0, 0, 100})).finish());
  for (const Float3& d : {Float3{1, 0, 0}, Float3{1, 1e-7f, 0}, Float3{1, -1e-7f, 0}}) {
    EXPECT_EQ(distance(planes, 0, {-60, 2.9f, 0}, d), std::numeric_limits<float>::infinity());  // beside it
    for (const Float3& o : {Float3{-60, 3, 0}, Float3{-60, 3.0000005f, 0}}) {
      const float t = distance(planes, 0, o, d);
      EXPECT_GE(t, 10) << o.y << " " << d.y;
      EXPECT_LE(t, 110) << o.y << " " << d.y;
    }
  }
}

}  // namespace
}  // namespace vantage
