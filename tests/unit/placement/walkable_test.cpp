// SPDX-License-Identifier: Apache-2.0
#include "placement/walkable.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "placement/plane_quadtree.hpp"
#include "placement_scenes.hpp"
#include "vantage/error.hpp"
#include "vantage/placement.hpp"

namespace vantage {
namespace {

double true_area(const SearchMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 n = cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
    sum += 0.5 * std::sqrt(dot(n, n));
  }
  return sum;
}

// Survey-frame ground points of random (u, v), those that exist.
std::vector<Vec3> random_places(const SearchArea& area, int count) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Vec3> places;
  const Uv low = area.uv_min(), high = area.uv_max();
  for (int i = 0; i < count; ++i)
    if (const auto p = area.locate({low.u + unit(rng) * (high.u - low.u), low.v + unit(rng) * (high.v - low.v)}))
      places.push_back(*p);
  return places;
}

const Vec3 origin{1000, 2000, 30};  // of the scenes that Builder makes

TEST(Walkable, GroundOfTwoTrianglesHasAHoleUnderABox) {
  const Scene scene = test::Builder().floor(-10, -10, 10, 10, 0).box({2, 2, 1}, {6, 6, 1.5}).scene();
  const SearchArea area = SearchArea::build(scene);
  EXPECT_TRUE(area.derived());
  EXPECT_NE(area.description().find("walkable"), std::string::npos);
  EXPECT_NEAR(true_area(area.mesh()), 400, 10);  // less 16 under the box, plus 16 on top of it
  int on_top = 0;
  for (const Vec3& p : random_places(area, 20000)) {
    const Vec3 q = p - origin;
    if (q.z > 1) {
      ++on_top;
      EXPECT_NEAR(q.z, 1.5, 1e-6);
      continue;
    }
    EXPECT_FALSE(q.x > 2.4 && q.x < 5.6 && q.y > 2.4 && q.y < 5.6) << q.x << ' ' << q.y;
  }
  EXPECT_GT(on_top, 100);
}

// A house drawn as a closed shell stands on ground that goes on beneath it, in bumps that level rays near the ground
// run into.
TEST(Walkable, NoPlaceWithinAShellOnBumpyGround) {
  test::Builder builder;
  const auto z = [](int x, int y) { return 0.15 * ((x + y) % 2); };
  for (int x = -10; x < 10; ++x)
    for (int y = -10; y < 10; ++y) {
      const double a = x, b = y;
      builder.quad({a, b, z(x, y)}, {a + 1, b, z(x + 1, y)}, {a + 1, b + 1, z(x + 1, y + 1)}, {a, b + 1, z(x, y + 1)});
    }
  builder.box({-4.5, -4.5, -0.5}, {3.5, 3.5, 6});
  const SearchArea area = SearchArea::build(builder.scene());
  int outside = 0;
  for (const Vec3& p : random_places(area, 20000)) {
    const Vec3 q = p - origin;
    if (q.z > 1) continue;  // on top of it
    ++outside;
    EXPECT_FALSE(q.x > -4 && q.x < 3 && q.y > -4 && q.y < 3) << q.x << ' ' << q.y;
  }
  EXPECT_GT(outside, 1000);
}

TEST(Walkable, FloorUnderAHighPlatformStaysAndBothHaveTheirOwnPlaces) {
  const Scene scene = test::Builder().floor(-5, -5, 5, 5, 0).box({-2, -2, 2.5}, {2, 2, 2.6}).scene();
  const SearchArea area = SearchArea::build(scene);
  EXPECT_NEAR(true_area(area.mesh()), 116, 1e-6);
  const Uv below = area.project(origin + Vec3{0, 0, 0.1}).value(),
           above = area.project(origin + Vec3{0, 0, 2.4}).value();
  EXPECT_NEAR(area.locate(below)->z - origin.z, 0, 1e-6);
  EXPECT_NEAR(area.locate(above)->z - origin.z, 2.6, 1e-6);
}

TEST(Walkable, SteepLowAndSmallSurfacesAreLeftOut) {
  const Scene scene = test::Builder()
                          .floor(-5, -5, 5, 5, 0)
                          .quad({5, -5, 0}, {9, -5, 4}, {9, 5, 4}, {5, 5, 0})  // 45°
                          .floor(20, 0, 20.3, 0.3, 0)                          // 0.09 m²
                          .floor(22, 0, 28, 0.15, 0)                           // the top of a pipe
                          .scene();
  const SearchArea area = SearchArea::build(scene);
  EXPECT_NEAR(true_area(area.mesh()), 100, 1e-6);
  const SearchArea steep =
      SearchArea::build(scene, {.max_slope = Angle::degrees(50), .headroom_m = 2, .min_area_m2 = 0.01});
  EXPECT_GT(true_area(steep.mesh()), 150);
}

