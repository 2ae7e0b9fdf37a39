// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "map/plan_levels.hpp"
#include "unit/placement/placement_scenes.hpp"
#include "vantage/summary.hpp"

namespace vantage {
namespace {

using test::origin;

// Walls of 0.3 m, a roof at 2.8 m and a door of 1.2 m to the south.
void add_house(test::Builder& builder, double x, double y, double width, double depth) {
  const double east = x + width, north = y + depth, door = x + width / 2;
  builder.box({x, y, 0}, {x + 0.3, north, 2.8}).box({east - 0.3, y, 0}, {east, north, 2.8});
  builder.box({x, north - 0.3, 0}, {east, north, 2.8});
  builder.box({x, y, 0}, {door - 0.6, y + 0.3, 2.8}).box({door + 0.6, y, 0}, {east, y + 0.3, 2.8});
  builder.box({door - 0.6, y, 2.2}, {door + 0.6, y + 0.3, 2.8});
  builder.box({x, y, 2.8}, {east, north, 3});
}

// Two houses and a canopy without walls on a lawn.
struct Lawn {
  Scene scene = [] {
    test::Builder builder;
    builder.floor(-20, -20, 20, 20, 0);
    add_house(builder, 0, 0, 9, 7);
    add_house(builder, -15, 5, 7, 6);
    builder.box({8, -16, 3}, {15, -9, 3.2});
    SceneData data = builder.scene().data();
    data.rooms = {{.name = "Hall", .box = {origin + Vec3{0.3, 0.3, 0}, origin + Vec3{8.7, 6.7, 2.8}}},
                  {.name = "Shed", .box = {origin + Vec3{-14.7, 5.3, 0}, origin + Vec3{-8.3, 10.7, 2.8}}},
                  {.name = "Vault", .box = {origin + Vec3{2, 2, -5}, origin + Vec3{4, 4, -2.5}}}};
    return Scene(std::make_shared<const SceneData>(std::move(data)));
  }();
  SearchArea area = SearchArea::build(scene);

