// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/seen_triangle.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "cast_one.hpp"
#include "support/trace_scenes.hpp"

namespace vantage {
namespace {

// Three corners, as seen from the head.
std::vector<Float3> blob(RandomStream& random) {
  std::vector<Float3> corners;
  for (int v = 0; v < 3; ++v)
    corners.push_back({test::between(random, -4, 4), test::between(random, 1, 12), test::between(random, -4, 4)});
  return corners;
}

// Slivers, from widths at which nothing is certain up to a decimetre.
std::vector<Float3> sliver(RandomStream& random) {
  std::vector<Float3> corners = blob(random);
  corners[2] = {(corners[0].x + corners[1].x) / 2 + test::between(random, 1e-4f, 0.1f),
                (corners[0].y + corners[1].y) / 2, (corners[0].z + corners[1].z) / 2};
  return corners;
}

// A strip of a wall beside the head, up to a hundred metres long, whose far end rays graze.
std::vector<Float3> strip(RandomStream& random) {
  const float side = test::between(random, 0.5f, 4), begin = test::between(random, -20, 20),
              end = begin + test::between(random, 5, 100), low = test::between(random, -2, 2),
              high = low + test::between(random, 0.05f, 0.5f), lean = test::between(random, -0.1f, 0.1f);
  return {{side, begin, low}, {side, end, low + lean}, {side + lean, begin, high}};
}

// A small triangle far away.
std::vector<Float3> speck(RandomStream& random) {
  const float x = test::between(random, -50, 50), y = test::between(random, 20, 90);
  std::vector<Float3> corners;
  for (int v = 0; v < 3; ++v)
    corners.push_back({x + test::between(random, -0.05f, 0.05f), y + test::between(random, -0.05f, 0.05f),
                       test::between(random, -0.05f, 0.05f)});
  return corners;
}

struct Certainty {
  std::size_t hits = 0, certain = 0;
};

// Embree agrees wherever a SeenTriangle is certain, by rays of which half come near to an edge.
Certainty certain_hits(std::vector<Float3> (*corners_of)(RandomStream&), std::uint64_t seed) {
  RandomStream random(seed);
  Certainty found;
  for (int k = 0; k < 300; ++k) {
    const std::vector<Float3> corners = corners_of(random);
    const RayCaster caster = test::caster_over(test::SceneBuilder().mesh(Role::surveyed, corners).finish());
    const SeenTriangle seen(widen(corners[0]), widen(corners[1]), widen(corners[2]));
    for (int r = 0; r < 200; ++r) {
      double u = random.uniform(), v = random.uniform() * (1 - u);
      if (r % 2) u = 1e-7 * (random.uniform() - 0.5);
      const Vec3 p = widen(corners[0]) * (1 - u - v) + widen(corners[1]) * u + widen(corners[2]) * v;
      const Vec3 unit = p * (1 / std::sqrt(dot(p, p)));
      const Float3 d{static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)};
      float t = 0;
      const bool hit = test::nearest_hit(caster, {}, d, 0.1f, 200, t) != RayBundle::kNoHit;
      found.hits += hit;
      const double nearest = seen.nearest_hit(widen(d)), farthest = seen.farthest_hit(widen(d));
      if (!seen.must_hit(widen(d)) || !(nearest > 0.1) || !(farthest < 200)) continue;
      ++found.certain;
      EXPECT_TRUE(hit) << "triangle " << k << ", ray " << r;
      // Before another hit that far, too, whatever Embree's own distance is.
      EXPECT_NE(test::nearest_hit(caster, {}, d, 0.1f, static_cast<float>(farthest), t), RayBundle::kNoHit)
          << "triangle " << k << ", ray " << r;
      EXPECT_NEAR(t, (nearest + farthest) / 2, t * 0x1p-13);  // the bounds lie around the distance itself
      EXPECT_LE(nearest, t) << "triangle " << k << ", ray " << r;
      EXPECT_GE(farthest, t) << "triangle " << k << ", ray " << r;
    }
  }
  return found;
}

TEST(SeenTriangle, IsCertainOfHalfOfAllHits) {
  const Certainty found = certain_hits(blob, 77);
  EXPECT_GT(found.certain, found.hits / 2);
}

TEST(SeenTriangle, IsNeverWrongAboutSlivers) { EXPECT_GT(certain_hits(sliver, 78).certain, 0u); }

// Linings and floors of long triangles hide what is behind them.
TEST(SeenTriangle, IsCertainOfStripsThatRaysGraze) {
  const Certainty found = certain_hits(strip, 79);
  EXPECT_GT(found.certain, found.hits / 4);
}

TEST(SeenTriangle, IsCertainOfSpecks) {
  const Certainty found = certain_hits(speck, 80);
  EXPECT_GT(found.certain, found.hits / 3);
}

// Each ray of a cone has the properties of the cone, and a plane just behind the triangle is recognised.
TEST(SeenTriangle, KnowsOfAConeWhatItKnowsOfItsRays) {
  RandomStream random(81);
  const auto unit = [](const Vec3& p) { return p * (1 / std::sqrt(dot(p, p))); };
  const auto lean = [&](double most) {
    const auto one = [&] { return most * (2 * random.uniform() - 1); };
    return Vec3{one(), one(), one()};
  };
  std::size_t covered = 0, before = 0;
  for (int k = 0; k < 4000; ++k) {
    const std::vector<Float3> corners = blob(random);
    const Vec3 a = widen(corners[0]), b = widen(corners[1]), c = widen(corners[2]);
    const SeenTriangle seen(a, b, c);
    const SeenCone cone{unit((a + b + c) * (1.0 / 3) + lean(0.5)), std::pow(10, -4 * random.uniform())};
    Vec3 normal = unit(unit(cross(b - a, c - a)) + lean(k % 2 ? 0 : 0.02));
    double height = dot(normal, a);
    if (height < 0) normal = normal * -1, height = -height;
    height += 0.2;  // beyond the triangle
    const bool is_covered = seen.must_hit(cone), is_before = seen.is_before(cone, normal, height, 0.999, 1e-3);
    covered += is_covered, before += is_covered && is_before;
    for (int r = 0; r < 20; ++r) {
      const Vec3 d = unit(cone.middle + unit(lean(1)) * (cone.radius * 0.999));
      if (dot(d - cone.middle, d - cone.middle) > cone.radius * cone.radius) continue;
      ASSERT_TRUE(!is_covered || seen.must_hit(d));
      ASSERT_LE(seen.nearest_hit(cone), seen.nearest_hit(d));
      ASSERT_GE(seen.farthest_hit(cone), seen.farthest_hit(d));
      if (is_before && dot(normal, d) > 0) {
        ASSERT_LT(seen.farthest_hit(d), 0.999 * height / dot(normal, d) - 1e-3) << k;
      }
    }
  }
  EXPECT_GT(covered, 1000u);
  EXPECT_GT(before, covered / 4);
}

}  // namespace
}  // namespace vantage
