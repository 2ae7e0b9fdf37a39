// SPDX-License-Identifier: Apache-2.0
// A simulator that takes a changed scene, or other scanners, gives what a new one gives, bit for bit, on every engine.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/philox.hpp"
#include "scene/scene_data.hpp"
#include "scene/scene_difference.hpp"
#include "support/engines.hpp"
#include "support/expect_counts.hpp"
#include "support/quad_scene.hpp"
#include "vantage/error.hpp"
#include "vantage/scene_builder.hpp"
#include "vantage/simulator.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {
namespace {

using test::coarse_scanner;

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : stream_(seed, 0x6368616e6765) {}
  double between(double low, double high) { return low + (high - low) * stream_.uniform(); }
  std::size_t below(std::size_t n) {
    return std::min(n - 1, static_cast<std::size_t>(between(0, static_cast<double>(n))));
  }

 private:
  RandomStream stream_;
};

// Ground of 2 · n² triangles that undulates.
SceneMesh ground(int n) {
  SceneMesh mesh{.name = "ground"};
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const double x = 12.0 * i / n - 6, y = 12.0 * j / n - 6;
      mesh.positions.push_back({x, y, 0.1 * std::sin(x) * std::cos(1.3 * y)});
    }
  const auto at = [n](int i, int j) { return static_cast<std::uint32_t>(i * (n + 1) + j); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

// A machine at the origin: a box, or a ball of flat facets.
SceneMesh machine(Dice& dice, const std::string& name) {
  SceneMesh mesh{.name = name, .role = dice.between(0, 1) < 0.7 ? Role::surveyed : Role::blocking};
  const double size = dice.between(0.3, 1);
  if (dice.between(0, 1) < 0.5) {
    for (int i = 0; i < 8; ++i)
      mesh.positions.push_back({i & 1 ? size : -size, i & 2 ? size / 2 : -size / 2, i & 4 ? size : 0});
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
  }
  constexpr std::uint32_t n = 8;
  for (std::uint32_t i = 0; i <= n; ++i)
    for (std::uint32_t j = 0; j < n; ++j) {
      const double zenith = std::numbers::pi * i / n, azimuth = 2 * std::numbers::pi * j / n;
      mesh.positions.push_back({size * std::sin(zenith) * std::cos(azimuth),
                                size * std::sin(zenith) * std::sin(azimuth), size * (1 + std::cos(zenith))});
    }
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t next = (j + 1) % n;
      mesh.triangles.push_back({i * n + j, (i + 1) * n + j, (i + 1) * n + next});
      mesh.triangles.push_back({i * n + j, (i + 1) * n + next, i * n + next});
    }
  return mesh;
}

Pose somewhere(Dice& dice) {
  const double half = dice.between(-1.5, 1.5);
  return {.translation = {dice.between(-4, 4), dice.between(-4, 4), dice.between(-0.1, 0.4)},
          .rotation = {dice.between(-0.1, 0.1), 0, std::sin(half), std::cos(half)}};
}

Scene plant(Dice& dice, std::size_t machines) {
  Scene scene = with_changes(test::wall_and_floor({100, 20, 0}).scene(), {.add = {ground(24)}});
  SceneChange change;
  for (std::size_t k = 0; k < machines; ++k) {
    change.add.push_back(machine(dice, "machine-" + std::to_string(k)));
    change.add.back().pose = somewhere(dice);
    change.add.back().pose.translation = change.add.back().pose.translation + Vec3{100, 20, 0};
  }
  change.move = {{"ground", {.translation = {100, 20, -1}}}};
  return with_changes(scene, change);
}

// Moves, leaves out or adds one or two machines of a scene.
Scene changed(Dice& dice, const Scene& scene, std::size_t number) {
  std::vector<std::string> names;
  for (const MeshInfo& mesh : scene.meshes())
    if (mesh.name.starts_with("machine")) names.push_back(mesh.name);
  SceneChange change;
  for (std::size_t k = 0; k < 1 + dice.below(2); ++k) {
    const double kind = dice.between(0, 1);
    if (kind < 0.6 && !names.empty()) {
      const double turned = dice.between(-0.05, 0.05);  // about the frame's origin, 100 m away
      change.move.push_back({names[dice.below(names.size())],
                             {.translation = {dice.between(-1, 1), dice.between(-1, 1), dice.between(-0.1, 0.1)},
                              .rotation = {0, 0, turned / 10, 1}}});
    } else if (kind < 0.75 && names.size() > 3) {
      change.remove.push_back(names[dice.below(names.size())]);
    } else {
      change.add.push_back(machine(dice, "machine-new-" + std::to_string(number) + "-" + std::to_string(k)));
      change.add.back().pose = somewhere(dice);
      change.add.back().pose.translation = change.add.back().pose.translation + Vec3{100, 20, 0};
    }
  }
  return with_changes(scene, change);
}