  // Twenty stations on the lawn, and others.
  static std::vector<PlacedStation> stations(const std::vector<Vec3>& others) {
    std::vector<PlacedStation> all;
    const auto add = [&](const Vec3& ground) {
      all.push_back({.uv = {}, .position = origin + ground + Vec3{0, 0, 1.85}, .ground = origin + ground});
    };
    for (int k = 0; k < 20; ++k) add({-18 + 1.8 * k, -6, 0});
    for (const Vec3& ground : others) add(ground);
    return all;
  }
};

// A marked search area of two triangles that reach beyond the room.
TEST(FloorParts, CountTheGroundOfRoomsInLargeTriangles) {
  test::Builder builder;
  builder.floor(-20, -20, 20, 20, 0);
  SceneData data = builder.scene().data();
  data.rooms = {{.name = "Hall", .box = {origin + Vec3{1, 1, 0}, origin + Vec3{5, 4, 2.8}}}};
  const Scene scene(std::make_shared<const SceneData>(std::move(data)));
  const SearchArea area = SearchArea::from_mesh({.positions = {origin + Vec3{-20, -20, 0}, origin + Vec3{20, -20, 0},
                                                               origin + Vec3{20, 20, 0}, origin + Vec3{-20, 20, 0}},
                                                 .uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
                                                 .triangles = {{0, 1, 2}, {0, 2, 3}}});
  const std::vector<FloorPart> parts = floor_parts(scene, area, {});
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_NEAR(parts[0].area_m2, 12, 0.5);
  EXPECT_NEAR(parts[0].place.x, origin.x + 3, 0.4);
  EXPECT_NEAR(parts[0].place.y, origin.y + 2.5, 0.4);
}

// Cells of a large map that lie half on the ground beside a block have its roof above them.
TEST(FloorParts, BlocksOnAPlaneThatNobodyEntersAreNoBuildings) {
  test::Builder builder;
  for (int k = 0; k < 4; ++k) builder.box({45.0 * k + 0.4, 20, 0}, {45.0 * k + 14, 33, 9});
  const Scene scene = builder.scene();
  const SearchArea area = SearchArea::build(scene);
  EXPECT_TRUE(area.on_plane());
  for (const FloorPart& part : floor_parts(scene, area, {}))
    ADD_FAILURE() << part.name << ", " << part.area_m2 << " m²";
}

TEST(FloorParts, GroundUnderEavesIsNoBuilding) {
  test::Builder builder;
  builder.floor(-20, -20, 60, 20, 0);
  for (const double x : {0.0, 20.0, 40.0})
    builder.box({x, 0, 0}, {x + 9, 8, 5}).box({x - 0.8, -0.8, 5}, {x + 9.8, 8.8, 5.3});
  const Scene scene = builder.scene();
  for (const FloorPart& part : floor_parts(scene, SearchArea::build(scene), {}))
    ADD_FAILURE() << part.name << ", " << part.area_m2 << " m²";
}

TEST(FloorParts, AreBuildingsAndRoomsWithTheirStations) {
  const Lawn lawn;
  const std::vector<FloorPart> parts = floor_parts(lawn.scene, lawn.area, Lawn::stations({{4, 4, 0}, {11, -12, 0}}));
  ASSERT_EQ(parts.size(), 5u) << "no storeys, and a canopy is no building";
  EXPECT_EQ(parts[0].name, "building 1");
  EXPECT_NEAR(parts[0].area_m2, 8.4 * 6.4, 8) << "the larger house but for what is near to its walls";
  EXPECT_EQ(parts[0].stations, 1u);
  EXPECT_EQ(parts[1].name, "building 2");
  EXPECT_NEAR(parts[1].area_m2, 6.4 * 5.4, 8);
  EXPECT_EQ(parts[1].stations, 0u);
  EXPECT_GT(parts[1].place.x, origin.x - 15);
  EXPECT_LT(parts[1].place.x, origin.x - 8);
  EXPECT_EQ(parts[2].name, "Hall");
  EXPECT_EQ(parts[2].stations, 1u);
  EXPECT_EQ(parts[3].stations, 0u);
  EXPECT_EQ(parts[4].area_m2, 0);

  const auto lines = ground_lines(lawn.scene, lawn.area, Lawn::stations({{4, 4, 0}}));
  ASSERT_GE(lines.size(), 2u);
  EXPECT_EQ(lines[0].heading, "no station");
  EXPECT_EQ(lines[0].text.find("1 of 2 buildings without a station: building 2 (98"), 0u) << lines[0].text;
  EXPECT_EQ(lines[1].text.find("2 of 3 rooms without a station: Shed (z = 30.00 m), "), 0u) << lines[1].text;
  EXPECT_NE(lines[1].text.find("; Vault (z = 25.00 m), none of its floor is reached"), std::string::npos)
      << lines[1].text;
  EXPECT_TRUE(std::ranges::none_of(ground_lines(lawn.scene, lawn.area, {}), [](const SummaryLine& line) {
    return line.heading == "no station";
  })) << "nothing is said where no station is";
}

TEST(FloorParts, MoreStationsThanOneForFiveSquareMetresAreTold) {
  const Scene scene = test::Builder().floor(0, 0, 4, 5, 0).scene();
  const SearchArea area = SearchArea::from_mesh(
      {.positions = {origin, origin + Vec3{4, 0, 0}, origin + Vec3{4, 5, 0}, origin + Vec3{0, 5, 0}},
       .uvs = {{0, 0}, {0.8, 0}, {0.8, 1}, {0, 1}},
       .triangles = {{0, 1, 2}, {0, 2, 3}}});
  const auto told = [&](std::size_t stations) {
    const auto lines = ground_lines(scene, area, std::vector<PlacedStation>(stations));
    return lines.empty() ? std::string() : lines.front().heading + ": " + lines.front().text;
  };
  EXPECT_EQ(told(4), "");
  EXPECT_TRUE(told(5).starts_with("crowded: 5 stations on 20 m² of floor, more than one for each 5 m²")) << told(5);
}

TEST(FloorParts, AreStoreys) {
  const Scene scene = test::Builder().floor(-10, -10, 10, 10, 0).box({-10, -10, 3}, {10, 10, 3.2}).scene();
  SearchMesh mesh;
  for (const double z : {0.0, 3.2}) {
    const auto n = static_cast<std::uint32_t>(mesh.positions.size());
    for (const auto& [x, y] : {std::pair{-10, -10}, {10, -10}, {10, 10}, {-10, 10}}) {
      mesh.positions.push_back(origin + Vec3{static_cast<double>(x), static_cast<double>(y), z});
      mesh.uvs.push_back({x / 20.0 + z, y / 20.0});
    }
    mesh.triangles.push_back({n, n + 1, n + 2}), mesh.triangles.push_back({n, n + 2, n + 3});
  }
  const SearchArea area = SearchArea::from_mesh(mesh);
  std::vector<PlacedStation> stations = Lawn::stations({});
  const auto lines = ground_lines(scene, area, stations);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].text, "1 of 2 storeys without a station: storey 2 (z = 33.20 m), 400 m² of floor");
  stations[0].ground.z = origin.z + 3.2;
  EXPECT_TRUE(ground_lines(scene, area, stations).empty());
  stations[0].status = StationStatus::clash;
  EXPECT_EQ(ground_lines(scene, area, stations).size(), 1u) << "one that is left out does not count";
}

// A plan of a large lawn shows the rooms of a house in which one station of many stands.
TEST(PlanLevels, AHouseOnALawnIsCutIfAStationStandsInIt) {
  const Lawn lawn;
  const auto cut = [&](const std::vector<Vec3>& others) {
    const auto levels = cut_levels(lawn.scene, lawn.area.mesh(), Lawn::stations(others));
    EXPECT_EQ(levels.size(), 1u);
    return levels.front().cut;
  };
  EXPECT_FALSE(cut({}));
  ASSERT_TRUE(cut({{4, 4, 0}}));
  EXPECT_NEAR(*cut({{4, 4, 0}}), origin.z + 1.2, 0.01);
  EXPECT_FALSE(cut({{11, -12, 0}})) << "a canopy is seen from above";
  EXPECT_TRUE(cut({{11, -12, 0}, {10, -13, 0}, {12, -14, 0}})) << "unless more than a tenth stand below it";
}

}  // namespace
}  // namespace vantage
