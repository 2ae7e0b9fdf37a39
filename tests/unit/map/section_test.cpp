// SPDX-License-Identifier: Apache-2.0
#include "map/section.hpp"

#include <gtest/gtest.h>

#include "scene/scene_data.hpp"

namespace vantage {
namespace {

// Boxes and sheets far from the world's origin, a point for each face's corner, as files have them.
class Builder {
 public:
  // Faces outward, or inward as a room that was modelled from inside.
  void box(double x0, double y0, double z0, double x1, double y1, double z1, bool inward = false) {
    const auto p = [&](int k) { return Vec3{k & 1 ? x1 : x0, k & 2 ? y1 : y0, k & 4 ? z1 : z0}; };
    for (const auto& [a, b, c, d] : std::vector<std::array<int, 4>>{
             {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
      inward ? quad(p(d), p(c), p(b), p(a)) : quad(p(a), p(b), p(c), p(d));
  }
  void quad(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    const auto n = static_cast<std::uint32_t>(positions.size());
    for (const Vec3& v : {a, b, c, d}) positions.push_back(v + kPlace);
    triangles.insert(triangles.end(), {{n, n + 1, n + 2}, {n, n + 2, n + 3}});
  }
  // True if (x, y) is solid at height z.
  bool solid(double x, double y, double z) const {
    const Scene scene = Scene::from_triangles(positions, triangles);
    const Section section = section_at(scene.data(), kWindow, z + kPlace.z);
    const MapPoint at = kWindow.at(Vec3{x, y, 0} + kPlace);
    return section.solid[static_cast<std::size_t>(at.y) * kWindow.columns + static_cast<std::size_t>(at.x)] != 0;
  }
  // The same where these places are known to be free.
  bool solid_but(const std::vector<Vec3>& free, double x, double y, double z) const {
    const Scene scene = Scene::from_triangles(positions, triangles);
    std::vector<Vec3> places;
    for (const Vec3& place : free) places.push_back(place + kPlace);
    const Section section = section_at(scene.data(), kWindow, z + kPlace.z, places);
    const MapPoint at = kWindow.at(Vec3{x, y, 0} + kPlace);
    return section.solid[static_cast<std::size_t>(at.y) * kWindow.columns + static_cast<std::size_t>(at.x)] != 0;
  }
  // The section at height z if the triangles from `first` on are of glass, and its value at (x, y).
  std::pair<Section, int> with_glass(std::uint32_t first, double x, double y, double z) const {
    SceneData data = Scene::from_triangles(positions, triangles).data();
    const auto count = static_cast<std::uint32_t>(data.triangles.size()) - first;
    data.meshes = {{.name = "opaque", .triangle_count = first},
                   {.name = "glass", .role = Role::blocking, .triangle_count = count, .glass = true}};
    data.ranges = {{0, first, 0}, {first, count, 0}};
    Section section = section_at(data, kWindow, z + kPlace.z);
    const MapPoint at = kWindow.at(Vec3{x, y, 0} + kPlace);
    const int value = section.solid[static_cast<std::size_t>(at.y) * kWindow.columns + static_cast<std::size_t>(at.x)];
    return {std::move(section), value};
  }
  std::size_t outlines(double z) const {
    return section_at(Scene::from_triangles(positions, triangles).data(), kWindow, z + kPlace.z).outlines.size();
  }

 private:
  static constexpr Vec3 kPlace{500'000, 4'500'000, 100};
  static constexpr MapWindow kWindow{
      .x_min = 500'000 - 6, .y_max = 4'500'000 + 6, .pixel_m = 0.05, .columns = 240, .rows = 240};
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

TEST(Section, BoxesAreSolidAtTheirOwnHeights) {
  Builder site;
  site.box(-1, -1, 0, 1, 1, 2);
  EXPECT_TRUE(site.solid(0, 0, 1.2));
  EXPECT_TRUE(site.solid(-0.97, 0.97, 1.2));
  EXPECT_FALSE(site.solid(1.05, 0, 1.2));
  EXPECT_FALSE(site.solid(0, -1.05, 1.2));
  EXPECT_FALSE(site.solid(0, 0, 2.5));
  EXPECT_EQ(site.outlines(1.2), 8u);  // two triangles a side
  EXPECT_EQ(site.outlines(2.5), 0u);
}

TEST(Section, GlassIsToldFromWhatIsOpaque) {
  Builder site;
  site.box(-1, -1, 0, 1, 1, 2), site.box(0.5, -3, 0, 0.7, 3, 2);
  const auto at = [&](double x, double y) { return site.with_glass(12, x, y, 1.2).second; };
  EXPECT_EQ(at(-0.5, 0), 1);
  EXPECT_EQ(at(0.6, 2), 2);
  EXPECT_EQ(at(0.6, 0), 1) << "what is opaque lies over glass";
  EXPECT_EQ(at(3, 3), 0);
  const Section section = site.with_glass(12, 0, 0, 1.2).first;
  EXPECT_EQ(section.outlines.size(), 8u);
  EXPECT_EQ(section.glass_outlines.size(), 8u);
}

TEST(Section, OverlappingBoxesStaySolid) {
  Builder site;
  site.box(-3, -0.1, 0, 3, 0.1, 3), site.box(-0.1, -3, 0, 0.1, 3, 3);
  EXPECT_TRUE(site.solid(0, 0, 1.2));
  EXPECT_TRUE(site.solid(0, 2, 1.2));
  EXPECT_TRUE(site.solid(-2, 0, 1.2));
  EXPECT_FALSE(site.solid(1, 1, 1.2));
}

TEST(Section, BetweenTwoSkinsIsWallAndTheRoomIsFree) {
  Builder site;
  site.box(-4, -4, 0, 4, 4, 3), site.box(-3.7, -3.7, 0.1, 3.7, 3.7, 2.9, true);
  site.box(0, 0, 0.1, 0.5, 0.5, 2);  // a cupboard in it
  EXPECT_TRUE(site.solid(-3.85, 0, 1.2));
  EXPECT_TRUE(site.solid(0, 3.85, 1.2));
  EXPECT_FALSE(site.solid(-2, 0, 1.2));
  EXPECT_TRUE(site.solid(0.25, 0.25, 1.2));
  Builder room;
  room.box(-4, -4, 0, 4, 4, 3, true);  // without an outside
  EXPECT_FALSE(room.solid(0, 0, 1.2));
  EXPECT_FALSE(room.solid(-5, 0, 1.2));
}

// A lining in one sheet, whose faces look outward, with a pillar in it.
TEST(Section, NothingIsFilledAroundAPlaceThatIsFree) {
  Builder tunnel;
  tunnel.box(-5, -2, 0, 5, 2, 4), tunnel.box(1, -0.3, 0, 1.6, 0.3, 4);
  EXPECT_TRUE(tunnel.solid(-3, 0, 1.2));
  const std::vector<Vec3> station{{-2, 0.5, 0}};
  EXPECT_FALSE(tunnel.solid_but(station, -3, 0, 1.2));
  EXPECT_FALSE(tunnel.solid_but(station, 4, 1, 1.2));
  EXPECT_TRUE(tunnel.solid_but(station, 1.3, 0, 1.2)) << "the pillar is another surface";
  Builder house;  // a station in a room of two skins takes nothing from its walls
  house.box(-4, -4, 0, 4, 4, 3), house.box(-3.7, -3.7, 0.1, 3.7, 3.7, 2.9, true);
  EXPECT_TRUE(house.solid_but({{0, 0, 0}}, -3.85, 0, 1.2));
  EXPECT_FALSE(house.solid_but({{0, 0, 0}}, 2, 0, 1.2));
}

TEST(Section, SheetsAreOutlinesAndSpoilNothing) {
  Builder site;
  site.quad({-5, -3, 0}, {-5, 3, 0}, {-5, 3, 3}, {-5, -3, 3});
  EXPECT_FALSE(site.solid(0, 0, 1.2));
  site.box(-1, -1, 0, 1, 1, 2);
  site.quad({3, 3, 0}, {3, -3, 0}, {3, -3, 3}, {3, 3, 3});
  EXPECT_TRUE(site.solid(0, 0, 1.2));
  EXPECT_FALSE(site.solid(-3, 0, 1.2));
  EXPECT_FALSE(site.solid(2, 0, 1.2));
  EXPECT_FALSE(site.solid(5, 0, 1.2));
}

}  // namespace
}  // namespace vantage