TEST(Walkable, DenseGroundGivesTheSamePlacesAsCoarse) {
  test::Builder dense;
  for (int j = 0; j < 80; ++j)
    for (int i = 0; i < 80; ++i)
      dense.floor(-10 + i * 0.25, -10 + j * 0.25, -10 + (i + 1) * 0.25, -10 + (j + 1) * 0.25, 0);
  dense.box({2, 2, 0}, {6, 6, 1.5});
  const SearchArea area = SearchArea::build(dense.scene());
  EXPECT_NEAR(true_area(area.mesh()), 400, 5);
  EXPECT_NEAR(area.locate(area.project(origin + Vec3{-7, 3, 0}).value())->x, origin.x - 7, 1e-6);
  EXPECT_EQ(area.uv_max().v, 1);
}

TEST(Walkable, AMachineInTheVoidStandsOnALaidPlane) {
  const Scene scene = test::Builder().box({-2, -1, -3}, {2, 1, 0}).box({-1, -0.5, 0}, {1, 0.5, 1}).scene();
  const SearchArea area = SearchArea::build(scene);
  EXPECT_TRUE(area.derived());
  EXPECT_NE(area.description().find("plane laid under the model"), std::string::npos);
  EXPECT_NEAR(true_area(area.mesh()), 12 * 10 - 8, 1);
  for (const Vec3& p : random_places(area, 5000)) {
    const Vec3 q = p - origin;
    EXPECT_NEAR(q.z, -3, 1e-6);
    EXPECT_FALSE(std::abs(q.x) < 1.9 && std::abs(q.y) < 0.9) << "under the machine";
  }
}

TEST(Walkable, WallsAloneStandOnALaidPlane) {
  const Scene scene = test::Builder().quad({0, 0, 0}, {5, 0, 0}, {5, 0, 2.5}, {0, 0, 2.5}).scene();
  const SearchArea area = SearchArea::build(scene);
  EXPECT_TRUE(area.derived());
  EXPECT_NEAR(true_area(area.mesh()), 15 * 10, 1e-6);
  EXPECT_EQ(area.locate({0.1, 0.1})->z, 30);
}

TEST(Walkable, TinyAndHugeModelsGetTheSamePlaces) {
  for (const double scale : {1e-3, 1.0, 1e3}) {
    const double s = scale;
    const Scene scene = test::Builder()
                            .floor(-10 * s, -10 * s, 10 * s, 10 * s, 0)
                            .box({2 * s, 2 * s, 0}, {6 * s, 6 * s, 3 * s})
                            .scene();
    const SearchArea area =
        SearchArea::build(scene, {.max_slope = Angle::degrees(35), .headroom_m = 2 * s, .min_area_m2 = 0.25 * s * s});
    EXPECT_NEAR(true_area(area.mesh()) / (s * s), 400, 8);
  }
}

TEST(Walkable, AMarkedAreaWithoutUvIsUnfolded) {
  SceneData data = test::Builder().box({0, 0, 0}, {2, 2, 2}).data();
  data.search_positions = {{1000, 2000, 30}, {1010, 2000, 30}, {1010, 2005, 31}, {1000, 2005, 31},
                           {1002, 2001, 35}, {1006, 2001, 35}, {1006, 2003, 35}};
  data.search_triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}};
  const SearchArea area = SearchArea::build(Scene(std::make_shared<const SceneData>(data)));
  EXPECT_FALSE(area.derived());
  EXPECT_NE(area.description().find("(u, v) generated"), std::string::npos);
  EXPECT_EQ(area.mesh().triangles.size(), 3u);
  EXPECT_NEAR(area.locate(area.project({1005, 2002, 30}).value())->z, 30.4, 1e-9);
  EXPECT_NEAR(area.locate(area.project({1005, 2002, 36}).value())->z, 35, 1e-9);

  for (Triangle& t : data.search_triangles) std::swap(t[0], t[1]);  // upside down
  EXPECT_EQ(SearchArea::build(Scene(std::make_shared<const SceneData>(data))).mesh().triangles.size(), 3u);
  data.search_uvs.assign(7, Uv{0.5, 0.5});  // (u, v) of no use
  EXPECT_EQ(SearchArea::build(Scene(std::make_shared<const SceneData>(data))).mesh().triangles.size(), 3u);
}

TEST(Walkable, RefusesOptionsThatMakeNoSense) {
  const Scene scene = test::Builder().floor(-1, -1, 1, 1, 0).scene();
  for (const WalkableOptions& options : {WalkableOptions{Angle::degrees(90)},
                                         {Angle::degrees(-1)},
                                         {Angle::degrees(30), -1},
                                         {Angle::degrees(30), 2, std::nan("")}})
    EXPECT_THROW(SearchArea::build(scene, options), Error);
}

TEST(Walkable, NothingAtAllIsAnError) { EXPECT_THROW(find_walkable_surface(SceneData{}, {}), Error); }

}  // namespace
}  // namespace vantage
