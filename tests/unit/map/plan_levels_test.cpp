// SPDX-License-Identifier: Apache-2.0
#include "map/plan_levels.hpp"

#include <gtest/gtest.h>

namespace vantage {
namespace {

void add_floor(SearchMesh& mesh, double x0, double x1, double z0, double z1, double depth = 10) {
  const auto n = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {{x0, 0, z0}, {x1, 0, z1}, {x1, depth, z1}, {x0, depth, z0}});
  mesh.triangles.insert(mesh.triangles.end(), {{n, n + 1, n + 2}, {n, n + 2, n + 3}});
}

TEST(PlanLevels, FloorsAboveEachOtherAreLevels) {
  SearchMesh house;
  add_floor(house, -20, 20, 100, 100);      // the ground and the lower floor
  add_floor(house, 0, 15, 103.2, 103.2);    // the upper floor
  add_floor(house, 15, 19, 103.2, 100, 1);  // stairs between them
  const auto levels = plan_levels(house);
  ASSERT_EQ(levels.size(), 2u);
  EXPECT_NEAR(levels[0].floor, 100, 1e-9);
  EXPECT_NEAR(levels[1].floor, 103.2, 1e-9);
  for (const double z : {-50.0, 100.0, 101.6, 102.5}) {
    EXPECT_TRUE(levels[0].holds(z)) << z;
    EXPECT_FALSE(levels[1].holds(z)) << z;
  }
  for (const double z : {103.0, 103.2, 500.0}) {
    EXPECT_FALSE(levels[0].holds(z)) << z;
    EXPECT_TRUE(levels[1].holds(z)) << z;
  }
}

TEST(PlanLevels, SlopesTerracesAndSmallThingsAreNone) {
  SearchMesh slope;
  add_floor(slope, 0, 100, 0, 30);
  EXPECT_EQ(plan_levels(slope).size(), 1u);
  EXPECT_NEAR(plan_levels(slope)[0].floor, 15, 0.5);
  SearchMesh terrace;
  add_floor(terrace, 0, 20, 0, 0), add_floor(terrace, 20, 40, 4, 4);
  EXPECT_EQ(plan_levels(terrace).size(), 1u);
  SearchMesh gallery;
  add_floor(gallery, 0, 40, 0, 0), add_floor(gallery, 0, 1, 3, 3);
  EXPECT_EQ(plan_levels(gallery).size(), 1u) << "a fortieth of the ground";
  EXPECT_EQ(plan_levels(SearchMesh{}).size(), 1u);
  EXPECT_TRUE(plan_levels(SearchMesh{})[0].holds(-1e9));
}

TEST(PlanLevels, AFrontGardenDoesNotHideTheFloorsOfATower) {
  SearchMesh tower;
  add_floor(tower, -100, 100, 0, 0);
  for (const double z : {3.0, 6.0, 9.0}) add_floor(tower, 0, 12, z, z);
  const auto levels = plan_levels(tower);
  ASSERT_EQ(levels.size(), 4u);
  EXPECT_NEAR(levels[3].floor, 9, 1e-9);
}

PlacedStation at(double x, double y, double z) { return {.uv = {}, .position = {x, y, z + 1.85}, .ground = {x, y, z}}; }

TEST(PlanLevels, StationsOverEachOtherAreOnLevelsOfTheirOwn) {
  SearchMesh estate;
  add_floor(estate, 0, 200, 0, 0, 200), add_floor(estate, 90, 100, 3, 3);  // a house on a fortieth of a percent
  EXPECT_EQ(plan_levels(estate).size(), 1u);
  const std::vector<PlacedStation> below{at(95, 5, 0)}, above{at(95, 5, 3)}, beside{at(10, 50, 0)};
  EXPECT_EQ(plan_levels(estate, beside).size(), 1u);
  for (const auto& stations : {below, above}) {
    const auto levels = plan_levels(estate, stations);
    ASSERT_EQ(levels.size(), 2u);
    EXPECT_NEAR(levels[1].floor, 3, 1e-9);
    EXPECT_TRUE(levels[stations[0].ground.z > 0 ? 1 : 0].holds(stations[0].ground.z));
  }
}

TEST(PlanLevels, ALandingHalfWayUpBelongsToTheFloorBelow) {
  SearchMesh house;
  add_floor(house, 0, 20, 0, 0), add_floor(house, 0, 20, 3.8, 3.8);
  add_floor(house, 20, 21, 0, 0), add_floor(house, 20, 21, 1.9, 1.9), add_floor(house, 20, 21, 5.7, 5.7);
  const auto levels = plan_levels(house, std::vector{at(20.5, 5, 1.9), at(20.5, 5, 5.7), at(5, 5, 0)});
  ASSERT_EQ(levels.size(), 2u);
  EXPECT_TRUE(levels[0].holds(1.9));
  EXPECT_TRUE(levels[1].holds(5.7));
}

// A square of ground with a roof over a corner of it.
Scene roofed_corner() {
  const std::vector<Vec3> p{{0, 0, 0},   {40, 0, 0},  {40, 40, 0}, {0, 40, 0},
                            {30, 30, 3}, {40, 30, 3}, {40, 40, 3}, {30, 40, 3}};
  return Scene::from_triangles(p,
                               std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}});
}

TEST(PlanLevels, ASiteIsCutWhereStationsStandUnderARoof) {
  const Scene scene = roofed_corner();
  SearchMesh ground;
  add_floor(ground, 0, 40, 0, 0, 40);
  const std::vector<PlacedStation> outside{at(5, 5, 0), at(20, 35, 0)}, some{at(5, 5, 0), at(35, 35, 0.1)};
  EXPECT_EQ(under_roof(scene, some), (std::vector<bool>{false, true}));
  EXPECT_FALSE(cut_levels(scene, ground, outside)[0].cut);
  const auto cut = cut_levels(scene, ground, some);
  ASSERT_EQ(cut.size(), 1u);
  ASSERT_TRUE(cut[0].cut);
  EXPECT_NEAR(cut[0].floor, 0.1, 1e-9);
  EXPECT_NEAR(*cut[0].cut, 1.3, 1e-9) << "1.2 m over the floor of the one under the roof";
  std::vector<PlacedStation> many(20, at(5, 5, 0));
  many.push_back(at(35, 35, 0));
  EXPECT_FALSE(cut_levels(scene, ground, many)[0].cut) << "one in twenty-one";
  EXPECT_FALSE(cut_levels(scene, ground, {})[0].cut) << "most of the ground is outside";
}

}  // namespace
}  // namespace vantage
