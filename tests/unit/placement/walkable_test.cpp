// SPDX-License-Identifier: Apache-2.0
#include "placement/walkable.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "placement/plane_quadtree.hpp"
#include "placement_scenes.hpp"
#include "vantage/error.hpp"
#include "vantage/placement.hpp"

namespace vantage {
namespace {

using test::origin;

double true_area(const SearchMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 n = cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
    sum += 0.5 * std::sqrt(dot(n, n));
  }
  return sum;
}

// Ground points, survey frame, of random (u, v) outside holes.
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

// Area left out for one reason, m².
double left_out(const SearchArea& area, LeftOutReason reason) {
  for (const LeftOut& out : area.left_out())
    if (out.reason == reason) return out.area_m2;
  return 0;
}

// A closed level of 1200 m² with an annex beside it that is this wide, has a door to the outside and none to the level.
SearchArea level_with_annex(double width) {
  test::Builder builder;
  const double x = 20.2 + width, y = width;
  builder.floor(-20, -15, 20, 15, 0).box({-20.2, -15.2, 2.8}, {x + 0.2, std::max(15.2, y + 0.2), 3});
  builder.box({-20.2, -15.2, 0}, {-20, 15.2, 2.8}).box({20, -15.2, 0}, {20.2, 15.2, 2.8});
  builder.box({-20, -15.2, 0}, {20, -15, 2.8}).box({-20, 15, 0}, {20, 15.2, 2.8});
  builder.floor(20.2, 0, x, y, 0).box({20.2, -0.2, 0}, {x + 0.2, 0, 2.8}).box({20.2, y, 0}, {x + 0.2, y + 0.2, 2.8});
  builder.box({x, 0, 0}, {x + 0.2, 1.5, 2.8}).box({x, 2.5, 0}, {x + 0.2, y, 2.8});
  return SearchArea::build(builder.scene());
}

// A level without a way out is entered, though a closet or an annex beside it has a door to the outside; an annex of
// more than a tenth of its size is where one enters.
TEST(Walkable, AClosetIsNoEntranceOfALevelThatDwarfsIt) {
  EXPECT_GT(true_area(level_with_annex(4.2).mesh()), 1000);
  EXPECT_GT(true_area(level_with_annex(10).mesh()), 1000);
  const SearchArea entered = level_with_annex(12);
  EXPECT_LT(true_area(entered.mesh()), 200);
  ASSERT_FALSE(entered.not_entered().empty());
  EXPECT_GT(entered.not_entered()[0].area_m2, 1000);
}

// Open yards, each a step above the last that nobody takes, are ground with walls around them and without: no plane is
// laid below.
TEST(Walkable, FloorsWithWallsAroundAreAGround) {
  for (const double walls : {3.0, 0.0}) {
    test::Builder builder;
    for (int k = 0; k < 4; ++k) {
      const double x = 10.0 * k, z = 0.6 * k;
      builder.box({x, 0, -0.2}, {x + 10, 10, z});
      if (walls > 0) builder.box({x, -0.2, -0.2}, {x + 10, 0, z + walls}).box({x, 10, -0.2}, {x + 10, 10.2, z + walls});
    }
    if (walls > 0) builder.box({-0.2, 0, -0.2}, {0, 10, walls}).box({40, 0, -0.2}, {40.2, 10, 1.8 + walls});
    EXPECT_FALSE(SearchArea::build(builder.scene()).on_plane());
  }
}

// The assumed person is 0.6 m wide, so areas end 0.3 m before obstacles, up to the size of a piece.
TEST(Walkable, GroundOfTwoTrianglesHasAHoleUnderABoxAndNoPlaceOnIt) {
  const Scene scene = test::Builder().floor(-10, -10, 10, 10, 0).box({2, 2, 1}, {6, 6, 1.5}).scene();
  const SearchArea area = SearchArea::build(scene);
  EXPECT_TRUE(area.derived());
  EXPECT_NE(area.description().find("walkable"), std::string::npos);
  EXPECT_NEAR(true_area(area.mesh()), 400 - 4.6 * 4.6, 3);
  EXPECT_NEAR(left_out(area, LeftOutReason::unreachable), 16, 0.5);
  EXPECT_NEAR(left_out(area, LeftOutReason::headroom) + left_out(area, LeftOutReason::narrow), 4.6 * 4.6, 3);
  for (const Vec3& p : random_places(area, 20000)) {
    const Vec3 q = p - origin;
    EXPECT_NEAR(q.z, 0, 1e-6);
    EXPECT_FALSE(q.x > 2 && q.x < 6 && q.y > 2 && q.y < 6) << q.x << ' ' << q.y;
  }
}

// A house drawn as a closed shell stands on ground that continues beneath it, with bumps that block level rays near the
// ground.
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

TEST(Walkable, FloorUnderAHighPlatformStaysAndBothHaveTheirOwnPlacesWhereAStairLeadsUp) {
  test::Builder builder;
  builder.floor(-5, -5, 5, 5, 0).box({-2, -2, 2.5}, {2, 2, 2.6});
  const SearchArea without = SearchArea::build(builder.scene());
  EXPECT_NEAR(true_area(without.mesh()), 100, 1e-6);
  EXPECT_NEAR(left_out(without, LeftOutReason::unreachable), 16, 1e-6);

  const int rises = 13;  // of 0.2 m each, beside the platform, with closed sides
  for (int k = 0; k + 1 < rises; ++k) builder.box({2, -3 + 0.27 * k, 0}, {3, -3 + 0.27 * (k + 1), 0.2 * (k + 1)});
  builder.box({2, -3 + 0.27 * (rises - 1), 2.5}, {3, 2, 2.6});
  const SearchArea area = SearchArea::build(builder.scene());
  EXPECT_GT(true_area(area.mesh()), 100);
  const Uv below = area.project(origin + Vec3{-1, 0, 0.1}).value(),
           above = area.project(origin + Vec3{-1, 0, 2.4}).value();
  EXPECT_NEAR(area.locate(below)->z - origin.z, 0, 1e-6);
  EXPECT_NEAR(area.locate(above)->z - origin.z, 2.6, 1e-6);
  EXPECT_LT(left_out(area, LeftOutReason::unreachable), 1);

  // Steps that are too high end the way, and are reported.
  WalkableOptions low_steps;
  low_steps.climb_m = 0.15, low_steps.enter_closed = false;
  const SearchArea stopped = SearchArea::build(builder.scene(), low_steps);
  EXPECT_GT(left_out(stopped, LeftOutReason::unreachable), 15);
  EXPECT_NE(stopped.description().find("beyond steps of up to 0.2 m"), std::string::npos) << stopped.description();
}

// Two rooms of 4 × 4 m under one ceiling; the wall between them has an opening of this width and height.
test::Builder two_rooms(double width, double height, bool door = false) {
  test::Builder builder;
  builder.floor(0, 0, 8, 4, 0).box({0, 0, 2.5}, {8, 4, 2.6});
  builder.box({-0.1, 0, 0}, {0, 4, 2.5}).box({8, 0, 0}, {8.1, 4, 2.5});
  builder.box({0, -0.1, 0}, {8, 0, 2.5}).box({0, 4, 0}, {8, 4.1, 2.5});
  builder.box({3.95, 0, 0}, {4.05, 2 - width / 2, 2.5}).box({3.95, 2 + width / 2, 0}, {4.05, 4, 2.5});
  if (height < 2.5) builder.box({3.95, 2 - width / 2, height}, {4.05, 2 + width / 2, 2.5});
  if (door)
    builder.quad({4, 2 - width / 2, 0}, {4, 2 + width / 2, 0}, {4, 2 + width / 2, height}, {4, 2 - width / 2, height});
  return builder;
}

TEST(Walkable, OpeningsLetAPersonThroughWhoIsNotTooWideOrTall) {
  const auto rooms = [](double width, double height) {
    const SearchArea area = SearchArea::build(two_rooms(width, height).scene(), {.enter_closed = false});
    const double size = true_area(area.mesh());
    EXPECT_TRUE(size < 16 || size > 22) << size;
    EXPECT_EQ(left_out(area, LeftOutReason::sealed) > 8, size < 16);
    return size < 16 ? 1 : 2;
  };
  EXPECT_EQ(rooms(0.9, 2.1), 2);
  EXPECT_EQ(rooms(0.61, 1.91), 2);
  EXPECT_EQ(rooms(0.6, 2.1), 2);
  EXPECT_EQ(rooms(0.5, 2.1), 1);
  EXPECT_EQ(rooms(0.9, 1.85), 1);
}

// A pane in the opening, which rays pass: people do not, unless it is a door.
TEST(Walkable, GlassStopsPeopleAndAGlassDoorDoesNot) {
  SceneData data = two_rooms(0.9, 2.1, true).data();
  const auto last = static_cast<std::uint32_t>(data.triangles.size()) - 2;
  for (const bool glass : {false, true})
    for (const bool door : {false, true}) {
      data.meshes = {{.name = "rooms", .triangle_count = last},
                     {.name = "leaf", .role = Role::blocking, .triangle_count = 2, .door = door, .glass = glass}};
      data.ranges = {{0, last, 0}, {last, 2, 0}};
      const Scene scene(std::make_shared<const SceneData>(data));
      EXPECT_EQ(true_area(SearchArea::build(scene, {.enter_closed = false}).mesh()) > 20, door) << glass;
    }
}

TEST(Walkable, OpeningsThatRunAskewLetAPersonThroughToo) {
  for (int k = 0; k < 12; ++k) {
    SceneData data = two_rooms(0.62, 2.1).data();
    const double angle = 0.13 * k, c = std::cos(angle), s = std::sin(angle);
    data.local_bounds = {};
    for (Float3& p : data.positions) {
      const double x = c * p.x - s * p.y + 0.017 * k, y = s * p.x + c * p.y;
      p = {static_cast<float>(x), static_cast<float>(y), p.z};
      data.local_bounds.extend({p.x, p.y, p.z});
    }
    const SearchArea area = SearchArea::build(Scene(std::make_shared<const SceneData>(data)));
    EXPECT_GT(true_area(area.mesh()), 20) << angle;
  }
}

TEST(Walkable, DoorsThatCountAsOpenStillStandThere) {
  SceneData data = two_rooms(0.9, 2.1, true).data();
  const Scene closed(std::make_shared<const SceneData>(data));
  EXPECT_LT(true_area(SearchArea::build(closed).mesh()), 16);
  data.meshes = {{"rooms", Role::surveyed, 0.5, data.meshes[0].triangle_count - 2},
                 {"leaf", Role::surveyed, 0.5, 2, 1, true}};
  data.ranges = {{0, data.meshes[0].triangle_count, 0}, {data.meshes[0].triangle_count, 2, 0}};
  const Scene open(std::make_shared<const SceneData>(data));
  EXPECT_GT(true_area(SearchArea::build(open).mesh()), 20);
  EXPECT_TRUE(ClashChecker(open).clashes(origin + Vec3{3.7, 2, 0}));
}

TEST(Walkable, OneEntersWhereOneIsTold) {
  const Scene scene = two_rooms(0.4, 2.1).scene();
  for (const double x : {1.0, 7.0}) {
    WalkableOptions options;
    options.enter = {origin + Vec3{x, 2, 0.4}};
    const SearchArea area = SearchArea::build(scene, options);
    for (const Vec3& p : random_places(area, 1000)) EXPECT_EQ(p.x - origin.x < 4, x < 4);
  }
  WalkableOptions nowhere;
  nowhere.enter = {origin + Vec3{50, 2, 0}};
  try {
    SearchArea::build(scene, nowhere);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::invalid_argument);
    EXPECT_NE(std::string(error.what()).find("enter"), std::string::npos);
  }
}

