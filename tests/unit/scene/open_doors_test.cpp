// SPDX-License-Identifier: Apache-2.0
// Leaves of doors that are nodes of their own, or connected parts of a larger mesh, and parts that only look like one.
#include "scene/open_doors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "scene/positions.hpp"
#include "scene/shared_meshes.hpp"
#include "scene/told_by_name.hpp"
#include "support/box.hpp"

namespace vantage {
namespace {

using Names = std::vector<std::string>;

// A wall 0.2 m thick along x from 0 to 10, 2.8 m high, with openings 0.9 m wide and 2.1 m high from x = 1, 4 and 7, on
// a floor; other boxes by meshes. Metres, Z up.
class Joinery {
 public:
  Joinery() {
    mesh("wall");
    for (const auto& [from, to] : {std::pair{0.0, 1.0}, {1.9, 4.0}, {4.9, 7.0}, {7.9, 10.0}})
      box({from, 0, 0}, {to, 0.2, 2.8});
    for (const double x : {1.0, 4.0, 7.0}) box({x, 0, 2.1}, {x + 0.9, 0.2, 2.8});
    box({-5, -5, -0.2}, {15, 5, 0});
  }
  Joinery& mesh(const std::string& name) {
    raw.ranges.push_back({static_cast<std::uint32_t>(raw.triangles.size()), 0, 0});
    raw.meshes.push_back({.name = name});
    return *this;
  }
  // Each triangle has vertices of its own, as in files without an index.
  Joinery& box(const Vec3& low, const Vec3& high) {
    const std::vector<Vec3> corners = test::box_corners(low, high);
    for (const auto& t : test::box_triangles) {
      const auto first = static_cast<std::uint32_t>(raw.positions.size());
      for (const std::uint32_t corner : t) raw.positions.push_back(to_glm(corners[corner]));
      raw.triangles.push_back({first, first + 1, first + 2});
      ++raw.ranges.back().triangle_count, ++raw.meshes.back().triangle_count;
    }
    return *this;
  }
  // A leaf in the opening from x, from one depth to another.
  Joinery& leaf(double x, double front, double back) { return box({x, front, 0}, {x + 0.9, back, 2.1}); }
  // Stores the last mesh once and places it as it stands, and again in another mesh 100 m away.
  Joinery& share() {
    const MeshRange own = raw.ranges.back();
    SharedMesh shared;
    for (std::uint32_t t = own.first_triangle; t < own.first_triangle + own.triangle_count; ++t) {
      for (const std::uint32_t v : raw.triangles[t]) shared.positions.push_back(to_float3(raw.positions[v]));
      const auto end = static_cast<std::uint32_t>(shared.positions.size());
      shared.triangles.push_back({end - 3, end - 2, end - 1});
    }
    raw.triangles.resize(own.first_triangle);
    raw.ranges.back().triangle_count = 0;
    raw.shared = {shared};
    mesh("far away");
    raw.placed.resize(raw.ranges.size());
    for (const double x : {0.0, 100.0}) {
      glm::dmat4 place(1);
      place[3].x = x;
      raw.placed[raw.ranges.size() - (x > 0 ? 1 : 2)] = {{0, place_of(place)}};
    }
    return *this;
  }
  Names open() { return open_doors(raw, std::vector<std::uint8_t>(raw.meshes.size(), 1)); }

