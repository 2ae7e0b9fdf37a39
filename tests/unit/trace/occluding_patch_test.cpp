// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/occluding_patch.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "cast_one.hpp"
#include "support/trace_scenes.hpp"

namespace vantage {
namespace {

using Corner = std::array<int, 2>;

// A wall of 2 · side² triangles across y, with bumps at its inner corners; `hole` leaves a triangle out.
std::vector<Float3> bumpy_wall(RandomStream& random, int side, double bumps, bool hole) {
  std::vector<std::vector<Float3>> at(static_cast<std::size_t>(side) + 1);
  for (int i = 0; i <= side; ++i)
    for (int j = 0; j <= side; ++j) {
      const double step = 6.0 / side, move = bumps * step;
      at[static_cast<std::size_t>(i)].push_back(
          {static_cast<float>(-3 + i * step) + test::between(random, -move, move),
           4 + test::between(random, -move, move),
           static_cast<float>(-3 + j * step) + test::between(random, -move, move)});
    }
  std::vector<Float3> corners;
  const auto put = [&](std::array<Corner, 3> triangle) {
    if (random.uniform() < 0.5) std::swap(triangle[0], triangle[1]);  // either order of corners
    for (const auto& [i, j] : triangle) corners.push_back(at[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]);
  };
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      put({Corner{i, j}, Corner{i + 1, j}, Corner{i + 1, j + 1}});
      if (!hole || 2 * i != side || 2 * j != side) put({Corner{i, j}, Corner{i + 1, j + 1}, Corner{i, j + 1}});
    }
  return corners;
}

// Rays to corners and edges of the wall that are said not to be near a corner must hit, as all others must.
TEST(OccludingPatches, WhatTheyHideNoRayReaches) {
  RandomStream random(78);
  std::size_t hidden = 0, alone = 0, tried = 0;
  for (int k = 0; k < 300; ++k) {
    const int side = 2 + k % 5;
    const std::vector<Float3> corners = bumpy_wall(random, side, k % 3 == 0 ? 0 : 0.2, false);
    const auto scene = test::SceneBuilder().mesh(Role::surveyed, corners).finish();
    const RayCaster caster = test::caster_over(scene);
    const OccludingPatches patches(*scene);
    const Vec3 middle{test::between(random, -2, 2), test::between(random, 6, 9), test::between(random, -2, 2)};
    const double half = 0.02 + 0.6 * random.uniform();
    const Box box{middle - Vec3{half, half, half}, middle + Vec3{half, half, half}};
    float t = 0;
    const Vec3 to = middle * (1 / std::sqrt(dot(middle, middle)));
    const std::uint32_t first = test::nearest_hit(caster, {}, narrow(to), 0.1f, 100, t);
    if (first == RayBundle::kNoHit) continue;
    // Half of all rays lead to edges; none within the doubt of a corner that was asked about.
    std::vector<Float3> rays;
    for (int r = 0; r < 400; ++r) {
      Vec3 p = middle + Vec3{test::between(random, -half, half), test::between(random, -half, half),
                             test::between(random, -half, half)};
      if (r % 2) {
        const std::size_t at =
            3 * (static_cast<std::size_t>(random.uniform() * static_cast<double>(corners.size())) / 3);
        const double u = r % 8 == 1 ? 0 : random.uniform();
        p = widen(corners[at]) * (1 - u) + widen(corners[at + 1]) * u;
        p = p * ((middle.y) / p.y);
        if (std::abs(p.x - middle.x) > half || std::abs(p.z - middle.z) > half) continue;
      }
      rays.push_back(narrow(p * (1 / std::sqrt(dot(p, p)))));
    }
    std::vector<std::pair<Vec3, double>> doubtful;
    const auto note = [&](const Vec3& point, double radius) {
      doubtful.emplace_back(point, radius);
      return false;
    };
    ++tried;
    if (!patches.hide(first, {}, box, 0.1, note)) continue;
    ++hidden, alone += doubtful.empty();
    for (const Float3& d : rays) {
      const auto near = [&](const auto& corner) {
        const Vec3 off = cross(corner.first, widen(d));
        return std::sqrt(dot(off, off)) < corner.second;
      };
      if (std::ranges::any_of(doubtful, near)) continue;
      ASSERT_NE(test::nearest_hit(caster, {}, d, 0.1f, 100, t), RayBundle::kNoHit) << "wall " << k;
      EXPECT_LT(t * d.y, box.min.y);
    }
  }
  EXPECT_GT(hidden, tried / 2) << "too seldom to be of use";
  EXPECT_LT(alone, hidden) << "no corner was in the way";
}

TEST(OccludingPatches, AHoleHidesNothing) {
  RandomStream random(79);
  const auto scene = test::SceneBuilder().mesh(Role::surveyed, bumpy_wall(random, 4, 0, true)).finish();
  const OccludingPatches patches(*scene);
  const RayCaster caster = test::caster_over(scene);
  float t = 0;
  const auto none_near = [](const Vec3&, double) { return false; };
  // The hole is the upper half of the cell from (0, 0) to (1.5, 1.5).
  const std::uint32_t beside = test::nearest_hit(caster, {}, narrow(Vec3{0.25, 1, 0.1}), 0.1f, 100, t);
  ASSERT_NE(beside, RayBundle::kNoHit);
  EXPECT_FALSE(patches.hide(beside, {}, {{0.8, 8, 0.8}, {2.2, 9, 2.2}}, 0.1, none_near));
  EXPECT_TRUE(patches.hide(beside, {}, {{1.2, 8, 0.2}, {1.4, 8.2, 0.4}}, 0.1, none_near));
}

TEST(OccludingPatches, NeitherATriangleBehindNorOneBeforeTheStart) {
  RandomStream random(80);
  const auto scene = test::SceneBuilder().mesh(Role::surveyed, bumpy_wall(random, 2, 0, false)).finish();
  const OccludingPatches patches(*scene);
  const auto none_near = [](const Vec3&, double) { return false; };
  const Box behind{{-0.5, 8, -0.5}, {0.5, 9, 0.5}};
  const RayCaster caster = test::caster_over(scene);
  float t = 0;
  const std::uint32_t first = test::nearest_hit(caster, {}, narrow(Vec3{0.01, 1, 0.02}), 0.1f, 100, t);
  EXPECT_TRUE(patches.hide(first, {}, behind, 0.1, none_near));
  EXPECT_FALSE(patches.hide(first, {}, behind, 5, none_near)) << "the scanner's least range is beyond the wall";
  EXPECT_FALSE(patches.hide(first, {}, {{-0.5, 3, -0.5}, {0.5, 4.5, 0.5}}, 0.1, none_near)) << "in the box";
  EXPECT_FALSE(patches.hide(first, {}, behind, 0.1, [](const Vec3&, double) { return true; })) << "rays at corners";
}

}  // namespace
}  // namespace vantage