TEST(Walkable, LevelsAndRegionsCutDerivedAndMarkedAreas) {
  const test::Builder builder = two_rooms(0.9, 2.1);
  SceneData marked = builder.data();
  for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{8, 0, 0}, Vec3{8, 4, 2}, Vec3{0, 4, 2}})
    marked.search_positions.push_back(origin + p);
  marked.search_uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  marked.search_triangles = {{0, 1, 2}, {0, 2, 3}};
  const Scene scenes[] = {builder.scene(), Scene(std::make_shared<const SceneData>(marked))};
  WalkableOptions options;
  options.within = {{{{{1000, 2000}, {1008, 2000}, {1008, 2004}}}}};  // below the diagonal
  options.without = {{{{{1006, 2000}, {1009, 2000}, {1009, 2005}, {1006, 2005}}}}};
  options.levels = {29.9, 31};
  for (const Scene& scene : scenes) {
    const SearchArea area = SearchArea::build(scene, options);
    const auto places = random_places(area, 20000);
    EXPECT_GT(places.size(), 1000u);
    for (const Vec3& p : places) {
      const Vec3 q = p - origin;
      EXPECT_LE(q.y, q.x / 2 + 1e-9);
      EXPECT_LE(q.x, 6 + 1e-9);
      EXPECT_LE(q.z, 1 + 1e-9);
    }
    EXPECT_GT(left_out(area, LeftOutReason::limits), 5);
    EXPECT_FALSE(area.project(origin + Vec3{7, 1, 0}));
    EXPECT_TRUE(area.project(origin + Vec3{5, 1, 0}));
  }
  options.levels = {50, 60};
  for (const Scene& scene : scenes) EXPECT_THROW(SearchArea::build(scene, options), Error);
}

