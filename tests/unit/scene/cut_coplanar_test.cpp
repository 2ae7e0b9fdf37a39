// SPDX-License-Identifier: Apache-2.0
#include "scene/cut_coplanar.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

namespace vantage {
namespace {

double area_of(const SceneData& scene, std::size_t mesh) {
  double area = 0;
  const MeshRange& range = scene.ranges[mesh];
  for (std::uint32_t t = range.first_triangle; t < range.first_triangle + range.triangle_count; ++t) {
    const auto at = [&](std::size_t c) {
      const Float3& p = scene.positions[scene.triangles[t][c]];
      return Vec3{p.x, p.y, p.z};
    };
    const Vec3 n = cross(at(1) - at(0), at(2) - at(0));
    area += std::sqrt(dot(n, n)) / 2;
  }
  return area;
}

void add(RawScene& raw, const char* name, Role role, const std::vector<Vec3>& corners) {
  const auto base = static_cast<std::uint32_t>(raw.positions.size()),
             count = static_cast<std::uint32_t>(corners.size() / 3);
  raw.ranges.push_back({static_cast<std::uint32_t>(raw.triangles.size()), count, 0});
  raw.meshes.push_back({name, role, 0.5, count});
  for (const Vec3& p : corners) raw.positions.push_back(to_glm(p));
  for (std::uint32_t t = 0; t < count; ++t) raw.triangles.push_back({base + 3 * t, base + 3 * t + 1, base + 3 * t + 2});
}

// A wall of 4 m by 3 m in two triangles, leaning.
Vec3 on_wall(double x, double y) { return {0.8 * x - 0.3 * y, 0.6 * x + 0.4 * y, std::sqrt(0.75) * y}; }
std::vector<Vec3> rectangle(double x0, double y0, double x1, double y1) {
  const Vec3 a = on_wall(x0, y0), b = on_wall(x1, y0), c = on_wall(x1, y1), d = on_wall(x0, y1);
  return {a, b, c, a, c, d};
}
constexpr double kWall_m2 = 12;  // on_wall() keeps lengths

TEST(CutCoplanar, TheWallKeepsWhatTheSheetDoesNotCover) {
  RawScene raw;
  add(raw, "wall", Role::blocking, rectangle(0, 0, 4, 3));
  add(raw, "post", Role::blocking, {{9, 0, 0}, {9, 0, 1}, {9, 1, 0}});
  add(raw, "sheet", Role::surveyed, rectangle(1.1, 0.7, 2.9, 2.3));
  const auto scene = finish_scene(std::move(raw), "wall");
  ASSERT_EQ(scene->ranges.size(), 3u);
  EXPECT_EQ(scene->meshes[1].name, "post");
  EXPECT_EQ(scene->meshes[0].triangle_count, scene->ranges[0].triangle_count);
  EXPECT_EQ(scene->ranges[1].first_triangle, scene->ranges[0].triangle_count);
  EXPECT_EQ(scene->ranges[1].triangle_count, 1u);
  EXPECT_EQ(scene->ranges[2].triangle_count, 2u);
  EXPECT_NEAR(area_of(*scene, 2), 1.8 * 1.6, 1e-5);
  EXPECT_NEAR(area_of(*scene, 0), kWall_m2 - 1.8 * 1.6, 1e-4);
  ASSERT_FALSE(scene->notes.empty());
  EXPECT_NE(scene->notes.back().find("2 blocking triangles lies in one plane with 2 surveyed"), std::string::npos)
      << scene->notes.back();
}

TEST(CutCoplanar, AWallBehindASheetOfItsOwnSizeIsGone) {
  RawScene raw;
  add(raw, "wall", Role::blocking, rectangle(0, 0, 4, 3));
  const Vec3 a = on_wall(0, 0), b = on_wall(4, 0), c = on_wall(4, 3), d = on_wall(0, 3);
  add(raw, "sheet", Role::surveyed, {a, b, d, b, c, d});  // the other diagonal
  const auto scene = finish_scene(std::move(raw), "wall");
  ASSERT_EQ(scene->meshes.size(), 1u);
  EXPECT_EQ(scene->meshes[0].name, "sheet");
}

TEST(CutCoplanar, NewVerticesGetTheirShareOfTheCornersAttributes) {
  RawScene raw;
  add(raw, "wall", Role::blocking, {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}});
  add(raw, "sheet", Role::surveyed, {{1, 1, 0}, {2, 1, 0}, {1, 2, 0}});
  // Linear over the plane, so also at every vertex that remains.
  for (const glm::dvec3& p : raw.positions) {
    raw.texcoords.push_back({static_cast<float>(p.x / 4), static_cast<float>(p.y / 4)});
    const auto channel = [](double v) { return static_cast<std::uint32_t>(std::lround(v)); };
    raw.colours.push_back(channel(p.x * 60) | channel(p.y * 60) << 8 | 200u << 16 | 255u << 24);
    raw.normals.push_back({0, 0, 1});
  }
  const auto scene = finish_scene(std::move(raw), "wall");
  EXPECT_GT(scene->positions.size(), 6u + 3u);
  ASSERT_EQ(scene->texcoords.size(), scene->positions.size());
  ASSERT_EQ(scene->colours.size(), scene->positions.size());
  ASSERT_EQ(scene->normals.size(), scene->positions.size());
  for (std::size_t v = 0; v < scene->positions.size(); ++v) {
    const double x = scene->positions[v].x + scene->origin.x, y = scene->positions[v].y + scene->origin.y;
    EXPECT_NEAR(scene->texcoords[v].x, x / 4, 1e-6);
    EXPECT_NEAR(scene->texcoords[v].y, y / 4, 1e-6);
    EXPECT_NEAR(scene->colours[v] & 255u, x * 60, 0.51);
    EXPECT_NEAR(scene->colours[v] >> 8 & 255u, y * 60, 0.51);
    EXPECT_EQ(scene->colours[v] >> 16, 200u | 255u << 8);
    EXPECT_EQ(scene->normals[v], (Float3{0, 0, 1}));
  }
}

}  // namespace
}  // namespace vantage
