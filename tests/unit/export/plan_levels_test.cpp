// SPDX-License-Identifier: Apache-2.0
#include "export/plan_levels.hpp"

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

}  // namespace
}  // namespace vantage