TEST(Walkable, SurfacesThatAreNamedForStandingGoBeforeAllOthers) {
  SceneData data = two_rooms(0.4, 2.1).data();
  data.meshes = {{"floor", Role::surveyed, 0.5, 2, 1, false, true},
                 {"rooms", Role::surveyed, 0.5, data.meshes[0].triangle_count - 2}};
  data.ranges = {{0, 2, 0}, {2, data.meshes[1].triangle_count, 0}};
  const SearchArea area = SearchArea::build(Scene(std::make_shared<const SceneData>(data)));
  EXPECT_FALSE(area.derived());
  EXPECT_GT(true_area(area.mesh()), 20) << "behind closed doors too";
  for (const Vec3& p : random_places(area, 2000)) EXPECT_NEAR(p.z, origin.z, 1e-6);
}

TEST(Walkable, SteepLowAndSmallSurfacesAreLeftOut) {
  const Scene scene = test::Builder()
                          .floor(-5, -5, 5, 5, 0)
                          .quad({5, -5, 0}, {9, -5, 4}, {9, 5, 4}, {5, 5, 0})  // 45°
                          .floor(20, 0, 20.3, 0.3, 0)                          // 0.09 m²
                          .floor(22, 0, 28, 0.15, 0)                           // the top of a pipe
                          .scene();
  const SearchArea area = SearchArea::build(scene);
  EXPECT_NEAR(true_area(area.mesh()), 100, 2);
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
  EXPECT_NEAR(true_area(area.mesh()), 400 - 4.6 * 4.6, 5);
  EXPECT_NEAR(area.locate(area.project(origin + Vec3{-7, 3, 0}).value())->x, origin.x - 7, 1e-6);
  EXPECT_EQ(area.uv_max().v, 1);
}

