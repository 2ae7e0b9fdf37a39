// SPDX-License-Identifier: Apache-2.0
// Models in DXF: each form of a face, and blocks that place a box of 2 x 1 x 3 m, stand where they are drawn.
#include <cmath>
#include <functional>
#include <numbers>

#include "drawing.hpp"
#include "import_fixture.hpp"
#include "random_meshes.hpp"

namespace vantage::test {
namespace {

std::string point_groups(int code, const Vec3& p) {
  std::string out;
  for (const auto& [axis, value] : {std::pair{0, p.x}, std::pair{10, p.y}, std::pair{20, p.z}})
    out += std::to_string(code + axis) + "\n" + std::to_string(1000 * value) + "\n";
  return out;
}

const std::vector<Vec3> kCorners{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0},
                                 {0, 0, 3}, {2, 0, 3}, {2, 1, 3}, {0, 1, 3}};
const std::vector<std::vector<int>> kSides{{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                           {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

void add_box(DrawingText& d, const std::string& layer) {
  for (const auto& side : kSides) {
    std::string groups;
    for (int k = 0; k < 4; ++k)
      groups += point_groups(10 + k, kCorners[static_cast<std::size_t>(side[static_cast<std::size_t>(k)])]);
    d.raw("3DFACE", layer, groups);
  }
}

// A box in millimetres, as a block named Box.
DrawingText boxed() {
  DrawingText d(4, 1000);
  d.begin_block("Box");
  add_box(d, "0");
  d.end_block();
  return d;
}

class DxfModelTest : public ImportTest {
 protected:
  Scene load(const DrawingText& d) const {
    SceneOptions options;
    options.doors = {"closed"};
    return Scene::load(write("model.dxf", d.str()), options);
  }
  static void expect(const char* what, const Measures& is, double area, double volume, const Vec3& low,
                     const Vec3& high) {
    SCOPED_TRACE(what);
    EXPECT_NEAR(is.area_m2, area, 1e-4);
    EXPECT_NEAR(is.volume_m3, volume, 1e-4);
    for (const auto& [a, b] : {std::pair{is.bounds.min, low}, std::pair{is.bounds.max, high}}) {
      EXPECT_NEAR(a.x, b.x, 1e-5);
      EXPECT_NEAR(a.y, b.y, 1e-5);
      EXPECT_NEAR(a.z, b.z, 1e-5);
    }
  }
  void expect_note(const Scene& scene, const std::string& words) const {
    std::string all;
    for (const std::string& note : scene.notes()) all += note + "\n";
    EXPECT_NE(all.find(words), std::string::npos) << words << " is not in\n" << all;
  }
};

TEST_F(DxfModelTest, BlocksStandWhereTheyArePlaced) {
  DrawingText d = boxed();
  d.insert("turned", "BOX", 5, 5, 1, 1, 90);
  d.raw("INSERT", "sized", "2\nbox\n" + point_groups(10, {20, 0, 1}) + "41\n2\n42\n1\n43\n0.5\n");
  d.insert("mirrored", "Box", 40, 0, -1, 1);
  d.insert("row", "Box", 60, 0, 1, 1, 90, {3, 2, 4, 5});
  d.raw("INSERT", "below", "2\nBox\n" + point_groups(10, {5, 5, 0}) + "210\n0\n220\n0\n230\n-1\n");
  d.raw("INSERT", "lying", "2\nBox\n" + point_groups(10, {5, 5, 20}) + "210\n1\n220\n0\n230\n0\n");
  d.begin_block("Outer", 1, 0);
  d.insert("0", "box", 2, 0);
  d.end_block();
  d.insert("nested", "OUTER", 80, 0, 2, 1);
  const auto found = measures_of(load(d), false);
  ASSERT_EQ(found.size(), 7u);
  expect("turned", found.at("turned"), 22, 6, {4, 5, 0}, {5, 7, 3});
  expect("sized", found.at("sized"), 2 * (4 + 6 + 1.5), 6, {20, 0, 1}, {24, 1, 2.5});
  expect("mirrored", found.at("mirrored"), 22, 6, {38, 0, 0}, {40, 1, 3});
  expect("row", found.at("row"), 6 * 22, 36, {54, 0, 0}, {60, 10, 3});
  expect("below", found.at("below"), 22, 6, {-7, 5, -3}, {-5, 6, 0});
  // Its z axis is the world's x, its x the world's y, and its y the world's z.
  expect("lying", found.at("lying"), 22, 6, {20, 5, 5}, {23, 7, 6});
  expect("nested", found.at("nested"), 2 * (4 + 12 + 3), 12, {82, 0, 0}, {86, 1, 3});
}

TEST_F(DxfModelTest, EveryFormOfAFaceIsRead) {
  DrawingText d(4, 1000);
  add_box(d, "faces");
  // Forms stand in a row along y.
  const auto moved = [](const Vec3& p, double y) { return Vec3{p.x, p.y + y, p.z}; };
  std::string vertices, mesh = "71\n2\n72\n1\n91\n0\n92\n8\n";
  for (const Vec3& p : kCorners) {
    vertices += "0\nVERTEX\n8\npolyface\n" + point_groups(10, moved(p, 10)) + "70\n192\n";
    mesh += point_groups(10, moved(p, 20));
  }
  mesh += "93\n" + std::to_string(5 * kSides.size()) + "\n";
  for (const auto& side : kSides) {
    vertices += "0\nVERTEX\n8\npolyface\n" + point_groups(10, {0, 0, 0}) + "70\n128\n";
    mesh += "90\n4\n";
    for (std::size_t k = 0; k < 4; ++k) {
      vertices += std::to_string(71 + k) + "\n" + std::to_string((k == 2 ? -1 : 1) * (side[k] + 1)) + "\n";
      mesh += "90\n" + std::to_string(side[k]) + "\n";
    }
  }
  d.raw("POLYLINE", "polyface", "66\n1\n70\n64\n71\n8\n72\n6\n" + vertices + "0\nSEQEND\n");
  d.raw("MESH", "mesh", mesh + "94\n0\n95\n0\n90\n0\n");
  // A pipe of four sides along z, closed around it, as a mesh of 2 x 4 places.
  std::string grid;
  for (const double z : {0.0, 3.0})
    for (const auto& [x, y] : {std::pair{0, 30}, std::pair{2, 30}, std::pair{2, 31}, std::pair{0, 31}})
      grid += "0\nVERTEX\n8\npolygons\n" + point_groups(10, {double(x), double(y), z}) + "70\n64\n";
  d.raw("POLYLINE", "polygons", "66\n1\n70\n48\n71\n2\n72\n4\n" + grid + "0\nSEQEND\n");
  const auto corners = [](double y) {
    return point_groups(10, {0, y, 0}) + point_groups(11, {2, y, 0}) + point_groups(12, {0, y + 1, 0}) +
           point_groups(13, {2, y + 1, 0});
  };
  d.raw("SOLID", "solid", corners(40) + "39\n3000\n");
  d.raw("SOLID", "below", corners(50) + "39\n3000\n210\n0\n220\n0\n230\n-1\n");
  const auto found = measures_of(load(d), false);
  ASSERT_EQ(found.size(), 6u);
  for (const auto& [form, y] :
       {std::pair{"faces", 0}, std::pair{"polyface", 10}, std::pair{"mesh", 20}, std::pair{"solid", 40}})
    expect(form, found.at(form), 22, 6, {0, double(y), 0}, {2, y + 1.0, 3});
  expect("below", found.at("below"), 22, 6, {-2, 50, -3}, {0, 51, 0});
  const Measures& pipe = found.at("polygons");
  EXPECT_NEAR(pipe.area_m2, 18, 1e-4);
  EXPECT_NEAR(pipe.bounds.min.y, 30, 1e-5);
}

TEST_F(DxfModelTest, LinesWithAThicknessStandUp) {
  DrawingText d = boxed();
  d.insert("0", "Box", 500, 0);
  // Forms stand in a row along y, since of faces that coincide one is read.
  const auto vertex = [](double x, double y, const std::string& more = "") {
    return "10\n" + std::to_string(1000 * x) + "\n20\n" + std::to_string(1000 * y) + "\n" + more;
  };
  const auto line = [](double y) { return point_groups(10, {0, y, 1}) + point_groups(11, {3, y + 4, 1}); };
  const auto rectangle = [&](double y) {
    return "90\n4\n70\n1\n" + vertex(0, y) + vertex(4, y) + vertex(4, y + 2) + vertex(0, y + 2);
  };
  const std::string up = "39\n3000\n", below = "210\n0\n220\n0\n230\n-1\n", bow = "42\n1\n";
  d.raw("LINE", "line", up + line(0));
  d.raw("LINE", "down", "39\n-3000\n" + line(10));
  d.raw("LINE", "line from below", up + below + line(20));
  d.raw("LINE", "lying", up + "210\n1\n220\n0\n230\n0\n" + line(30));
  d.raw("LWPOLYLINE", "ring", "38\n500\n" + up + rectangle(40));
  d.raw("LWPOLYLINE", "ring from below", "38\n500\n" + up + rectangle(50) + below);
  d.raw("LWPOLYLINE", "wide", "43\n200\n" + up + rectangle(60));
  d.raw("LWPOLYLINE", "bent", "90\n3\n70\n0\n43\n200\n" + up + vertex(0, 70) + vertex(4, 70) + vertex(4, 72));
  d.raw("LWPOLYLINE", "round", "90\n2\n70\n1\n" + up + vertex(0, 80, bow) + vertex(2, 80, bow));
  d.raw("CIRCLE", "circle", up + point_groups(10, {2, 90, 1}) + "40\n1000\n");
  d.raw("ARC", "arc", up + point_groups(10, {2, 100, 1}) + "40\n1000\n50\n270\n51\n90\n");
  std::string old;
  for (const auto& [x, y] : {std::pair{0, 110}, std::pair{4, 110}, std::pair{4, 112}})
    old += "0\nVERTEX\n8\nold\n" + point_groups(10, {double(x), double(y), 0});
  d.raw("POLYLINE", "old", "66\n1\n70\n1\n" + up + point_groups(10, {0, 0, 0.5}) + old + "0\nSEQEND\n");
  d.raw("POLYLINE", "in space", "66\n1\n70\n8\n" + up + old + "0\nSEQEND\n");
  d.line("flat", 0, 0, 5, 0);
  const Scene scene = load(d);
  const auto found = measures_of(scene, false);
  const double round = 2 * std::numbers::pi;
  const auto near = [&](const char* layer, double area, double volume, const Vec3& low, const Vec3& high) {
    SCOPED_TRACE(layer);
    ASSERT_TRUE(found.contains(layer));
    const Measures& is = found.at(layer);
    EXPECT_NEAR(is.area_m2, area, 0.004 * area);
    if (volume > 0) {
      EXPECT_NEAR(is.volume_m3, volume, 0.008 * volume);
    }
    for (const auto& [a, b] : {std::pair{is.bounds.min, low}, std::pair{is.bounds.max, high}}) {
      EXPECT_NEAR(a.x, b.x, 0.005);
      EXPECT_NEAR(a.y, b.y, 0.005);
      EXPECT_NEAR(a.z, b.z, 1e-4);
    }
  };
  near("line", 15, 0, {0, 0, 1}, {3, 4, 4});
  near("down", 15, 0, {0, 10, -2}, {3, 14, 1});
  near("line from below", 15, 0, {0, 20, -2}, {3, 24, 1});
  near("lying", 12, 0, {0, 30, 1}, {6, 34, 1});
  near("ring", 36, 0, {0, 40, 0.5}, {4, 42, 3.5});
  near("ring from below", 36, 0, {-4, 50, -3.5}, {0, 52, -0.5});
  near("wide", 3 * (12.8 + 11.2) + 2 * 2.4, 3 * 2.4, {-0.1, 59.9, 0}, {4.1, 62.1, 3});
  near("bent", 3 * (12 + 2 * 0.2) + 2 * 1.2, 3 * 1.2, {0, 69.9, 0}, {4.1, 72, 3});
  near("round", 3 * round, 0, {0, 79, 0}, {2, 81, 3});
  near("circle", 4 * round, 1.5 * round, {1, 89, 1}, {3, 91, 4});
  near("arc", 1.5 * round, 0, {2, 99, 1}, {3, 101, 4});
  near("old", 3 * (6 + std::sqrt(20)), 0, {0, 110, 0.5}, {4, 112, 3.5});
  EXPECT_FALSE(found.contains("flat"));
  expect_note(scene, "1 LINE on flat, 1 POLYLINE on in space");
}

TEST_F(DxfModelTest, WhatIsLeftOutIsTold) {
  DrawingText d = boxed();
  d.layer("HIDDEN", -7);
  d.layer("FROZEN", 7, 1);
  add_box(d, "shown");
  d.insert("HIDDEN", "Box", 10, 0), d.insert("FROZEN", "Box", 20, 0), d.insert("shown", "elsewhere", 0, 0);
  d.look({.invisible = true});
  add_box(d, "shown");
  d.look({});
  d.line("A-WALL", 0, 0, 5, 0), d.raw("3DSOLID", "tank"), d.raw("3DSOLID", "tank");
  const Scene scene = load(d);
  const auto found = measures_of(scene, false);
  ASSERT_EQ(found.size(), 1u);
  expect("shown", found.at("shown"), 22, 6, {0, 0, 0}, {2, 1, 3});
  expect_note(scene, "left out: 6 3DFACE on HIDDEN, 6 3DFACE on shown, 1 INSERT on FROZEN");
  expect_note(scene, "2 3DSOLID on tank");
  expect_note(scene, "1 LINE on A-WALL");
  expect_note(scene, "INSERT of elsewhere");
}

TEST_F(DxfModelTest, FacesAtNationalCoordinatesKeepTheirPlace) {
  DrawingText d = boxed();
  d.raw("INSERT", "far", "2\nBox\n" + point_groups(10, {500'000.25, 5'400'000.5, 300}));
  DrawingText drawn(6);
  std::string groups;
  for (const auto& [code, x, z] :
       {std::tuple(10, 0, 0), std::tuple(11, 4, 0), std::tuple(12, 4, 2), std::tuple(13, 0, 2)})
    for (const auto& [axis, value] :
         {std::pair{0, 500'000.25 + x}, std::pair{10, 5'400'000.5}, std::pair{20, 300.0 + z}})
      groups += std::to_string(code + axis) + "\n" + std::to_string(value) + "\n";
  drawn.raw("3DFACE", "far", groups);
  expect("placed", measures_of(load(d), false).at("far"), 22, 6, {500'000.25, 5'400'000.5, 300},
         {500'002.25, 5'400'001.5, 303});
  const Box wall = measures_of(load(drawn), false).at("far").bounds;
  EXPECT_NEAR(wall.min.x, 500'000.25, 1e-4);
  EXPECT_NEAR(wall.max.x, 500'004.25, 1e-4);
  EXPECT_NEAR(wall.min.y, 5'400'000.5, 1e-4);
  EXPECT_NEAR(wall.max.z, 302, 1e-4);
}

}  // namespace
}  // namespace vantage::test
