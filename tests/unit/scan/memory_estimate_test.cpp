// SPDX-License-Identifier: Apache-2.0
#include "scan/memory_estimate.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <regex>
#include <string>
#include <vector>

#include "core/free_memory.hpp"
#include "support/quad_scene.hpp"
#include "support/temporary_folder.hpp"
#include "trace/vulkan/device_memory.hpp"
#include "vantage/built_in_scenes.hpp"
#include "vantage/error.hpp"
#include "vantage/scene_builder.hpp"
#include "vantage/simulator.hpp"

namespace vantage {
namespace {

Scene built_in(const std::string& name, std::size_t triangles) {
  const test::TemporaryFolder folder;
  write_built_in_scene(name, triangles, folder / "scene.glb");
  return Scene::load(folder / "scene.glb");
}

Simulator simulator(const Scene& scene, double user_size_m, std::uint64_t most = 0) {
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(10);
  return {scene,
          scanner,
          {.engine = Engine::embree,
           .user_size_m = user_size_m,
           .point_spacing_m = user_size_m / 4,
           .max_memory_bytes = most}};
}

TEST(MemoryEstimate, KnowsTheNumberOfVoxels) {
  for (const auto& [name, triangles] : {std::pair{"three-walls", 0}, {"four-walls", 0}, {"industrial", 20'000}}) {
    const Scene scene = built_in(name, static_cast<std::size_t>(triangles));
    for (const double size : {0.2, 0.05}) {
      const auto voxels = static_cast<double>(simulator(scene, size).voxel_count());
      const auto estimate = static_cast<double>(estimate_memory(scene, size).voxels);
      EXPECT_NEAR(estimate / voxels, 1, 0.2) << name << ", " << size << " m: " << voxels << " voxels";
    }
  }
}

TEST(MemoryEstimate, HasTexturesAndTheTreesOfGlassAndMirrors) {
  test::QuadScene plain, textured, glazed, mirrored;
  for (test::QuadScene* scene : {&plain, &textured, &glazed, &mirrored})
    for (int k = 0; k < 100; ++k) scene->quad({static_cast<float>(k), 0, 0}, {0, 1, 0}, {0, 0, 1});
  constexpr std::uint32_t side = 500;
  textured.data().images.push_back({side, side, std::vector<std::uint8_t>(4 * side * side)});
  for (test::QuadScene* scene : {&plain, &glazed, &mirrored})
    for (int k = 0; k < 100; ++k) scene->quad({0, 2, static_cast<float>(k)}, {0, 1, 0}, {0, 0, 1}, Role::blocking);
  for (std::size_t m = 100; m < 200; ++m) glazed.data().meshes[m].glass = true, mirrored.data().meshes[m].mirror = true;
  const auto bytes = [](test::QuadScene& scene, double detection_range_m) {
    Scanner scanner;
    scanner.detection_range_m = detection_range_m;
    const SimulatorConfig config{.engine = Engine::embree, .user_size_m = 1};
    return static_cast<double>(simulator_memory(scene.scene(), {&scanner, 1}, config, 1).bytes);
  };
  test::QuadScene bare = textured;
  bare.data().images.clear();
  EXPECT_EQ(bytes(textured, 0) - bytes(bare, 0), 4.0 * side * side);
  EXPECT_EQ(bytes(glazed, 0), bytes(plain, 0));
  EXPECT_EQ(bytes(glazed, 60) - bytes(plain, 60), 12.0 * 800) << "a copy of the vertices";
  EXPECT_GT(bytes(mirrored, 0), bytes(plain, 0));

  vulkan::DeviceLoad load{.engine = Engine::ray_query, .vertices = 800, .triangles = 400, .shaded = true};
  const double before = vulkan::device_bytes(load);
  load.glass = 200;
  EXPECT_GE(vulkan::device_bytes(load) - before, 200 * 48.0);
}

// Long triangles of hardly any area, crossways through a site, and as the strips of a pole.
TEST(MemoryEstimate, KnowsTheVoxelsOfSlivers) {
  SceneMesh needles, pole;
  const auto add = [](SceneMesh& mesh, const std::array<Vec3, 3>& corners) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
  };
  for (int k = 0; k < 200; ++k) {
    const double y = 20 * std::fmod(k * 0.618034, 1), z = 20 * std::fmod(k * 0.754878, 1);
    add(needles, {{{0, y, z}, {20, 20 - y, 20 - z}, {20, 20 - y + 1e-3, 20 - z}}});
  }
  constexpr int kStrips = 64;
  const auto at = [](int k, double z) {
    const double angle = 2 * M_PI * k / kStrips;
    return Vec3{0.3 * std::cos(angle), 0.3 * std::sin(angle), z};
  };
  for (int k = 0; k < kStrips; ++k) {
    add(pole, {at(k, 0), at(k + 1, 0), at(k + 1, 20)});
    add(pole, {at(k, 0), at(k + 1, 20), at(k, 20)});
  }
  for (const SceneMesh& mesh : {needles, pole}) {
    SceneBuilder builder;
    builder.add(mesh);
    const Scene scene = builder.build();
    for (const double size : {0.3, 0.1}) {
      const auto voxels = static_cast<double>(simulator(scene, size).voxel_count());
      const auto estimate = static_cast<double>(estimate_memory(scene, size).voxels);
      EXPECT_GT(estimate / voxels, 0.5) << size << " m: " << voxels << " voxels";
      EXPECT_LT(estimate / voxels, 1.5) << size << " m: " << voxels << " voxels";
    }
  }
}

TEST(MemoryEstimate, RefusesWhatDoesNotFitAndNamesWhatWould) {
  const Scene scene = built_in("four-walls", 0);
  const std::uint64_t budget = std::uint64_t{400} << 20;
  ASSERT_GT(estimate_memory(scene, 1e-3).bytes, budget);
  try {
    simulator(scene, 1e-3, budget);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::out_of_memory);
    const std::string what = error.what();
    EXPECT_NE(what.find("400 MiB"), std::string::npos) << what;
    std::smatch size;
    ASSERT_TRUE(std::regex_search(what, size, std::regex("a user size of ([0-9.e-]+) m would fit"))) << what;
    EXPECT_NO_THROW(simulator(scene, std::stod(size[1]), budget)) << what;
  }
}

TEST(MemoryEstimate, GrowsWithWhatItIsOf) {
  const Scene small = built_in("industrial", 20'000), large = built_in("industrial", 40'000);
  EXPECT_GT(estimate_memory(large, 0.1).bytes, estimate_memory(small, 0.1).bytes);
  EXPECT_GT(estimate_memory(small, 0.05).bytes, estimate_memory(small, 0.1).bytes);
  EXPECT_GT(estimate_memory(small, 0.1, 65).bytes, estimate_memory(small, 0.1, 64).bytes);
  EXPECT_EQ(estimate_memory(small, 0.1, 1).bytes, estimate_memory(small, 0.1, 64).bytes);
  EXPECT_GT(estimate_memory(small, 1e-12).bytes, std::uint64_t{1} << 50);
}

TEST(FreeMemory, IsSomeAndItsTextHasAUnit) {
  const auto free = free_memory();
  ASSERT_TRUE(free);
  EXPECT_GT(*free, std::uint64_t{64} << 20);
  EXPECT_LT(*free, std::uint64_t{1} << 48);
  EXPECT_EQ(bytes_text(std::uint64_t{850} << 20), "850 MiB");
  EXPECT_EQ(bytes_text(std::uint64_t{12} << 30), "12.0 GiB");
}

}  // namespace
}  // namespace vantage
