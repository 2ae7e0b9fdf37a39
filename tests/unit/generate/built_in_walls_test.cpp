// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "scene/scene_data.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/built_in_scenes.hpp"
#include "vantage/error.hpp"
#include "vantage/scene.hpp"

namespace vantage {
namespace {

Scene built_in(const std::string& name) {
  const test::TemporaryFolder folder;
  write_built_in_scene(name, 0, folder / "scene.glb");
  return Scene::load(folder / "scene.glb");
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

Vec3 corner(const SceneData& data, std::uint32_t triangle, int c) {
  const Float3& p = data.positions[data.triangles[triangle][static_cast<std::size_t>(c)]];
  return {p.x, p.y, p.z};
}

TEST(FourWalls, AreFourHundredTrianglesOfAHollowSquare) {
  const Scene scene = built_in("four-walls");
  const SceneData& data = scene.data();
  EXPECT_EQ(scene.triangle_count(), 400u);
  ASSERT_EQ(scene.meshes().size(), 4u);
  for (const MeshInfo& mesh : scene.meshes()) {
    EXPECT_EQ(mesh.role, Role::surveyed);
    EXPECT_EQ(mesh.triangle_count, 100u);
  }
  EXPECT_EQ(data.origin, (Vec3{0, 0, 0}));
  EXPECT_EQ(scene.bounds().min, (Vec3{-5, -5, 0}));
  EXPECT_EQ(scene.bounds().max, (Vec3{5, 5, 5}));
  EXPECT_TRUE(scene.notes().empty());
  double area = 0;
  for (std::uint32_t t = 0; t < data.triangles.size(); ++t) {
    const Vec3 a = corner(data, t, 0), n = cross(corner(data, t, 1) - a, corner(data, t, 2) - a);
    EXPECT_DOUBLE_EQ(std::sqrt(dot(n, n)), 1.0);
    EXPECT_GT(dot(n, {a.x, a.y, 0}), 0) << "the winding of triangle " << t << " must face outward";
    area += std::sqrt(dot(n, n)) / 2;
  }
  EXPECT_DOUBLE_EQ(area, 200);
}

TEST(FourWalls, HaveAFloorWithTheSquareAsAHole) {
  const Scene scene = built_in("four-walls");
  const SceneData& data = scene.data();
  ASSERT_TRUE(scene.has_search_area());
  ASSERT_EQ(data.search_uvs.size(), data.search_positions.size());
  double area = 0;
  for (const Triangle& t : data.search_triangles) {
    const Vec3 &a = data.search_positions[t[0]], &b = data.search_positions[t[1]], &c = data.search_positions[t[2]];
    const Vec3 n = cross(b - a, c - a);
    EXPECT_GT(n.z, 0);
    area += n.z / 2;
    const Vec3 centroid = (a + b + c) * (1.0 / 3);
    EXPECT_FALSE(std::abs(centroid.x) < 5 && std::abs(centroid.y) < 5) << "inside the walls";
  }
  EXPECT_DOUBLE_EQ(area, 800);
  for (std::size_t v = 0; v < data.search_positions.size(); ++v) {
    EXPECT_NEAR(data.search_uvs[v].u, (data.search_positions[v].x + 15) / 30, 1e-7);
    EXPECT_NEAR(data.search_uvs[v].v, (data.search_positions[v].y + 15) / 30, 1e-7);
    EXPECT_EQ(data.search_positions[v].z, 0);
  }
}

TEST(ThreeWalls, FaceTheScannerAtTheirDistances) {
  const Scene scene = built_in("three-walls");
  const SceneData& data = scene.data();
  ASSERT_EQ(scene.meshes().size(), 3u);
  const double distances[3] = {10, 30, 30}, aside[3] = {0, 17.875, -17.875};
  for (std::uint32_t m = 0; m < 3; ++m) {
    EXPECT_EQ(scene.meshes()[m].role, Role::surveyed);
    EXPECT_DOUBLE_EQ(scene.meshes()[m].diffuse, 0.1);
    ASSERT_EQ(data.ranges[m].triangle_count, 2u);
    double area = 0;
    for (std::uint32_t t = data.ranges[m].first_triangle; t < data.ranges[m].first_triangle + 2; ++t) {
      const Vec3 a = corner(data, t, 0), n = cross(corner(data, t, 1) - a, corner(data, t, 2) - a);
      area += std::sqrt(dot(n, n)) / 2;
      for (int c = 0; c < 3; ++c) {
        const Vec3 p = corner(data, t, c) + data.origin;
        EXPECT_EQ(p.x, distances[m]);
        EXPECT_EQ(std::abs(p.y - aside[m]), 2.5);
        EXPECT_TRUE(p.z == 0 || p.z == 2.5);
      }
      EXPECT_LT(n.x, 0) << "the front faces the scanner";
    }
    EXPECT_DOUBLE_EQ(area, 12.5);
  }
  EXPECT_TRUE(scene.has_search_area());
}

TEST(BuiltInScenes, CarryTheMethodsParameters) {
  const auto four = nlohmann::json::parse(built_in("four-walls").defaults_json());
  EXPECT_EQ(four["scanner"]["step"], 0.1);
  EXPECT_EQ(four["scanner"]["height"], 1.5);
  EXPECT_EQ(four["scanner"]["noise"], "off");
  EXPECT_EQ(four["spacing"], 0.01);
  EXPECT_EQ(four["user-size"], 0.1);
  const auto three = nlohmann::json::parse(built_in("three-walls").defaults_json());
  EXPECT_NEAR(three["scanner"]["step"].get<double>(), 0.034377, 1e-6);  // 6 mm at 10 m
  EXPECT_EQ(three["spacing"], 0.006);
  EXPECT_EQ(three["user-size"], 0.01);
  EXPECT_EQ(three["station"], nlohmann::json({0, 0, 1.5}));
}

TEST(BuiltInScenes, AreTheSameBytesEveryTime) {
  const test::TemporaryFolder folder;
  for (const std::string& name : built_in_scene_names()) {
    write_built_in_scene(name, 20'000, folder / "first.glb");
    write_built_in_scene(name, 20'000, folder / "second.glb");
    EXPECT_EQ(bytes_of(folder / "first.glb"), bytes_of(folder / "second.glb")) << name;
  }
}

TEST(BuiltInScenes, TheFilesInDataAreUpToDate) {
  const test::TemporaryFolder folder;
  const std::pair<const char*, const char*> files[] = {{"three-walls", "three_walls.glb"},
                                                       {"four-walls", "four_walls.glb"},
                                                       {"industrial", "industrial_20k.glb"},
                                                       {"office", "office.glb"}};
  for (const auto& [name, file] : files) {
    write_built_in_scene(name, 20'000, folder / file);
    const Scene fresh = Scene::load(folder / file),
                kept = Scene::load(std::filesystem::path(VANTAGE_DATA_FOLDER) / file);
    EXPECT_EQ(fresh.defaults_json(), kept.defaults_json());
    ASSERT_EQ(fresh.data().triangles, kept.data().triangles) << "make data/" << file << " again, see data/README.md";
    for (std::size_t v = 0; v < fresh.data().positions.size(); ++v) {  // another sine may round differently
      const Float3 &a = fresh.data().positions[v], &b = kept.data().positions[v];
      ASSERT_TRUE(std::abs(a.x - b.x) < 1e-5 && std::abs(a.y - b.y) < 1e-5 && std::abs(a.z - b.z) < 1e-5) << file;
    }
  }
}

TEST(BuiltInScenes, UnknownNamesAreRefused) {
  const test::TemporaryFolder folder;
  try {
    write_built_in_scene("five-walls", 0, folder / "scene.glb");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::invalid_argument);
    EXPECT_NE(std::string(error.what()).find("five-walls"), std::string::npos);
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "scene.glb"));
}

}  // namespace
}  // namespace vantage