SimulatorConfig on(const EngineInfo& engine) {
  return {.engine = engine.engine, .device_index = engine.device_index, .user_size_m = 0.2, .point_spacing_m = 0.05};
}

void expect_alike(Simulator& got, Simulator& fresh, std::uint64_t seed) {
  ASSERT_EQ(got.voxel_count(), fresh.voxel_count());
  EXPECT_EQ(got.voxel_size_m(), fresh.voxel_size_m());
  EXPECT_EQ(got.goal_density(), fresh.goal_density());
  for (std::uint64_t v = 0; v < got.voxel_count(); ++v) {
    ASSERT_EQ(got.voxel_centre(v), fresh.voxel_centre(v));
    ASSERT_EQ(got.voxel_weight(v), fresh.voxel_weight(v));
    ASSERT_EQ(got.point_weight(v), fresh.point_weight(v));
  }
  Dice dice(seed);
  Network network;
  for (int k = 0; k < 3; ++k)
    network.push_back({.position = {100 + dice.between(-5, 5), 20 + dice.between(-5, 5), dice.between(0, 1.5)}});
  network[1].setup.heading = Angle::degrees(20), network[1].setup.tilt = Angle::degrees(3);
  for (const bool skip : {true, false}) {
    VoxelField one, other;
    const NetworkCounts counts = got.evaluate(network, {.skip = skip, .field = &one, .meshes = true});
    const NetworkCounts expected = fresh.evaluate(network, {.skip = skip, .field = &other, .meshes = true});
    test::expect_equal_counts(counts, expected);
    EXPECT_EQ(counts.points, expected.points);
    EXPECT_EQ(counts.points_on_surveyed, expected.points_on_surveyed);
    EXPECT_EQ(counts.rays, expected.rays);
    EXPECT_EQ(one.count, other.count);
    for (std::size_t v = 0; v < one.count.size(); ++v) ASSERT_EQ(one.stations.word(0, v), other.stations.word(0, v));
    for (std::size_t m = 0; m < counts.meshes.size(); ++m)
      EXPECT_EQ(counts.meshes[m].captured, expected.meshes[m].captured);
  }
  for (const std::uint64_t from : {0, 50, 100}) {  // lists of bricks from the second sample on
    std::vector<std::uint32_t> points, expected_points;
    const auto into = [](std::vector<std::uint32_t>& all) {
      return [&all](std::size_t, std::span<const std::uint32_t> of) { all.assign(of.begin(), of.end()); };
    };
    const auto counts = got.evaluate_sampled({&network, 1}, {.voxels = 50, .from = from, .points = into(points)});
    const auto expected =
        fresh.evaluate_sampled({&network, 1}, {.voxels = 50, .from = from, .points = into(expected_points)});
    test::expect_equal_counts(counts.front(), expected.front());
    EXPECT_EQ(points, expected_points);
  }
  const ScanOptions all{.outputs = scan_range | scan_position | scan_normal | scan_reflectivity | scan_ids |
                                   scan_colour | scan_voxel};
  const ScanPoints points = got.scan_points(network[1], all), expected = fresh.scan_points(network[1], all);
  EXPECT_EQ(points.ray, expected.ray);
  EXPECT_EQ(points.range_m, expected.range_m);
  EXPECT_EQ(points.normal, expected.normal);
  EXPECT_EQ(points.reflectivity, expected.reflectivity);
  EXPECT_EQ(points.mesh, expected.mesh);
  EXPECT_EQ(points.primitive, expected.primitive);
  EXPECT_EQ(points.colour, expected.colour);
  EXPECT_EQ(points.voxel, expected.voxel);
}

TEST(SetScene, EqualsANewSimulatorAfterManyChangesOnEveryEngine) {
  for (const EngineInfo& engine : test::usable_engines()) {
    const bool embree = engine.engine == Engine::embree;
    int kept = 0;
    for (std::uint64_t seed = 1; seed <= (embree ? 4u : 1u); ++seed) {
      Dice dice(seed);
      Scene scene = plant(dice, 6);
      Simulator simulator(scene, coarse_scanner(2), on(engine));
      for (std::size_t step = 0; step < (embree ? 6 : 1); ++step) {
        SCOPED_TRACE(engine.device + ", seed " + std::to_string(seed) + ", step " + std::to_string(step));
        if (step == 3) simulator.evaluate_sampled(std::vector<Network>{{{.position = {101, 20, 1}}}}, {.voxels = 50});
        scene = changed(dice, scene, step);
        kept += simulator.set_scene(scene);
        EXPECT_EQ(simulator.scene().fingerprint(), scene.fingerprint());
        Simulator fresh(scene, coarse_scanner(2), on(engine));
        expect_alike(simulator, fresh, seed);
        if (testing::Test::HasFatalFailure()) return;
      }
    }
    if (embree) {
      EXPECT_GE(kept, 12) << "of 24: most changes are small";
    } else if (engine.engine == Engine::ray_query) {
      EXPECT_EQ(kept, 0) << engine.device;
    }
  }
}