TEST(Walkable, AMachineInTheVoidStandsOnALaidPlane) {
  const Scene scene = test::Builder().box({-2, -1, -3}, {2, 1, 0}).box({-1, -0.5, 0}, {1, 0.5, 1}).scene();
  const SearchArea area = SearchArea::build(scene);
  EXPECT_TRUE(area.derived());
  EXPECT_NE(area.description().find("plane laid under the model"), std::string::npos);
  EXPECT_NEAR(true_area(area.mesh()), 12 * 10 - 4.6 * 2.6, 1);
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
  EXPECT_NEAR(true_area(area.mesh()), 15 * 10 - 5 * 0.6 - 0.3 * 0.3 * M_PI, 1);
  EXPECT_NEAR(area.locate({0.1, 0.1})->z, 30, 1e-9);
}

TEST(Walkable, TinyAndHugeModelsGetTheSamePlaces) {
  for (const double scale : {1e-3, 1.0, 1e3}) {
    const double s = scale;
    const Scene scene = test::Builder()
                            .floor(-10 * s, -10 * s, 10 * s, 10 * s, 0)
                            .box({2 * s, 2 * s, 0}, {6 * s, 6 * s, 3 * s})
                            .scene();
    const SearchArea area = SearchArea::build(scene, {.max_slope = Angle::degrees(35),
                                                      .headroom_m = 2 * s,
                                                      .min_area_m2 = 0.25 * s * s,
                                                      .passage_width_m = 0.6 * s,
                                                      .passage_height_m = 1.9 * s,
                                                      .climb_m = 0.25 * s});
    EXPECT_NEAR(true_area(area.mesh()) / (s * s), 400 - 4.6 * 4.6, 5);
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
  data.search_uvs.assign(7, Uv{0.5, 0.5});  // unusable (u, v)
  EXPECT_EQ(SearchArea::build(Scene(std::make_shared<const SceneData>(data))).mesh().triangles.size(), 3u);
}

TEST(Walkable, RefusesOptionsThatMakeNoSense) {
  const Scene scene = test::Builder().floor(-1, -1, 1, 1, 0).scene();
  for (const WalkableOptions& options : {WalkableOptions{Angle::degrees(90)},
                                         {Angle::degrees(-1)},
                                         {Angle::degrees(30), -1},
                                         {Angle::degrees(30), 2, std::nan("")},
                                         {Angle::degrees(30), 2, 0.25, 0},
                                         {Angle::degrees(30), 2, 0.25, 0.6, 0.2},
                                         {Angle::degrees(30), 2, 0.25, 0.6, 1.9, -1},
                                         {.levels = {{2, 1}}},
                                         {.within = {{{{{0, 0}, {1, 1}}}}}}})
    EXPECT_THROW(SearchArea::build(scene, options), Error);
}

TEST(Walkable, NothingAtAllIsAnError) { EXPECT_THROW(find_walkable_surface(SceneData{}, {}), Error); }

}  // namespace
}  // namespace vantage