  RawScene raw;
};

TEST(OpenDoors, ALeafIsAMeshOfItsOwnByNameOrByTheWallAroundIt) {
  Joinery site;
  site.mesh("slab 1").leaf(1, 0.08, 0.12).mesh("Tür 2").box({4.1, -2, 0}, {5, -1.96, 2});
  const std::size_t before = site.raw.triangles.size();
  EXPECT_EQ(site.open(), (Names{"slab 1", "Tür 2"}));
  EXPECT_EQ(site.raw.triangles.size(), before - 24);
}

TEST(OpenDoors, LeavesAreFoundAmongThePartsOfOneMesh) {
  Joinery site;
  site.mesh("joinery").leaf(1, 0.08, 0.12);
  site.box({1.8, 0.03, 1}, {1.85, 0.07, 1.1});   // a handle before it
  site.leaf(4, 0, 0.04);                         // in the plane of the wall's face
  site.box({7, -1, 0}, {7.9, -0.5, 2.1});        // a cabinet
  site.box({7, -0.49, 0}, {7.9, -0.47, 2.1});    // and its door
  site.box({2.5, -0.03, 0}, {3.4, -0.01, 2.1});  // a board on the wall
  for (int i = 0; i < 4; ++i)                    // a screen of panels
    site.box({1.0 * i, 3, 0}, {1.0 * i + 0.98, 3.05, 2.1});
  const std::size_t before = site.raw.triangles.size();
  EXPECT_EQ(site.open(), (Names{"joinery", "joinery"}));
  EXPECT_EQ(site.raw.triangles.size(), before - 36) << "two leaves and a handle";
  EXPECT_EQ(site.raw.meshes.size(), 2U);
  for (const glm::dvec3& p : {glm::dvec3{1.45, 0.1, 1}, {4.45, 0.02, 1}})
    for (const Triangle& t : site.raw.triangles) {
      const auto near = [&](std::uint32_t v) { return std::abs(site.raw.positions[v].x - p.x) < 0.44; };
      EXPECT_FALSE(near(t[0]) && near(t[1]) && near(t[2]) && site.raw.positions[t[0]].z < 2.05 &&
                   std::abs(site.raw.positions[t[0]].y - p.y) < 0.1);
    }
}

TEST(OpenDoors, ASharedMeshLosesItsLeavesWhereTheyLeadThroughAWall) {
  Joinery site;
  site.mesh("joinery").leaf(1, 0.08, 0.12).box({1.8, 0.03, 1}, {1.85, 0.07, 1.1}).leaf(4, 0.06, 0.1);
  site.box({8, -3, 0}, {9, -2, 0.5});
  const std::size_t before = site.raw.triangles.size();
  site.share();
  EXPECT_EQ(site.open(), (Names{"joinery", "joinery"}));
  EXPECT_EQ(site.raw.triangles.size(), before - 36) << "two leaves and a handle";
  EXPECT_TRUE(site.raw.placed[1].empty());
  ASSERT_EQ(site.raw.placed[2].size(), 1U);
  EXPECT_EQ(site.raw.shared[0].triangles.size(), 48U);
}

TEST(OpenDoors, ASharedMeshMayBeTheWallOrALeafAlone) {
  Joinery wall;
  wall.mesh("slab").leaf(1, 0.08, 0.12);
  std::swap(wall.raw.ranges[0], wall.raw.ranges[1]), std::swap(wall.raw.meshes[0], wall.raw.meshes[1]);
  std::ranges::rotate(wall.raw.triangles, wall.raw.triangles.end() - 12);
  wall.raw.ranges[0].first_triangle = 0, wall.raw.ranges[1].first_triangle = 12;
  EXPECT_EQ(wall.share().open(), Names{"slab"});
  EXPECT_EQ(wall.raw.placed.back().size(), 1U);
  Joinery leaf;
  leaf.mesh("slab").leaf(1, 0.08, 0.12);
  EXPECT_EQ(leaf.share().open(), Names{"slab"});
  EXPECT_EQ(leaf.raw.meshes.size(), 2U) << "the wall, and the slab far away";
}

// The leaf and its frame are one part, as deep as the wall and its trims.
TEST(OpenDoors, APanelIsMeasuredWithoutItsFrame) {
  Joinery site;
  site.mesh("joinery").box({8, -3, 0}, {9, -2, 0.5});
  for (const double x : {1.0, 1.84}) site.box({x, -0.02, 0}, {x + 0.06, 0.22, 2.1});
  site.leaf(1, 0.08, 0.12);
  std::uint32_t frame = static_cast<std::uint32_t>(site.raw.triangles.size()) - 36;
  // Triangles without area hold the three boxes together.
  for (const std::uint32_t box : {0U, 12U})
    for (const std::uint32_t other : {0U, 12U}) {
      const Triangle a = site.raw.triangles[frame + box], b = site.raw.triangles[frame + 12 + other];
      site.raw.triangles.push_back({a[0], b[0], b[0]});
      ++site.raw.ranges.back().triangle_count;
    }
  EXPECT_EQ(site.open(), Names{"joinery"});
  EXPECT_EQ(site.raw.meshes.back().name, "joinery");
  EXPECT_EQ(site.raw.ranges.back().triangle_count, 12U) << "the chest stays";
}

TEST(OpenDoors, AFrameIsADoorIfAPaneOfAnotherMeshFillsIt) {
  const auto frame = [](Joinery& site) {  // one connected ring
    const auto first = static_cast<std::uint32_t>(site.raw.positions.size());
    site.mesh("frames");
    for (const double y : {0.05, 0.1})
      for (const auto& [inset, drop] : {std::pair{0.0, 0.0}, {0.1, 0.1}})
        for (const Vec3& p : {Vec3{4 + inset, y, drop},
                              {4.9 - inset, y, drop},
                              {4.9 - inset, y, 2.1 - drop},
                              {4 + inset, y, 2.1 - drop}})
          site.raw.positions.push_back(to_glm(p));
    const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
      site.raw.triangles.push_back({first + a, first + b, first + c}),
          site.raw.triangles.push_back({first + a, first + c, first + d});
      site.raw.ranges.back().triangle_count += 2, site.raw.meshes.back().triangle_count += 2;
    };
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t j = (i + 1) % 4;
      for (const std::uint32_t side : {0U, 8U}) quad(side + i, side + j, side + 4 + j, side + 4 + i);
      quad(i, j, 8 + j, 8 + i), quad(4 + i, 4 + j, 12 + j, 12 + i);
    }
    site.box({8, -3, 0}, {9, -2, 0.5});  // and a chest
  };
  Joinery empty;
  frame(empty);
  EXPECT_TRUE(empty.open().empty());
  Joinery filled;
  frame(filled);
  filled.mesh("panes").box({4.1, 0.07, 0.1}, {4.8, 0.08, 2}).box({9, -4, 0.5}, {9.5, -4, 1.5});
  const std::size_t before = filled.raw.triangles.size();
  EXPECT_EQ(filled.open(), Names{"frames"});
  EXPECT_EQ(filled.raw.triangles.size(), before - 32 - 12) << "the frame and its pane";
}

