// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "scene/room_floors.hpp"
#include "scene/scene_data.hpp"
#include "support/glb_builder.hpp"
#include "vantage/error.hpp"
#include "vantage/scene.hpp"

namespace vantage {
namespace {

// An L of 16 m² with a shaft of 1 m² in it.
Room with_shaft() {
  return {.name = "hall",
          .storey = "",
          .box = {{0, 0, 0}, {5, 4, 3}},
          .outline = {{{0, 0}, {5, 0}, {5, 2}, {3, 2}, {3, 4}, {0, 4}}, {{1, 1}, {1, 2}, {2, 2}, {2, 1}}}};
}

TEST(Rooms, FloorIsWithinTheOutlineWithoutItsHoles) {
  EXPECT_DOUBLE_EQ(floor_area(with_shaft()), 15);
  EXPECT_DOUBLE_EQ(floor_area({.name = "", .storey = "", .box = {{1, 1, 0}, {3, 4, 3}}}), 6);
}

TEST(Rooms, DistanceIsThatFromTheOutlineAndTheHeights) {
  const Room room = with_shaft();
  EXPECT_EQ(distance_to(room, {0.5, 0.5, 1}, 1), 0);
  EXPECT_NEAR(distance_to(room, {3.5, 3, 1}, 1), 0.5, 1e-12) << "in the box, outside the L";
  EXPECT_NEAR(distance_to(room, {1.5, 1.4, 1}, 1), 0.4, 1e-12) << "in the shaft";
  EXPECT_NEAR(distance_to(room, {-0.3, 1, 3.4}, 1), 0.5, 1e-12);
  EXPECT_EQ(distance_to(room, {50, 1, 1}, 1), 1);
}

TEST(Rooms, AWallBelongsToTheRoomThatItsFaceIsNearerTo) {
  const std::vector<Room> rooms{{.name = "a", .storey = "", .box = {{0, 0, 0}, {4, 4, 3}}},
                                {.name = "b", .storey = "", .box = {{4.1, 0, 0}, {8, 4, 3}}}};
  EXPECT_EQ(room_at(rooms, {4.01, 2, 1}), 0u);
  EXPECT_EQ(room_at(rooms, {4.09, 2, 1}), 1u);
  EXPECT_EQ(room_at(rooms, {2, 2, 1}, 0), 0u);
  EXPECT_EQ(room_at(rooms, {4.05, 2, 1}, 0), std::nullopt);
  EXPECT_EQ(room_at(rooms, {2, 2, 3.2}), std::nullopt);
  EXPECT_EQ(room_at({}, {2, 2, 1}), std::nullopt);
}

test::GlbBuilder with_a_room() {
  test::GlbBuilder builder;
  builder.triangle("wall");
  const int storey = builder.node(
      {{"name", "IfcBuildingStorey EG"}, {"extras", {{"vantage", {{"class", "IfcBuildingStorey"}, {"name", "EG"}}}}}});
  const int part = builder.child(storey, {{"name", "part"}});
  const nlohmann::json box = {{1, 0, -4}, {3, 2.5, -1}};  // Y up
  builder.child(part, {{"name", "IfcSpace 7"},
                       {"extras",
                        {{"vantage",
                          {{"class", "IfcSpace"},
                           {"name", "7"},
                           {"long_name", "Kitchen"},
                           {"box", box},
                           {"footprint", {{{1, -1}, {3, -1}, {3, -4}, {1, -4}}}}}}}}});
  return builder;
}

TEST(Rooms, AreReadWithTheStoreyAboveThem) {
  const Scene scene = load(with_a_room());
  ASSERT_EQ(scene.rooms().size(), 1u);
  const Room& room = scene.rooms()[0];
  EXPECT_EQ(room.name, "7 Kitchen");
  EXPECT_EQ(room.storey, "EG");
  EXPECT_EQ(room.box.min, (Vec3{1, 1, 0}));
  EXPECT_EQ(room.box.max, (Vec3{3, 4, 2.5}));
  ASSERT_EQ(room.outline.size(), 1u);
  EXPECT_EQ(room.outline[0][2], (std::array<double, 2>{3, 4}));
  EXPECT_DOUBLE_EQ(floor_area(room), 6);
}

TEST(Rooms, ADamagedOutlineIsAnError) {
  for (const nlohmann::json& outline : std::vector<nlohmann::json>{3, {3}, {{3}}, {{{3, "x"}}}, {{{1, 2, 3}}}}) {
    test::GlbBuilder builder = with_a_room();
    builder.json["nodes"].back()["extras"]["vantage"]["footprint"] = outline;
    EXPECT_THROW(load(builder), Error) << outline;
  }
}

// A level rectangle (x, y, x, y), its corners at the heights of its two ends along y.
void add_rectangle(test::GlbBuilder& builder, const char* name, const std::array<float, 4>& at, float z0, float z1) {
  const std::vector<float> corners{at[0], z0, -at[1], at[2], z0, -at[1], at[2], z1, -at[3],
                                   at[0], z0, -at[1], at[2], z1, -at[3], at[0], z1, -at[3]};  // Y up
  const int mesh = builder.mesh({{"attributes", {{"POSITION", builder.positions(corners)}}}});
  builder.node({{"name", name}, {"mesh", mesh}});
}

// Area of the floors that were laid, seen from above, and whether they lie over a place; 0 without any.
struct Laid {
  double area = 0;
  bool over = false;
};
Laid laid(const Scene& scene, double x, double y) {
  Laid found;
  const SceneData& data = scene.data();
  for (std::size_t m = 0; m < data.meshes.size(); ++m) {
    if (data.meshes[m].name != kRoomFloors) continue;
    EXPECT_EQ(data.meshes[m].role, Role::blocking);
    for (std::uint32_t i = 0; i < data.ranges[m].triangle_count; ++i) {
      std::array<Vec3, 3> p;
      for (std::size_t k = 0; k < 3; ++k)
        p[k] = widen(data.positions[data.triangles[data.ranges[m].first_triangle + i][k]]) + data.origin;
      const auto turn = [&](const Vec3& a, const Vec3& b) { return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x); };
      const double twice = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
      EXPECT_GT(twice, 0) << "upward";
      found.area += twice / 2;
      found.over = found.over || (turn(p[0], p[1]) >= 0 && turn(p[1], p[2]) >= 0 && turn(p[2], p[0]) >= 0);
    }
  }
  return found;
}

TEST(RoomFloors, AreLaidUnderARoomWithoutOneAndUnderItsWalls) {
  const Scene scene = load(with_a_room());
  const double pi = std::acos(-1), grown = 2 * 3 + 0.3 * 10 + pi * 0.09;  // walls of 0.3 m around 2 m by 3 m
  EXPECT_NEAR(laid(scene, 2, 2).area, grown, 0.25) << "in cells of 0.1 m";
  EXPECT_TRUE(laid(scene, 2, 2).over);
  EXPECT_TRUE(laid(scene, 3.15, 2).over) << "in a doorway";
  EXPECT_FALSE(laid(scene, 3.5, 2).over);
  ASSERT_FALSE(scene.notes().empty());
  EXPECT_NE(scene.notes().back().find("1 of 1 room has no floor in the model"), std::string::npos);
}

TEST(RoomFloors, AFloorUnderPartOfARoomIsEnough) {
  test::GlbBuilder builder = with_a_room();
  add_rectangle(builder, "slab", {1, 1, 3, 3}, -0.2F, -0.2F);
  EXPECT_EQ(laid(load(builder), 2, 3.5).area, 0);
  test::GlbBuilder deep = with_a_room();
  add_rectangle(deep, "ceiling below", {1, 1, 3, 3}, -0.5F, -0.5F);
  EXPECT_GT(laid(load(deep), 2, 3.5).area, 0);
}

TEST(RoomFloors, AreOpenOverAStair) {
  for (const char* name : {"IfcStairFlight 1", "IfcBeam 1"}) {
    test::GlbBuilder builder = with_a_room();
    add_rectangle(builder, name, {1, 1, 2, 3}, -2, -0.2F);
    const bool stair = std::string(name).starts_with("IfcStair");
    const Scene scene = load(builder);
    EXPECT_EQ(laid(scene, 1.5, 2).over, !stair);
    EXPECT_TRUE(laid(scene, 2.5, 2).over);
    EXPECT_TRUE(laid(scene, 1.5, 3.5).over);
  }
}

TEST(RoomFloors, ComeBeforeGlass) {
  test::GlbBuilder builder = with_a_room();
  add_rectangle(builder, "pane", {0, 0, 1, 0}, 0, 2);
  builder.json["nodes"].back()["extras"]["vantage"]["glass"] = true;
  const Scene scene = load(builder);
  const SceneData& data = scene.data();
  ASSERT_EQ(data.meshes.size(), 3u);
  EXPECT_EQ(data.meshes[1].name, kRoomFloors);
  EXPECT_TRUE(data.meshes[2].glass);
  EXPECT_EQ(data.ranges[2].first_triangle, data.ranges[1].first_triangle + data.ranges[1].triangle_count);
  EXPECT_EQ(data.opaque_triangles().size(), data.triangles.size() - data.ranges[2].triangle_count);
}

TEST(RoomFloors, ARoomWithoutSizeOrOfAnAbsurdOneGetsNone) {
  for (const nlohmann::json& box : std::vector<nlohmann::json>{
           {{1, 0, -4}, {1, 2.5, -1}}, {{-1e30, 0, -4}, {1e30, 2.5, -1}}, {{1e12, 0, -4}, {1e12 + 2, 2.5, -1}}}) {
    test::GlbBuilder builder = with_a_room();
    builder.json["nodes"].back()["extras"]["vantage"]["box"] = box;
    EXPECT_EQ(laid(load(builder), 2, 2).area, 0) << box;
  }
}

}  // namespace
}  // namespace vantage
