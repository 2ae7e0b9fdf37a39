// SPDX-License-Identifier: Apache-2.0
#include "placement/plane_quadtree.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace vantage {
namespace {

struct PlaneMesh {
  std::vector<Uv> points;
  std::vector<Triangle> triangles;
};

PlaneMesh random_mesh(std::mt19937& rng, int count, double size) {
  std::uniform_real_distribution<double> unit(-1, 1);
  PlaneMesh mesh;
  for (std::uint32_t t = 0; t < static_cast<std::uint32_t>(count); ++t) {
    const Uv c{unit(rng), unit(rng)};
    for (int k = 0; k < 3; ++k) mesh.points.push_back({c.u + size * unit(rng), c.v + size * unit(rng)});
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

Uv at(const PlaneMesh& mesh, const TrianglePoint& p) {
  const Triangle& t = mesh.triangles[p.triangle];
  const Uv i = mesh.points[t[0]], j = mesh.points[t[1]], k = mesh.points[t[2]];
  const double r = 1 - p.s - p.t;
  return {r * i.u + p.s * j.u + p.t * k.u, r * i.v + p.s * j.v + p.t * k.v};
}

// Signed distance to the nearest side, positive inside.
double depth(const PlaneMesh& mesh, std::uint32_t triangle, Uv p) {
  const Triangle& t = mesh.triangles[triangle];
  const Uv c[3] = {mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]};
  const double area = (c[1].u - c[0].u) * (c[2].v - c[0].v) - (c[1].v - c[0].v) * (c[2].u - c[0].u);
  double least = 1e300;
  for (int e = 0; e < 3; ++e) {
    const Uv a = c[e], b = c[(e + 1) % 3];
    const double side = (b.u - a.u) * (p.v - a.v) - (b.v - a.v) * (p.u - a.u);
    least = std::min(least, (area < 0 ? -side : side) / std::hypot(b.u - a.u, b.v - a.v));
  }
  return least;
}

TEST(PlaneQuadtree, FindsTheFirstTriangleThatHoldsThePoint) {
  std::mt19937 rng(4);
  for (const auto& [count, size] : {std::pair{3, 0.5}, {200, 0.1}, {3000, 0.02}, {400, 0.8}}) {
    const PlaneMesh mesh = random_mesh(rng, count, size);
    const PlaneQuadtree tree(mesh.points, mesh.triangles);
    std::uniform_real_distribution<double> unit(-1.2, 1.2);
    for (int i = 0; i < 2000; ++i) {
      const Uv p{unit(rng), unit(rng)};
      std::optional<std::uint32_t> expected;
      std::vector<std::uint32_t> all;
      double nearest_side = 1e300;
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const double d = depth(mesh, t, p);
        nearest_side = std::min(nearest_side, std::abs(d));
        if (d >= 0) {
          if (!expected) expected = t;
          all.push_back(t);
        }
      }
      if (nearest_side < 1e-8) continue;  // on an edge; see the next test
      const auto found = tree.find(p);
      ASSERT_EQ(found.has_value(), expected.has_value());
      std::vector<std::uint32_t> found_all;
      tree.find_all(p, [&](const TrianglePoint& f) { found_all.push_back(f.triangle); });
      ASSERT_EQ(found_all, all);
      if (!found) continue;
      ASSERT_EQ(found->triangle, *expected);
      ASSERT_GE(found->s, 0);
      ASSERT_GE(found->t, 0);
      ASSERT_LE(found->s + found->t, 1);
      ASSERT_NEAR(at(mesh, *found).u, p.u, 1e-9);
      ASSERT_NEAR(at(mesh, *found).v, p.v, 1e-9);
    }
  }
}

RC_GTEST_PROP(PlaneQuadtree, LosesNoPointOnAnEdge, ()) {
  const auto real = [] { return *rc::gen::inRange(-1000000, 1000001) * 1e-5; };
  PlaneMesh mesh;
  for (int i = 0; i < 4; ++i) mesh.points.push_back({real(), real()});
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
  const PlaneQuadtree tree(mesh.points, mesh.triangles);
  for (std::uint32_t t = 0; t < 2; ++t) {
    const Triangle& corners = mesh.triangles[t];
    const Uv a = mesh.points[corners[0]], b = mesh.points[corners[1]], c = mesh.points[corners[2]];
    const double area = std::abs((b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u));
    if (area < 1e-9) continue;
    for (int e = 0; e < 3; ++e) {
      const Uv p = mesh.points[corners[e]], q = mesh.points[corners[(e + 1) % 3]];
      for (const double x : {0.0, 1e-17, 0.1, 1.0 / 3, 0.7, 1.0}) {
        const auto found = tree.find({p.u + x * (q.u - p.u), p.v + x * (q.v - p.v)});
        RC_ASSERT(found.has_value());
      }
    }
  }
}

TEST(PlaneQuadtree, TrianglesWithoutAreaAreNoCandidates) {
  const double nan = std::nan("");
  const PlaneMesh mesh{{{0, 0}, {1, 0}, {2, 0}, {0, 1}, {nan, 0}, {1.0 / 3, 1.0 / 3}, {2.0 / 3, 2.0 / 3}},
                       {{0, 1, 2}, {0, 0, 1}, {0, 1, 4}, {0, 1, 3}}};
  const PlaneQuadtree tree(mesh.points, mesh.triangles);
  EXPECT_EQ(tree.candidates(), 1u);
  EXPECT_EQ(tree.max().u, 1);
  EXPECT_EQ(tree.find({0.25, 0.25})->triangle, 3u);
  EXPECT_FALSE(tree.find({1.5, 0}));
  EXPECT_FALSE(tree.find({nan, 0.1}));
  EXPECT_TRUE(PlaneQuadtree(mesh.points, std::vector<Triangle>{{0, 1, 2}}).empty());
  EXPECT_FALSE(PlaneQuadtree(mesh.points, std::vector<Triangle>{}).find({0, 0}));
}

TEST(PlaneQuadtree, ClosesTJunctions) {
  // The long edge from (0, 0) to (1, 0.7) has further vertices on one side only, rounded to float.
  PlaneMesh mesh;
  mesh.points = {{0, 0}, {1, 0.7}, {0, 1}, {1, 0}};
  mesh.triangles = {{0, 1, 2}};
  std::uint32_t previous = 0;
  for (int i = 1; i <= 7; ++i) {
    const auto next = i == 7 ? 1u : static_cast<std::uint32_t>(mesh.points.size());
    if (i < 7) mesh.points.push_back({i / 7.0, 0.7 * i / 7.0});
    mesh.triangles.push_back({previous, 3, next});
    previous = next;
  }
  const PlaneQuadtree tree(mesh.points, mesh.triangles);
  std::mt19937_64 rng(8);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 100000; ++i) {
    const double x = unit(rng);
    ASSERT_TRUE(tree.find({x, 0.7 * x}));
  }
}

