// SPDX-License-Identifier: Apache-2.0
#include "report/surface_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/quad_scene.hpp"

namespace vantage {
namespace {

Vec3 place(const SurfaceMesh& mesh, std::uint32_t vertex) {
  const Vec3 size = mesh.box.size();
  const auto& p = mesh.positions[vertex];
  return mesh.box.min + Vec3{size.x * p[0] / 65535, size.y * p[1] / 65535, size.z * p[2] / 65535};
}

double area(const SurfaceMesh& mesh, std::uint8_t kind) {
  double sum = 0;
  for (std::size_t k = 0; k < mesh.triangles.size(); k += 3) {
    if (mesh.kinds[mesh.triangles[k]] != kind) continue;
    const Vec3 a = place(mesh, mesh.triangles[k]), b = place(mesh, mesh.triangles[k + 1]),
               c = place(mesh, mesh.triangles[k + 2]);
    const Vec3 n = cross(b - a, c - a);
    sum += std::sqrt(dot(n, n)) / 2;
  }
  return sum;
}

// A sphere of n × 2n squares, a corner at a time as files have them.
SceneData sphere(int n, float radius, bool closed) {
  SceneData scene;
  const auto at = [&](int i, int j) {
    const double zenith = M_PI * i / n, azimuth = 2 * M_PI * (j % (2 * n)) / (2 * n);
    const double r = i == 0 || i == n ? 0 : std::sin(zenith);
    return Float3{static_cast<float>(radius * r * std::cos(azimuth)),
                  static_cast<float>(radius * r * std::sin(azimuth)), static_cast<float>(radius * std::cos(zenith))};
  };
  const auto triangle = [&](const Float3& a, const Float3& b, const Float3& c) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    scene.positions.insert(scene.positions.end(), {a, b, c});
    scene.triangles.push_back({first, first + 1, first + 2});
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      if (i > 0) triangle(at(i, j), at(i + 1, j), at(i, j + 1));
      if (i + 1 < n) triangle(at(i, j + 1), at(i + 1, j), at(i + 1, j + 1));
    }
  if (!closed) scene.triangles.pop_back();
  const auto count = static_cast<std::uint32_t>(scene.triangles.size());
  scene.ranges = {{0, count, 0}};
  scene.meshes = {{.name = "sphere", .triangle_count = count}};
  return scene;
}

TEST(SurfaceMesh, KeepsASmallSceneAndItsRoles) {
  test::QuadScene quads = test::wall_and_floor();
  const SurfaceMesh mesh = surface_mesh(quads.data(), 100);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_EQ(mesh.positions.size(), 8u);
  EXPECT_EQ(mesh.error_m, 0);
  const double step = 20.0 / 65535;  // of the widest axis
  EXPECT_NEAR(area(mesh, kSurveyedVertex), 24, 10 * step);
  EXPECT_NEAR(area(mesh, 0), 400, 40 * step);
  EXPECT_NEAR(mesh.surveyed.min.x, 5, step);
  EXPECT_NEAR(mesh.box.min.x, -10, step);
}

TEST(SurfaceMesh, TellsClosedSurfacesFromOpenOnes) {
  for (const bool closed : {true, false}) {
    const SurfaceMesh mesh = surface_mesh(sphere(12, 3, closed), 100'000);
    for (const std::uint8_t kind : mesh.kinds) ASSERT_EQ(kind, kSurveyedVertex | (closed ? kSolidVertex : 0));
  }
}

// Four walls around a yard: their area vectors cancel, and yet nothing is inside of them.
TEST(SurfaceMesh, ARingOfWallsIsNotClosed) {
  test::QuadScene ring;
  ring.quad({0, 0, 0}, {4, 0, 0}, {0, 0, 2}).quad({4, 0, 0}, {0, 4, 0}, {0, 0, 2});
  ring.quad({4, 4, 0}, {-4, 0, 0}, {0, 0, 2}).quad({0, 4, 0}, {0, -4, 0}, {0, 0, 2});
  for (const std::uint8_t kind : surface_mesh(ring.data(), 100).kinds) EXPECT_EQ(kind, kSurveyedVertex);
}

TEST(SurfaceMesh, IsMadeSimplerAndKeepsItsShape) {
  constexpr std::size_t wanted = 2'000;
  const SurfaceMesh mesh = surface_mesh(sphere(100, 5, true), wanted);
  EXPECT_LE(mesh.triangles.size() / 3, wanted + wanted / 4);
  EXPECT_GE(mesh.triangles.size() / 3, wanted / 2);
  EXPECT_GT(mesh.error_m, 0);
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3 p = place(mesh, v);
    EXPECT_NEAR(std::sqrt(dot(p, p)), 5, 0.02);
  }
  EXPECT_NEAR(area(mesh, kSurveyedVertex | kSolidVertex), 4 * M_PI * 25, 0.01 * 4 * M_PI * 25);
  for (std::size_t k = 0, fresh = 0; k < mesh.triangles.size(); ++k) {  // new vertices come in order
    ASSERT_LE(mesh.triangles[k], fresh);
    if (mesh.triangles[k] == fresh) ++fresh;
  }
}

// Many parts that no edge collapse makes fewer.
TEST(SurfaceMesh, ClustersWhatCannotBeMadeSimpler) {
  test::QuadScene tiles;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j)
      tiles.quad({static_cast<float>(i), static_cast<float>(j), 0}, {0.5f, 0, 0}, {0, 0.5f, 0});
  const SurfaceMesh mesh = surface_mesh(tiles.data(), 1'000);
  EXPECT_LE(mesh.triangles.size() / 3, 1'250u);
  EXPECT_GT(mesh.triangles.size(), 0u);
}

}  // namespace
}  // namespace vantage
