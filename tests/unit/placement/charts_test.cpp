// SPDX-License-Identifier: Apache-2.0
#include "placement/charts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "placement/plane_quadtree.hpp"

namespace vantage {
namespace {

SurfacePieces whole(std::vector<glm::dvec3> points, std::vector<Triangle> triangles) {
  SurfacePieces pieces{std::move(points), std::move(triangles), {}};
  for (std::uint32_t i = 0; i < pieces.triangles.size(); ++i) pieces.source.push_back(i);
  return pieces;
}

// A spiral ramp that overlaps itself `turns` times.
SurfacePieces spiral(int turns, int steps) {
  std::vector<glm::dvec3> points;
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i <= static_cast<std::uint32_t>(turns * steps); ++i) {
    const double angle = 2 * M_PI * i / steps, z = 3.0 * i / steps;
    points.push_back({2 * std::cos(angle), 2 * std::sin(angle), z});
    points.push_back({4 * std::cos(angle), 4 * std::sin(angle), z});
    if (i == 0) continue;
    const std::uint32_t k = 2 * i;
    triangles.push_back({k - 2, k - 1, k + 1});
    triangles.push_back({k - 2, k + 1, k});
  }
  return whole(std::move(points), std::move(triangles));
}

double uv_area(const SearchMesh& mesh, const Triangle& t) {
  const Uv a = mesh.uvs[t[0]], b = mesh.uvs[t[1]], c = mesh.uvs[t[2]];
  return 0.5 * std::abs((b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u));
}

// No point in (u, v) lies well inside two triangles.
void expect_no_overlap(const SearchMesh& mesh) {
  const PlaneQuadtree tree(mesh.uvs, mesh.triangles);
  for (const Triangle& t : mesh.triangles) {
    std::mt19937 rng(t[0]);
    std::uniform_real_distribution<double> unit(0.05, 0.9);
    for (int i = 0; i < 20; ++i) {
      double s = unit(rng), r = unit(rng) * (1 - s);
      const Uv a = mesh.uvs[t[0]], b = mesh.uvs[t[1]], c = mesh.uvs[t[2]];
      const Uv p{a.u * (1 - s - r) + b.u * s + c.u * r, a.v * (1 - s - r) + b.v * s + c.v * r};
      int holders = 0;
      tree.find_all(p, [&](const TrianglePoint&) { ++holders; });
      ASSERT_EQ(holders, 1);
    }
  }
}

TEST(Charts, ASpiralIsCutWhereItPassesOverItself) {
  const SurfacePieces pieces = spiral(3, 40);
  const auto charts = make_charts(pieces, 1e-4);
  EXPECT_GE(charts.size(), 3u);
  EXPECT_LE(charts.size(), 8u);
  const SearchMesh mesh = unfold(pieces, charts, {10, 20, 30});
  EXPECT_EQ(mesh.triangles.size(), pieces.triangles.size());
  expect_no_overlap(mesh);
}

TEST(Charts, AFlatMeshIsOneChartInTrueProportion) {
  std::vector<glm::dvec3> points;
  std::vector<Triangle> triangles;
  for (std::uint32_t j = 0; j <= 10; ++j)
    for (std::uint32_t i = 0; i <= 20; ++i) points.push_back({0.5 * i, 0.5 * j, 1});
  for (std::uint32_t j = 0; j < 10; ++j)
    for (std::uint32_t i = 0; i < 20; ++i) {
      const std::uint32_t k = j * 21 + i;
      triangles.push_back({k, k + 1, k + 22});
      triangles.push_back({k, k + 22, k + 21});
    }
  const SurfacePieces pieces = whole(points, triangles);
  const auto charts = make_charts(pieces, 1e-4);
  ASSERT_EQ(charts.size(), 1u);
  EXPECT_NEAR(charts[0].area, 50, 1e-9);
  EXPECT_NEAR(charts[0].mean_z, 1, 1e-12);
  const SearchMesh mesh = unfold(pieces, charts, {100, 200, 300});
  for (std::size_t v = 0; v < mesh.uvs.size(); ++v) {
    EXPECT_NEAR(mesh.uvs[v].u, (mesh.positions[v].x - 100) / 5, 1e-12);
    EXPECT_NEAR(mesh.uvs[v].v, (mesh.positions[v].y - 200) / 5, 1e-12);
    EXPECT_EQ(mesh.positions[v].z, 301);
  }
}

TEST(Charts, AreasAreInProportionAcrossChartsAndSlopes) {
  // A level floor, a ramp of 30° and a small platform above the floor.
  const double rise = 4 * std::tan(M_PI / 6);
  const SurfacePieces pieces = whole({{0, 0, 0},
                                      {6, 0, 0},
                                      {6, 4, 0},
                                      {0, 4, 0},
                                      {20, 0, 0},
                                      {24, 0, rise},
                                      {24, 3, rise},
                                      {20, 3, 0},
                                      {1, 1, 3},
                                      {3, 1, 3},
                                      {3, 2, 3},
                                      {1, 2, 3}},
                                     {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}, {8, 9, 10}, {8, 10, 11}});
  const auto charts = make_charts(pieces, 1e-4);
  ASSERT_EQ(charts.size(), 3u);
  const SearchMesh mesh = unfold(pieces, charts, {});
  expect_no_overlap(mesh);
  double ratio = 0, top = 0, least = 1;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 n = cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
    const double here = uv_area(mesh, t) / (0.5 * std::sqrt(dot(n, n)));
    if (ratio == 0) ratio = here;
    EXPECT_NEAR(here, ratio, 1e-9);
  }
  for (const Uv uv : mesh.uvs) {
    top = std::max(top, uv.v);
    least = std::min({least, uv.u, uv.v});
  }
  EXPECT_NEAR(top, 1, 1e-12);
  EXPECT_EQ(least, 0);
}

TEST(Charts, WeldsVerticesOfSeparateTrianglesAndDropsRepeats) {
  // Two squares side by side as loose triangles, a hair apart, one of them twice.
  const SurfacePieces pieces = whole({{0, 0, 0},
                                      {1, 0, 0},
                                      {1, 1, 0},
                                      {0, 0, 0},
                                      {1, 1, 0},
                                      {0, 1, 0},
                                      {1 + 1e-6, 0, 0},
                                      {2, 0, 0},
                                      {2, 1, 0},
                                      {1, 0, 1e-6},
                                      {2, 1, 0},
                                      {1, 1, 0},
                                      {0, 0, 1e-6},
                                      {1, 0, 0},
                                      {1, 1, 0}},
                                     {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 11}, {12, 13, 14}});
  const auto charts = make_charts(pieces, 1e-4);
  ASSERT_EQ(charts.size(), 1u);
  EXPECT_EQ(charts[0].pieces, (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

TEST(Charts, DiscsFitInSquaresButNotInStrips) {
  const SurfacePieces pieces =
      whole({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {5, 0, 0}, {9, 0, 0}, {9, 0.2, 0}, {5, 0.2, 0}},
            {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}});
  const auto charts = make_charts(pieces, 1e-4);
  ASSERT_EQ(charts.size(), 2u);
  EXPECT_TRUE(holds_disc(pieces, charts[0], 0.3));
  EXPECT_FALSE(holds_disc(pieces, charts[1], 0.12));
  EXPECT_TRUE(holds_disc(pieces, charts[1], 0.09));
}

}  // namespace
}  // namespace vantage
