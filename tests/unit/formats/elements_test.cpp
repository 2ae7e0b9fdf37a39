// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/quad_scene.hpp"
#include "support/temporary_folder.hpp"
#include "unit/formats/files.hpp"
#include "vantage/error.hpp"
#include "vantage/evaluate.hpp"
#include "vantage/export.hpp"

namespace vantage {
namespace {

constexpr double kStep_deg = 0.2;

// A wall 6 m wide and 4 m high at x = 5, one of 1 m² behind it, and one at x = −6 in two nodes of one name.
Scene walls() {
  test::QuadScene scene = test::wall_and_floor();
  scene.quad({8, 0, 0}, {0, 1, 0}, {0, 0, 1});
  scene.quad({-6, -3, -1}, {0, 3, 0}, {0, 0, 2});
  scene.quad({-6, 0, -1}, {0, 3, 0}, {0, 0, 2});
  const char* names[] = {"IfcWall North wall 2O2Fr$t4X7Zf8NOew3FLOH", "floor", "IfcSlab behind", "panel", "panel"};
  for (std::size_t m = 0; m < std::size(names); ++m) scene.data().meshes[m].name = names[m];
  return scene.scene();
}

Simulator simulator_of(const Scene& scene) {
  return Simulator(scene, test::coarse_scanner(kStep_deg),
                   {.engine = Engine::embree, .user_size_m = 0.25, .point_spacing_m = 0.1});
}

std::vector<PlacedStation> stations_at(const std::vector<Vec3>& heads) {
  std::vector<PlacedStation> stations;
  for (const Vec3& head : heads) stations.push_back({.uv = {}, .position = head, .ground = head - Vec3{0, 0, 1.5}});
  return stations;
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

TEST(Elements, OfAWallAreWhatItsGeometrySays) {
  Simulator simulator = simulator_of(walls());
  const Evaluation found = evaluate_stations({.simulator = simulator}, stations_at({{0, 0, 0}}), {.field = true});
  const std::vector<ElementShare> elements = element_shares(simulator, found, found.field);
  ASSERT_EQ(elements.size(), 3u) << "without the floor, which is not surveyed, and the panel once";
  const ElementShare &wall = elements[0], &behind = elements[1], &panel = elements[2];
  EXPECT_EQ(wall.ifc_class, "IfcWall");
  EXPECT_EQ(wall.global_id, "2O2Fr$t4X7Zf8NOew3FLOH");
  EXPECT_EQ(behind.ifc_class, "IfcSlab");
  EXPECT_EQ(behind.global_id, "");
  EXPECT_EQ(panel.name, "panel");
  EXPECT_EQ(panel.ifc_class, "");
  EXPECT_NEAR(wall.area_m2, 24, 1e-4);
  EXPECT_NEAR(behind.area_m2, 1, 1e-4);
  EXPECT_NEAR(panel.area_m2, 12, 1e-4);
  EXPECT_GT(wall.captured.value(), 0.97) << "by two centimetres where ten were asked for, but at its foot";
  EXPECT_EQ(behind.captured, 0.0);
  EXPECT_GT(behind.voxels, 0u);
  EXPECT_FALSE(behind.incidence || behind.point_distance_m || behind.deviation_m);
  EXPECT_FALSE(wall.deviation_m) << "no registration was predicted";

  std::vector<double> angles, distances;
  const double step = kStep_deg * 3.14159265358979 / 180;
  for (double y = -2.95; y < 3; y += 0.1)
    for (double z = -1.45; z < 2.5; z += 0.1) {
      const double range = std::sqrt(25 + y * y + z * z), cosine = 5 / range, across = std::hypot(5, y) / range;
      angles.push_back(std::acos(cosine) * 180 / 3.14159265358979);
      distances.push_back(step * range * std::sqrt(across / cosine));
    }
  // Voxels at the wall's edges hold less of it, and count as much.
  EXPECT_NEAR(wall.incidence.value().in_degrees(), median(angles), 1);
  EXPECT_NEAR(wall.point_distance_m.value(), median(distances), 0.05 * median(distances));
}

TEST(Elements, HaveTheBestSightOfSeveralStationsAndTheirDeviation) {
  Simulator simulator = simulator_of(walls());
  const auto evaluated = [&](const std::vector<Vec3>& heads) {
    const Evaluation found = evaluate_stations({.simulator = simulator}, stations_at(heads),
                                               {.field = true, .registration = RegistrationOptions()});
    return element_shares(simulator, found, found.field);
  };
  const auto slanting = evaluated({{4.5, -2.5, 0}}), both = evaluated({{4.5, -2.5, 0}, {1, 0, 0}});
  EXPECT_LT(both[0].incidence->in_degrees(), slanting[0].incidence->in_degrees() - 10);
  EXPECT_LT(both[0].point_distance_m.value(), slanting[0].point_distance_m.value());
  ASSERT_TRUE(both[0].deviation_m);
  EXPECT_GT(*both[0].deviation_m, 0);
  EXPECT_FALSE(both[1].deviation_m) << "no station sees it";
}

TEST(Elements, AreATable) {
  const test::TemporaryFolder folder;
  const std::vector<ElementShare> elements{{.name = "=wall, \"A\"",
                                            .area_m2 = 2.5,
                                            .voxels = 40,
                                            .captured = 0.51236,
                                            .incidence = Angle::degrees(31.26),
                                            .point_distance_m = 0.01234,
                                            .deviation_m = 0.00126},
                                           {.name = "IfcDoor", .ifc_class = "IfcDoor", .area_m2 = 1}};
  write_elements_csv(folder / "elements.csv", elements);
  EXPECT_EQ(test::content(folder / "elements.csv"),
            "name,class,global_id,area_m2,voxels,captured,incidence,point_distance_mm,deviation_mm\n"
            "\"'=wall, \"\"A\"\"\",,,2.500,40,0.5124,31.3,12.3,1.3\n"
            "IfcDoor,IfcDoor,,1.000,0,,,,\n");
}

TEST(Elements, NeedThePointsOfEveryVoxel) {
  Simulator simulator = simulator_of(walls());
  const Evaluation found = evaluate_stations({.simulator = simulator}, stations_at({{0, 0, 0}}));
  EXPECT_THROW(element_shares(simulator, found, found.field), Error);
}

}  // namespace
}  // namespace vantage
