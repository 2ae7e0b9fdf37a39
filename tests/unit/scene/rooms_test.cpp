// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace vantage
