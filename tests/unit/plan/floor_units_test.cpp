// SPDX-License-Identifier: Apache-2.0
#include "candidates/floor_units.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "unit/placement/placement_scenes.hpp"
#include "vantage/question.hpp"
#include "vantage/summary.hpp"

namespace vantage {
namespace {

using test::origin;

// Rectangles of a search area, each with corners of its own and its place in (u, v).
struct Rectangles {
  SearchMesh mesh;
  Rectangles& add(const Vec3& from, double width, double depth, Uv at) {
    const auto n = static_cast<std::uint32_t>(mesh.positions.size());
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {width, 0.0}, {width, depth}, {0.0, depth}}) {
      mesh.positions.push_back(origin + from + Vec3{x, y, 0});
      mesh.uvs.push_back({at.u + x / 100, at.v + y / 100});
    }
    mesh.triangles.push_back({n, n + 1, n + 2}), mesh.triangles.push_back({n, n + 2, n + 3});
    return *this;
  }
  SearchArea area() const { return SearchArea::from_mesh(mesh); }
};

PlacedStation at(const Vec3& ground, Uv uv) {
  return {.uv = uv, .position = origin + ground + Vec3{0, 0, 1.8}, .ground = origin + ground};
}

TEST(FloorUnits, AreChartsThatNoWayJoinsButForSmallOnes) {
  const Scene scene = test::Builder().floor(0, 0, 10, 10, 0).scene();
  const SearchArea area = Rectangles()
                              .add({0, 0, 0}, 10, 10, {0, 0})
                              .add({0, 0, 3}, 10, 10, {0.2, 0})
                              .add({20, 0, 0}, 1, 1.5, {0.4, 0})
                              .area();
  const FloorUnits units(scene, area, 2);
  const std::vector<PlacedStation> stations{at({5, 5, 3}, {0.25, 0.05}), at({1, 1, 0}, {0.01, 0.01}),
                                            at({2, 1, 0}, {0.02, 0.01}), at({20, 1, 0}, {0.405, 0.01})};
  EXPECT_EQ(units.stations_in(stations), (std::vector<std::vector<std::size_t>>{{1, 2}, {0}}));
}

TEST(FloorUnits, OneFloorIsNoPartOfItself) {
  const Scene scene = test::Builder().floor(0, 0, 10, 10, 0).scene();
  // Triangles side by side with corners of their own; and floors at one place in (u, v), which tells no two apart.
  EXPECT_TRUE(FloorUnits(scene, Rectangles().add({}, 5, 9, {}).add({5, 0, 0}, 5, 9, {0.05, 0}).area(), 2)
                  .stations_in({})
                  .empty());
  EXPECT_TRUE(
      FloorUnits(scene, Rectangles().add({}, 5, 9, {}).add({0, 0, 3}, 4, 9, {}).area(), 2).stations_in({}).empty());
}

TEST(FloorUnits, AreRoomsWithFloor) {
  SceneData data = test::Builder().floor(0, 0, 10, 10, 0).scene().data();
  data.rooms = {{.name = "Hall", .box = {origin + Vec3{0, 0, 0}, origin + Vec3{6, 10, 2.8}}},
                {.name = "Closet", .box = {origin + Vec3{6, 0, 0}, origin + Vec3{7, 1, 2.8}}},
                {.name = "Study", .box = {origin + Vec3{6, 4, 0}, origin + Vec3{10, 10, 2.8}}}};
  const Scene scene(std::make_shared<const SceneData>(std::move(data)));
  const FloorUnits units(scene, Rectangles().add({}, 10, 10, {}).area(), 2);
  const std::vector<PlacedStation> stations{at({8, 6, 0}, {0.08, 0.06}), at({6.5, 0.5, 0}, {0.065, 0.005})};
  EXPECT_EQ(units.stations_in(stations), (std::vector<std::vector<std::size_t>>{{}, {0}}));
}

// A hall, and a room off it through a door: what is beyond pays no station of its own.
class HallWithRoom : public testing::Test {
 protected:
  HallWithRoom() {
    test::Builder builder;
    builder.floor(-0.3, -3.3, 12.3, 10.3, 0);
    builder.box({-0.3, -0.3, 0}, {0, 10.3, 2.8}).box({12, -0.3, 0}, {12.3, 10.3, 2.8});
    builder.box({-0.3, 10, 0}, {12.3, 10.3, 2.8});
    builder.box({0, -0.2, 0}, {1.2, 0, 2.8}).box({2.4, -0.2, 0}, {12, 0, 2.8});  // the door is at 1.2 to 2.4 m
    builder.box({-0.3, -3.3, 0}, {0, -0.3, 2.8}).box({6, -3.3, 0}, {6.3, -0.2, 2.8});
    builder.box({-0.3, -3.3, 0}, {6.3, -3, 2.8});
    SceneData data = builder.scene().data();
    data.rooms = {{.name = "Hall", .box = {origin + Vec3{0, 0, 0}, origin + Vec3{12, 10, 2.8}}},
                  {.name = "Study", .box = {origin + Vec3{0, -3, 0}, origin + Vec3{6, -0.2, 2.8}}}};
    named_.emplace(std::make_shared<const SceneData>(data));
    data.rooms.clear();
    unnamed_.emplace(std::make_shared<const SceneData>(std::move(data)));
  }
  // Stations of the plan for so much surface, and those of them in the study.
  static std::pair<std::size_t, std::size_t> planned(const Scene& scene, double pays_m2) {
    SiteOptions options;
    options.engine = Engine::embree;
    options.user_size_m = 0.3, options.spacing_m = 0.05;
    Site site(scene, options);
    SurveyQuestion question;
    question.pays_m2 = pays_m2;
    const PlanResult result = plan(site, question, {.iterations = 1, .sample_voxels = 1000});
    const PlanEntry& entry = result.front.at(answer(result));
    EXPECT_TRUE(met(result)) << summary_text(result);
    return {entry.stations.size(),
            static_cast<std::size_t>(std::ranges::count_if(entry.stations, [](const PlacedStation& station) {
              const Vec3 ground = station.ground - origin;
              return ground.y < -0.2;
            }))};
  }
  std::optional<Scene> named_, unnamed_;
};

TEST_F(HallWithRoom, APlanOfWhatPaysHasAStationInEachRoom) {
  EXPECT_EQ(planned(*unnamed_, 120).second, 0u) << "the room pays none";
  EXPECT_GE(planned(*named_, 120).second, 1u);
  EXPECT_EQ(planned(*named_, 800).second, 0u) << "what it adds is less than a fifth of what a station has to";
}

}  // namespace
}  // namespace vantage