TEST(OpenDoors, NoLeafOfAMeshThatIsNoCandidate) {
  Joinery site;
  site.mesh("joinery").leaf(1, 0.08, 0.12).box({8, -3, 0}, {9, -2, 0.5});
  EXPECT_TRUE(open_doors(site.raw, {1, 0}).empty());
}

// A wall of this thickness along x with an opening of 2.2 x 2.7 m from x = 4, on a floor.
Joinery with_gateway(double thick) {
  Joinery site;
  site.raw = {};
  site.mesh("part 1").box({0, 0, 0}, {4, thick, 4}).box({6.2, 0, 0}, {10, thick, 4}).box({4, 0, 2.7}, {6.2, thick, 4});
  site.box({-5, -5, -0.2}, {15, 5, 0});
  return site;
}

TEST(OpenDoors, TwoLeavesFillOneOpening) {
  const auto leaves = [](Joinery site, double apart) {
    site.mesh("part 2").box({4.01, 0.1, 0.01}, {5.09, 0.18, 2.68});
    site.mesh("part 3").box({5.11, 0.1 + apart, 0.01}, {6.19, 0.18 + apart, 2.68});
    return site;
  };
  EXPECT_EQ(leaves(with_gateway(0.5), 0).open(), (Names{"part 2", "part 3"}));
  EXPECT_EQ(leaves(with_gateway(0.5), 0.1).open(), (Names{"part 2", "part 3"})) << "sliding past each other";
  EXPECT_EQ(leaves(with_gateway(0.09), 0).open(), Names{}) << "panels of a wall that is no thicker";
  Joinery one = with_gateway(0.5);
  one.mesh("part 2").box({4.01, 0.1, 0.01}, {5.09, 0.18, 2.68}).box({5.11, 0.1, 0.01}, {6.19, 0.18, 2.68});
  EXPECT_EQ(one.open(), (Names{"part 2", "part 2"})) << "both in one mesh";
}

TEST(OpenDoors, AGateIsAsWideAsItsWallLeavesRoom) {
  const auto gate = [](const std::string& name, double thick) {
    Joinery site = with_gateway(thick);
    return site.mesh(name).box({4.01, 0.1, 0.01}, {6.19, 0.18, 2.68}).open();
  };
  EXPECT_EQ(gate("Tor 1", 0.5), Names{"Tor 1"});
  EXPECT_EQ(gate("factory gate", 0.5), Names{"factory gate"});
  EXPECT_EQ(gate("part 2", 0.5), Names{}) << "may be a panel of the wall";
  EXPECT_EQ(gate("Motor 1", 0.5), Names{});
  EXPECT_EQ(gate("FactoryGate_1", 0.5), Names{"FactoryGate_1"});
  EXPECT_EQ(gate("Aggregate_1", 0.5), Names{});
}