// The engine compute_bvh fits the boxes of its tree anew.
TEST(SetScene, MovesMeshesThatStayWhereTheyAreStoredOnEveryEngine) {
  for (const EngineInfo& engine : test::usable_engines()) {
    Dice dice(12);
    Scene scene = plant(dice, 6);
    Scanner scanner = coarse_scanner(2);
    scanner.noise = rtc360_noise();
    SimulatorConfig config = on(engine);
    config.max_incidence = Angle::degrees(80);
    Simulator simulator(scene, scanner, config);
    simulator.evaluate_sampled(std::vector<Network>{{{.position = {101, 20, 1}}}}, {.voxels = 50});
    int kept = 0;
    constexpr int kSteps = 4;
    for (int step = 0; step < kSteps; ++step) {
      SCOPED_TRACE(engine.device + ", step " + std::to_string(step));
      SceneChange change;
      for (int m = 0; m < 1 + step; ++m)
        change.move.push_back({"machine-" + std::to_string((2 * step + m) % 6),
                               {.translation = {dice.between(-0.3, 0.3), dice.between(-0.3, 0.3), 0},
                                .rotation = {0, 0, dice.between(-0.0005, 0.0005), 1}}});
      scene = with_changes(scene, change);
      kept += simulator.set_scene(scene);
      Simulator fresh(scene, scanner, config);
      expect_alike(simulator, fresh, 12 + static_cast<std::uint64_t>(step));
      if (testing::Test::HasFatalFailure()) return;
    }
    EXPECT_EQ(kept > 0, engine.engine != Engine::ray_query) << kept << " of " << kSteps << ", " << engine.device;
  }
}

TEST(SetScene, EqualsANewSimulatorWhereWeightsAndDetailsDiffer) {
  Dice dice(9);
  Scene scene = plant(dice, 5);
  SceneChange change;
  change.add = {machine(dice, "heavy")};
  change.add[0].weight = 5, change.add[0].detail_m = 0.1, change.add[0].role = Role::surveyed;
  change.add[0].pose = {.translation = {101, 21, 0}};
  Scanner scanner = coarse_scanner(2);
  scanner.beam_divergence = Angle::radians(0.001);
  SimulatorConfig config{.engine = Engine::embree, .user_size_m = 0.2, .point_spacing_m = 0.05};
  config.spacing_by_detail = true;
  Simulator simulator(scene, scanner, config);
  for (int step = 0; step < 3; ++step) {
    scene = with_changes(scene, change);
    EXPECT_FALSE(simulator.set_scene(scene));
    Simulator fresh(scene, scanner, config);
    expect_alike(simulator, fresh, 3);
    change = {.move = {{"heavy", {.translation = {0.3, -0.2, 0}}}}};
  }
}

TEST(SetScene, KeepsAllOfASceneThatIsTheSame) {
  Dice dice(5);
  const Scene scene = plant(dice, 4);
  Simulator simulator(scene, coarse_scanner(2), {.engine = Engine::embree, .user_size_m = 0.2});
  EXPECT_TRUE(simulator.set_scene(scene));
  Simulator fresh(scene, coarse_scanner(2), {.engine = Engine::embree, .user_size_m = 0.2});
  expect_alike(simulator, fresh, 1);
}

TEST(SetScene, TakesAWhollyDifferentScene) {
  Dice dice(6);
  Simulator simulator(plant(dice, 3), coarse_scanner(2), {.engine = Engine::embree, .user_size_m = 0.2});
  const Scene other = test::wall_and_floor({100, 20, 0}).scene();
  EXPECT_FALSE(simulator.set_scene(other));
  Simulator fresh(other, coarse_scanner(2), {.engine = Engine::embree, .user_size_m = 0.2});
  expect_alike(simulator, fresh, 1);
}

TEST(SetScene, StaysAsItWasAfterAnError) {
  Dice dice(7);
  const Scene scene = plant(dice, 4);
  const SimulatorConfig config{.engine = Engine::embree, .user_size_m = 0.2, .point_spacing_m = 0.15};
  Simulator simulator(scene, coarse_scanner(2), config);
  // One small surveyed mesh alone: its voxels are finer than the spacing of points.
  SceneMesh speck{.name = "speck", .positions = {{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}}, .triangles = {{0, 1, 2}}};
  SceneBuilder builder;
  builder.add(speck);
  EXPECT_THROW(simulator.set_scene(builder.build()), Error);
  Simulator fresh(scene, coarse_scanner(2), config);
  expect_alike(simulator, fresh, 1);
}

