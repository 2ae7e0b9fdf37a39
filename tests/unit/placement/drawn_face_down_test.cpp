// SPDX-License-Identifier: Apache-2.0
#include "placement/drawn_face_down.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "placement_scenes.hpp"
#include "vantage/placement.hpp"

namespace vantage {
namespace {

using test::Builder;
using test::origin;

constexpr double kTall_m = 1.9;

Builder& face_down(Builder& builder, double x0, double y0, double x1, double y1, double z) {
  return builder.quad({x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z});
}

std::vector<std::uint32_t> found_in(const Builder& builder) {
  const SceneData scene = builder.data();
  return drawn_face_down(scene, MeshTree(scene), kTall_m);
}

TEST(DrawnFaceDown, GroundDrawnFaceDownIsGround) {
  Builder b;
  face_down(b, -10, -10, 10, 10, 0).box({-2, -2, 0}, {2, 2, 3});
  EXPECT_EQ(found_in(b), (std::vector<std::uint32_t>{0, 1}));
  const SearchArea area = SearchArea::build(b.scene());
  EXPECT_FALSE(area.on_plane());
  EXPECT_NE(area.description().find("2 triangles that face down"), std::string::npos) << area.description();
  const auto uv = area.project(origin + Vec3{-8, -8, 0});
  ASSERT_TRUE(uv);
  const auto ground = area.locate(*uv);
  ASSERT_TRUE(ground);
  EXPECT_NEAR(ground->z, origin.z, 1e-3);
}

TEST(DrawnFaceDown, UndersidesOfSolidsAreNone) {
  Builder b;
  b.floor(-10, -10, 10, 10, 0).box({-6, -6, 3}, {6, 6, 3.2}).box({-9, -9, -8}, {9, 9, -5});
  EXPECT_TRUE(found_in(b).empty());
  Builder block;  // its underside touches nothing, and its inside is as high as a room
  face_down(block, -10, -10, 10, 10, -5).floor(-10, -10, 10, 10, 0).floor(20, 0, 21, 1, 0);
  face_down(block, 30, 0, 50, 20, 0);  // the mesh has more that faces down than up
  EXPECT_EQ(found_in(block), (std::vector<std::uint32_t>{6, 7}));
}

TEST(DrawnFaceDown, CeilingsAreNoneAndFloorsBetweenStoreysAre) {
  Builder b;
  b.floor(0, 0, 8, 8, 0);
  face_down(b, 0, 0, 8, 8, 3), face_down(b, 0, 0, 8, 8, 6);
  EXPECT_EQ(found_in(b), (std::vector<std::uint32_t>{2, 3}));
}

// Floors and ceilings that were drawn as sheets of their own, each either way.
TEST(DrawnFaceDown, FloorsCloseOverACeilingThatFacesUpAreFloors) {
  Builder b;
  b.floor(0, 0, 8, 8, 0).floor(0, 0, 8, 8, 2.6);  // the second is a ceiling
  face_down(b, 0, 0, 8, 8, 2.8);
  b.floor(0, 0, 8, 8, 5.4);
  EXPECT_EQ(found_in(b), (std::vector<std::uint32_t>{4, 5}));
  Builder high;  // a gap that somebody may look up from
  high.floor(0, 0, 8, 8, 0).floor(0, 0, 8, 8, 2.6);
  face_down(high, 0, 0, 8, 8, 3.8);
  high.floor(0, 0, 8, 8, 6.4);
  EXPECT_TRUE(found_in(high).empty());
}

// A box whose faces show inwards.
Builder& inside_out(Builder& builder, const Vec3& a, const Vec3& b) {
  return builder.box({b.x, a.y, a.z}, {a.x, b.y, b.z});
}

TEST(DrawnFaceDown, SolidsThatAreInsideOutCarryAPersonAndRoomsDoNot) {
  Builder slab;
  inside_out(slab, {0, 0, 0}, {8, 8, 0.3});
  EXPECT_EQ(found_in(slab), (std::vector<std::uint32_t>{0, 1}));
  const SearchArea area = SearchArea::build(slab.floor(-10, 0, -0.05, 8, 0.3).scene());
  EXPECT_TRUE(area.project(origin + Vec3{4, 4, 0.3}));
  Builder room;
  inside_out(room, {0, 0, 0}, {8, 8, 3});
  EXPECT_TRUE(found_in(room).empty());
}

TEST(DrawnFaceDown, CopiesInOneAnotherAreNone) {
  Builder b;
  for (int k = 0; k < 3; ++k) face_down(b, 0, 0, 8 + k, 8 + k, 0);
  EXPECT_TRUE(found_in(b).empty());
}

TEST(DrawnFaceDown, WhatIsLowOrSmallIsNone) {
  Builder b;
  b.floor(0, 0, 8, 8, 0);
  face_down(b, 0, 0, 8, 8, 2.6), face_down(b, 0, 0, 8, 8, 4);  // a ceiling and a roof above it
  face_down(b, 20, 0, 21, 1, 0);
  EXPECT_TRUE(found_in(b).empty());
}

// Rooms of sheets that share their corners, with each face wound as it came.
Builder wound_as_it_came(unsigned seed) {
  std::mt19937 rng(seed);
  Builder b;
  const auto face = [&](const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
    rng() % 2 ? b.quad(p, q, r, s) : b.quad(s, r, q, p);
  };
  for (int k = 0; k < 4; ++k) {
    const double x = 6.0 * k, y = 5, z = 2.7;
    face({x, 0, 0}, {x + 6, 0, 0}, {x + 6, y, 0}, {x, y, 0}), face({x, 0, z}, {x + 6, 0, z}, {x + 6, y, z}, {x, y, z});
    face({x, 0, 0}, {x + 6, 0, 0}, {x + 6, 0, z}, {x, 0, z}), face({x, y, 0}, {x + 6, y, 0}, {x + 6, y, z}, {x, y, z});
    if (k == 0) face({x, 0, 0}, {x, y, 0}, {x, y, z}, {x, 0, z});
    if (k == 3) face({x + 6, 0, 0}, {x + 6, y, 0}, {x + 6, y, z}, {x + 6, 0, z});
  }
  return b;
}

TEST(DrawnFaceDown, FloorsOfMeshesThatAreWoundEitherWayCarryAPersonWhateverTheyFace) {
  for (const unsigned seed : {1U, 2U, 3U, 4U, 5U}) {
    const Builder b = wound_as_it_came(seed);
    const SceneData scene = b.data();
    const MeshTree tree(scene);
    ASSERT_TRUE(tree.wound_either_way(0)) << seed;
    EXPECT_FALSE(tree.inside_solid({3, 2.5, 1.5})) << seed;
    const SearchArea area = SearchArea::build(b.scene(), {.enter = {origin + Vec3{1, 1, 0}}});
    for (const double x : {3.0, 9.0, 15.0, 21.0}) {
      const auto uv = area.project(origin + Vec3{x, 2.5, 0});
      ASSERT_TRUE(uv) << seed << " at " << x;
      EXPECT_NEAR(area.locate(*uv)->z, origin.z, 1e-3) << seed << " at " << x;
    }
  }
}

TEST(DrawnFaceDown, ModelsThatAreWoundAlikeHaveFronts) {
  Builder solids;
  for (int k = 0; k < 5; ++k) solids.box({4.0 * k, 0, 0}, {4.0 * k + 4, 3, 3});  // side by side
  EXPECT_FALSE(MeshTree(solids.data()).wound_either_way(0));
  Builder both;  // sheets, each with its back
  for (int k = 0; k < 9; ++k) both.floor(k, 0, k + 1, 1, 0), face_down(both, k, 0, k + 1, 1, 0);
  EXPECT_FALSE(MeshTree(both.data()).wound_either_way(0));
}

}  // namespace
}  // namespace vantage