TEST(OpenDoors, AGrilleIsAGateByItsName) {
  const auto grille = [](const std::string& name) {
    Joinery site = with_gateway(0.5);
    site.mesh(name);
    for (double x = 4.02; x < 6.19; x += 0.12) site.box({x, 0.24, 0.01}, {x + 0.02, 0.26, 2.68});
    return site.box({4.01, 0.23, 0.05}, {6.19, 0.27, 0.1}).box({4.01, 0.23, 2.6}, {6.19, 0.27, 2.65}).open();
  };
  EXPECT_EQ(grille("WingGate_B"), Names{"WingGate_B"});
  EXPECT_EQ(grille("rack"), Names{});
}

TEST(ToldByName, WaterIsWaterAndNoPaint) {
  for (const char* name :
       {"Water", "M_Water_01", "Site - Water", "Wasser", "WaterSurface", "MAT_acqua", "Sea", "sea level 2", "Море"})
    EXPECT_TRUE(is_water(name)) << name;
  for (const char* name : {"River Rock", "Lake blue paint", "Waterproof board", "pond liner", "", "Water pipe",
                           "Sea container", "Seabed", "stream of parts"})
    EXPECT_FALSE(is_water(name)) << name;
  EXPECT_TRUE(names_water("Wateroppervlak"));
  EXPECT_TRUE(names_water("Sea_01"));
  EXPECT_FALSE(names_water("Watercolour"));
  EXPECT_FALSE(names_water("SeaContainer_20ft"));
}

TEST(ToldByName, CeilingsThatHangAreNoSlabs) {
  for (const char* name : {"Suspended Ceiling 600", "Plafond_salle", "Sufit podwieszany", "Akustikdecke"})
    EXPECT_TRUE(names_a_ceiling(name)) << name;
  for (const char* name : {"Decke EG", "Ceiling slab", "floor above ceiling", "Dach", ""})
    EXPECT_FALSE(names_a_ceiling(name)) << name;
}

TEST(OpenDoors, AShutterClosesAPassage) {
  const auto passage = [](const std::string& name, double width) {
    Joinery site;
    site.raw = {};
    site.mesh("walls")
        .box({-10, -0.3, 0}, {10, 0, 2.8})
        .box({-10, 4, 0}, {10, 4.3, 2.8})
        .box({-10, 0, -0.2}, {10, 4, 0});
    return site.mesh(name).box({1, 0, 0}, {1.04, width, 2.8}).open();
  };
  EXPECT_EQ(passage("Persiana_enrollable", 4), Names{"Persiana_enrollable"});
  EXPECT_EQ(passage("Persiana_enrollable", 3), Names{}) << "it stands in the passage";
  EXPECT_EQ(passage("panel", 4), Names{});
}

// Panes between posts, two leaves that slide before them, and what drives them above: only the leaves open.
TEST(OpenDoors, LeavesOfGlassSlideBetweenPanes) {
  const auto front = [](const char* left, const char* right) {
    Joinery site;
    site.raw = {};
    site.mesh("SLAB").box({-5, -5, -0.2}, {15, 5, 0});
    site.mesh("POSTS");
    for (const double x : {0.0, 1.4, 4.2, 5.6}) site.box({x - 0.03, -0.05, 0}, {x + 0.03, 0.05, 2.9});
    site.mesh("PANE-1").box({0.03, -0.006, 0.02}, {1.37, 0.006, 2.9});
    site.mesh("PANE-2").box({4.23, -0.006, 0.02}, {5.57, 0.006, 2.9});
    site.mesh("HEADER").box({1.4, -0.1, 2.3}, {4.2, 0.1, 2.55});
    site.mesh(left).box({1.43, 0.02, 0.01}, {2.8, 0.04, 2.3});
    site.mesh(right).box({2.8, 0.02, 0.01}, {4.17, 0.04, 2.3});
    return site.open();
  };
  EXPECT_EQ(front("ASD-LEAF-L", "ASD-LEAF-R"), (Names{"ASD-LEAF-L", "ASD-LEAF-R"}));
  EXPECT_EQ(front("PANE-3", "PANE-4"), Names{});
}

}  // namespace
}  // namespace vantage