TEST(SetScene, IsRefusedForSurroundings) {
  Dice dice(8);
  const Scene scene = plant(dice, 3);
  Simulator around =
      surroundings_of(Simulator(scene, coarse_scanner(2), {.engine = Engine::embree, .user_size_m = 0.2}));
  try {
    around.set_scene(scene);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::invalid_argument);
    EXPECT_NE(std::string(error.what()).find("surroundings"), std::string::npos) << error.what();
  }
}

TEST(SetScanners, EqualsANewSimulatorOnEveryEngine) {
  Dice dice(10);
  const Scene scene = plant(dice, 4);
  Scanner lossy = coarse_scanner(3);  // with it, all points have limits
  lossy.dropout = 0.2, lossy.detection_range_m = 9, lossy.noise = rtc360_noise();
  const std::vector<std::vector<Scanner>> lists{{coarse_scanner(1.5)}, {coarse_scanner(2), lossy}, {lossy}};
  const SampleOptions sample{.voxels = 200, .registration = RegistrationModel()};
  const Network pair{{.position = {101, 20, 1}}, {.position = {103, 21, 1}}};
  for (const EngineInfo& engine : test::usable_engines()) {
    Simulator simulator(scene, coarse_scanner(2), on(engine));
    for (const std::vector<Scanner>& scanners : lists) {
      SCOPED_TRACE(engine.device + ", " + std::to_string(scanners.size()));
      simulator.evaluate_sampled({&pair, 1}, sample);  // keeps planes
      simulator.set_scanners(scanners);
      ASSERT_EQ(simulator.scanners().size(), scanners.size());
      Simulator fresh(scene, scanners, on(engine));
      expect_alike(simulator, fresh, 2);
      const NetworkCounts counts = simulator.evaluate_sampled({&pair, 1}, sample).front(),
                          expected = fresh.evaluate_sampled({&pair, 1}, sample).front();
      EXPECT_EQ(counts.registration.pairs, expected.registration.pairs);
      EXPECT_EQ(counts.registration.surface, expected.registration.surface);
    }
  }
}

TEST(SetScanners, StaysAsItWasAfterAnError) {
  Dice dice(11);
  const Scene scene = plant(dice, 3);
  const SimulatorConfig config{.engine = Engine::embree, .user_size_m = 0.2, .point_spacing_m = 0.05};
  Simulator simulator(scene, coarse_scanner(2), config);
  Scanner wrong = coarse_scanner(2);
  wrong.height_m = -1;
  EXPECT_THROW(simulator.set_scanners({}), Error);
  EXPECT_THROW(simulator.set_scanners({&wrong, 1}), Error);
  Simulator around = surroundings_of(simulator);
  EXPECT_THROW(around.set_scanners(simulator.scanners()), Error);
  Simulator fresh(scene, coarse_scanner(2), config);
  expect_alike(simulator, fresh, 1);
}

// Voxels of a changed grid are those of a new one, brick by brick.
TEST(SetScene, ChangesTheGridToThatOfANewOne) {
  int kept = 0;
  for (std::uint64_t seed = 11; seed <= 20; ++seed) {
    Dice dice(seed);
    const Scene before = plant(dice, 8), after = changed(dice, before, 0);
    const auto differs = difference(before.data(), after.data());
    ASSERT_TRUE(differs);
    for (const double size : {0.4, 0.1, 0.03}) {
      const auto got = VoxelGrid::build(before.data(), size).changed(before.data(), after.data(), *differs, size);
      if (!got) continue;
      ++kept;
      const VoxelGrid expected = VoxelGrid::build(after.data(), size);
      EXPECT_EQ(got->min(), expected.min());
      ASSERT_EQ(got->size(), expected.size());
      ASSERT_EQ(got->bricks().size(), expected.bricks().size());
      for (std::size_t b = 0; b < expected.bricks().size(); ++b) {
        const VoxelBrick &one = got->bricks()[b], &other = expected.bricks()[b];
        ASSERT_TRUE(one.x == other.x && one.y == other.y && one.z == other.z && one.first == other.first);
        ASSERT_TRUE(std::ranges::equal(one.mask, other.mask));
      }
      for (std::uint64_t v = 0; v < expected.size(); v += 7) ASSERT_EQ(got->find(expected.key(v)), v);
    }
  }
  EXPECT_GE(kept, 15) << "of 30";
}

}  // namespace
}  // namespace vantage