// Neither piles of triangles nor fans around a vertex may make the tree explode.
TEST(PlaneQuadtree, StaysSmallInCrowdedPlaces) {
  PlaneMesh mesh;
  mesh.points = {{0, 0}, {1, 0}, {0.3, 1}};
  for (int i = 0; i < 3000; ++i) mesh.triangles.push_back({0, 1, 2});
  const PlaneQuadtree pile(mesh.points, mesh.triangles);
  std::size_t items = 0;
  for (const auto leaf : pile.leaves()) items += leaf.size();
  EXPECT_LT(items, 3000u * 300);
  EXPECT_EQ(pile.find({0.3, 0.3})->triangle, 0u);

  PlaneMesh fan;
  fan.points.push_back({0, 0});
  for (std::uint32_t i = 0; i < 3000; ++i) {
    fan.points.push_back({std::cos(i * 2 * M_PI / 3000), std::sin(i * 2 * M_PI / 3000)});
    fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % 3000});
  }
  const PlaneQuadtree round(fan.points, fan.triangles);
  items = 0;
  for (const auto leaf : round.leaves()) items += leaf.size();
  EXPECT_LT(items, 3000u * 300);
  EXPECT_TRUE(round.find({0, 0}));
  EXPECT_TRUE(round.find({1e-9, -1e-9}));
}

TEST(PlaneQuadtree, OverlappingTrianglesShareALeaf) {
  std::mt19937 rng(9);
  const PlaneMesh mesh = random_mesh(rng, 400, 0.1);
  const PlaneQuadtree tree(mesh.points, mesh.triangles);
  std::set<std::pair<std::uint32_t, std::uint32_t>> together;
  for (const auto leaf : tree.leaves()) {
    EXPECT_TRUE(std::is_sorted(leaf.begin(), leaf.end()));
    for (const std::uint32_t a : leaf)
      for (const std::uint32_t b : leaf) together.insert({a, b});
  }
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    const Uv p{unit(rng), unit(rng)};
    for (std::uint32_t a = 0; a < 400; ++a)
      for (std::uint32_t b = a + 1; b < 400 && depth(mesh, a, p) > 0; ++b)
        ASSERT_TRUE(depth(mesh, b, p) <= 0 || together.contains({a, b}));
  }
}

}  // namespace
}  // namespace vantage
