// SPDX-License-Identifier: Apache-2.0
#include "formats/area_outline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vantage {
namespace {

// A rectangle of two triangles with vertices of its own.
void add(SearchMesh& mesh, double x0, double y0, double x1, double y1, double z = 0, bool down = false) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3& p : {Vec3{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}}) mesh.positions.push_back(p);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
  if (down) std::swap(mesh.triangles.back()[0], mesh.triangles.back()[1]);
}

// Positive where the ring runs counterclockwise, seen from above.
double area_of(const std::vector<Vec3>& ring) {
  double twice = 0;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec3 &a = ring[k], &b = ring[(k + 1) % ring.size()];
    twice += a.x * b.y - b.x * a.y;
  }
  return twice / 2;
}

TEST(AreaOutline, OfARectangleIsItsCorners) {
  SearchMesh mesh;
  add(mesh, 1, 2, 4, 3, 7, true);
  const auto rings = area_outline(mesh);
  ASSERT_EQ(rings.size(), 1u);
  EXPECT_EQ(rings[0].size(), 4u);
  EXPECT_DOUBLE_EQ(area_of(rings[0]), 3);
  for (const Vec3& p : rings[0]) EXPECT_EQ(p.z, 7);
}

TEST(AreaOutline, GoesThroughEdgesThatMeetOthersHalfway) {
  SearchMesh mesh;
  add(mesh, 0, 0, 10, 4);
  for (int k = 0; k < 5; ++k) add(mesh, 10, 0.8 * k, 12, 0.8 * (k + 1));
  const auto rings = area_outline(mesh);
  ASSERT_EQ(rings.size(), 1u);
  EXPECT_EQ(rings[0].size(), 4u);
  EXPECT_NEAR(area_of(rings[0]), 48, 1e-9);
}

TEST(AreaOutline, HolesRunTheOtherWayAndFloorsStayApart) {
  SearchMesh mesh;
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y)
      if (x != 1 || y != 1) add(mesh, x, y, x + 1, y + 1);
  add(mesh, 0, 0, 3, 3, 3.5);
  const auto rings = area_outline(mesh);
  ASSERT_EQ(rings.size(), 3u);
  double sum = 0, most = 0, least = 0;
  for (const auto& ring : rings) {
    EXPECT_EQ(ring.size(), 4u);
    const double area = area_of(ring);
    sum += area, most = std::max(most, area), least = std::min(least, area);
  }
  EXPECT_DOUBLE_EQ(sum, 8 + 9);
  EXPECT_DOUBLE_EQ(most, 9);
  EXPECT_DOUBLE_EQ(least, -1);
}

TEST(AreaOutline, KeepsAreasApartThatTouchInAPoint) {
  SearchMesh mesh;
  add(mesh, 0, 0, 1, 1), add(mesh, 1, 1, 2, 2);
  const auto rings = area_outline(mesh);
  ASSERT_EQ(rings.size(), 2u);
  for (const auto& ring : rings) EXPECT_DOUBLE_EQ(area_of(ring), 1);
}

TEST(AreaOutline, OfNothingIsNothing) {
  EXPECT_TRUE(area_outline({}).empty());
  SearchMesh flat;
  flat.positions = {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}}, flat.triangles = {{0, 1, 2}};
  EXPECT_TRUE(area_outline(flat).empty());
}

// Whatever cells of whatever sizes: rings hold just the area that the cells have.
TEST(AreaOutline, HoldsTheMeshsArea) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    SearchMesh mesh;
    double area = 0;
    for (int x = 0; x < 8; ++x)
      for (int y = 0; y < 8; ++y) {
        const unsigned kind = static_cast<unsigned>(random()) % 3;
        if (kind == 0) continue;
        const int parts = kind == 1 ? 1 : 3;
        for (int i = 0; i < parts; ++i)
          for (int j = 0; j < parts; ++j)
            add(mesh, 1e5 + x + double(i) / parts, 2e6 + y + double(j) / parts, 1e5 + x + double(i + 1) / parts,
                2e6 + y + double(j + 1) / parts, 50 + 0.05 * x, random() % 2 == 0);
        area += 1;
      }
    // Cells of one column lie level; those of the next 5 cm higher, so that rims meet rims.
    double sum = 0;
    for (const auto& ring : area_outline(mesh)) {
      std::vector<Vec3> moved;
      for (const Vec3& p : ring) moved.push_back(p - Vec3{1e5, 2e6, 0});
      sum += area_of(moved);
    }
    EXPECT_NEAR(sum, area, 1e-6) << "seed " << seed;
  }
}

}  // namespace
}  // namespace vantage
