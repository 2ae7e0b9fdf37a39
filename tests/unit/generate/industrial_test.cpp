// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "scene/scene_data.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/built_in_scenes.hpp"
#include "vantage/error.hpp"
#include "vantage/scene.hpp"

namespace vantage {
namespace {

Scene site(std::size_t triangles) {
  const test::TemporaryFolder folder;
  write_built_in_scene("industrial", triangles, folder / "site.glb");
  return Scene::load(folder / "site.glb");
}

const Scene& small_site() {
  static const Scene scene = site(20'000);
  return scene;
}

Vec3 position(const SceneData& data, std::uint32_t v) {
  return {data.positions[v].x, data.positions[v].y, data.positions[v].z};
}

class IndustrialBudget : public testing::TestWithParam<std::size_t> {};

TEST_P(IndustrialBudget, IsMetWithinTwoPercentWithoutABrokenTriangle) {
  const std::size_t wish = GetParam();
  const Scene scene = site(wish);
  EXPECT_NEAR(static_cast<double>(scene.triangle_count()), static_cast<double>(wish), 0.02 * static_cast<double>(wish));
  EXPECT_TRUE(scene.notes().empty()) << scene.notes()[0];
  EXPECT_EQ(scene.data().search_triangles.size(), 1400u);
  std::size_t surveyed = 0;
  for (const MeshInfo& mesh : scene.meshes()) surveyed += mesh.role == Role::surveyed ? mesh.triangle_count : 0;
  EXPECT_GT(static_cast<double>(surveyed), 0.6 * static_cast<double>(wish));
}

INSTANTIATE_TEST_SUITE_P(Sizes, IndustrialBudget,
                         testing::Values(20'000, 23'456, 47'000, 60'000, 199'999, 200'000, 600'000));

TEST(Industrial, FillsTheMethodsVolumeAndStandsAboveGround) {
  const SceneData& data = small_site().data();
  Box plant, ground;
  for (std::size_t m = 0; m < data.ranges.size(); ++m) {
    Box& box = data.meshes[m].role == Role::surveyed ? plant : ground;
    for (std::uint32_t t = data.ranges[m].first_triangle;
         t < data.ranges[m].first_triangle + data.ranges[m].triangle_count; ++t)
      for (const std::uint32_t v : data.triangles[t]) box.extend(position(data, v));
    if (data.meshes[m].role == Role::surveyed) {
      EXPECT_EQ(data.meshes[m].diffuse, 0.24) << data.meshes[m].name;
    }
  }
  EXPECT_GE(plant.min.z, 0);
  EXPECT_GE(plant.min.x, -7.5);
  EXPECT_GE(plant.min.y, -7.25);
  EXPECT_LE(plant.max.x, 7.5);
  EXPECT_LE(plant.max.y, 7.25);
  EXPECT_LE(plant.max.z, 4.5);
  EXPECT_GT(plant.size().x, 14.5);
  EXPECT_GT(plant.size().y, 14);
  EXPECT_GT(plant.size().z, 4.3);
  EXPECT_DOUBLE_EQ(ground.size().x, 40);
  EXPECT_DOUBLE_EQ(ground.size().y, 40);
  EXPECT_NEAR(ground.max.z, 2.3, 0.05);
  EXPECT_NEAR(ground.min.z, 0, 0.05);
}

TEST(Industrial, HasWhatAPlantHasAsNamedParts) {
  std::set<std::string> names;
  for (const MeshInfo& mesh : small_site().meshes()) names.insert(mesh.name);
  for (const char* name :
       {"tank-1", "tank-3", "drum", "reactor-2", "exchanger-1", "pump-3", "pipe-rack", "pipe-drain-header",
        "platform-west", "railing-south", "stairs-north", "ladder-west", "cable-tray", "ground"})
    EXPECT_TRUE(names.count(name)) << name;
  EXPECT_EQ(names.size(), small_site().meshes().size()) << "names are unique, so that patterns can tell parts apart";
}

TEST(Industrial, NormalsAgreeWithWindings) {
  for (const std::size_t size : {std::size_t{20'000}, std::size_t{250'000}}) {
    const Scene scene = size == 20'000 ? small_site() : site(size);
    const SceneData& data = scene.data();
    std::map<std::string, int> wrong;
    for (std::uint32_t t = 0; t < data.triangles.size(); ++t) {
      const Triangle& triangle = data.triangles[t];
      const Vec3 a = position(data, triangle[0]),
                 n = cross(position(data, triangle[1]) - a, position(data, triangle[2]) - a);
      Vec3 mean;
      for (const std::uint32_t v : triangle) {
        const Float3& normal = data.normals[v];
        EXPECT_NEAR(std::hypot(normal.x, normal.y, normal.z), 1, 1e-5);
        mean = mean + Vec3{normal.x, normal.y, normal.z};
      }
      if (!(dot(n, mean) > 0)) ++wrong[data.meshes[data.mesh_of(t)].name];
    }
    EXPECT_TRUE(wrong.empty()) << wrong.begin()->first << ": " << wrong.begin()->second;
  }
}

// Triangles of a pipe face away from its axis: the signed volume of a closed shell is positive.
TEST(Industrial, PipesFaceOutward) {
  const SceneData& data = small_site().data();
  for (std::size_t m = 0; m < data.ranges.size(); ++m) {
    const std::string& name = data.meshes[m].name;
    if (name != "tank-1" && name != "drum" && name != "pipe-water" && name != "pipe-steam" && name != "cabinets" &&
        name != "cables")
      continue;
    double volume = 0;
    const Vec3 about = position(data, data.triangles[data.ranges[m].first_triangle][0]);
    for (std::uint32_t t = data.ranges[m].first_triangle;
         t < data.ranges[m].first_triangle + data.ranges[m].triangle_count; ++t) {
      const Triangle& triangle = data.triangles[t];
      volume += dot(position(data, triangle[0]) - about,
                    cross(position(data, triangle[1]) - about, position(data, triangle[2]) - about)) /
                6;
    }
    EXPECT_GT(volume, 0.001) << name;
  }
}

TEST(Industrial, SearchAreaFillsTheUvOfThePaper) {
  const SceneData& data = small_site().data();
  ASSERT_EQ(data.search_uvs.size(), data.search_positions.size());
  double ground_area = 0, ground_uv = 0, deck_area = 0, deck_uv = 0, largest_u = 0;
  for (const Triangle& t : data.search_triangles) {
    const Vec3 a = data.search_positions[t[0]],
               n = cross(data.search_positions[t[1]] - a, data.search_positions[t[2]] - a);
    const Uv &i = data.search_uvs[t[0]], &j = data.search_uvs[t[1]], &k = data.search_uvs[t[2]];
    const double area = std::sqrt(dot(n, n)) / 2, uv = ((j.u - i.u) * (k.v - i.v) - (j.v - i.v) * (k.u - i.u)) / 2;
    EXPECT_GT(n.z, 0);
    EXPECT_GT(uv, 0) << "the chart is turned over";
    const bool deck = std::min({i.u, j.u, k.u}) > 1;
    (deck ? deck_area : ground_area) += area;
    (deck ? deck_uv : ground_uv) += uv;
    for (const Uv& p : {i, j, k}) {
      largest_u = std::max(largest_u, p.u);
      EXPECT_GE(p.u, 0);
      EXPECT_GE(p.v, 0);
      EXPECT_LE(p.v, 1);
    }
  }
  EXPECT_NEAR(ground_uv, 1, 1e-5);
  EXPECT_NEAR(deck_area / ground_area, deck_uv / ground_uv, 1e-5);
  EXPECT_NEAR(largest_u, 1.15, 0.02);
  EXPECT_GT(deck_area, 30);
}

TEST(Industrial, CarriesTableFour) {
  const auto defaults = nlohmann::json::parse(small_site().defaults_json());
  EXPECT_EQ(defaults["scanner"]["step"], 0.0286);
  EXPECT_EQ(defaults["scanner"]["horizontal"], 360);
  EXPECT_EQ(defaults["scanner"]["vertical"], 300);
  EXPECT_EQ(defaults["scanner"]["height"], 1.85);
  EXPECT_EQ(defaults["scanner"]["range"], nlohmann::json({0.1, 130}));
  EXPECT_EQ(defaults["scanner"]["noise"], "rtc360");
  EXPECT_EQ(defaults["spacing"], 0.005);
  EXPECT_EQ(defaults["user-size"], 0.01);
  EXPECT_EQ(defaults["security"], nlohmann::json({0.6, 1.35, 0.5}));
}

TEST(Industrial, FewerThanTwentyThousandTrianglesAreRefused) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(write_built_in_scene("industrial", 19'999, folder / "site.glb"), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "site.glb"));
}

}  // namespace
}  // namespace vantage
