// SPDX-License-Identifier: Apache-2.0
// A surface seen from behind is not the same surface.
#include "trace/one_sided.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/philox.hpp"
#include "scan/sides_of.hpp"
#include "support/engines.hpp"
#include "support/quad_scene.hpp"
#include "vantage/candidates.hpp"
#include "vantage/measure.hpp"
#include "voxel/voxel_planes.hpp"

namespace vantage {
namespace {

using test::coarse_scanner;
using test::QuadScene;

// A closed room between two corners.
void add_room(QuadScene& scene, const Float3& low, const Float3& high) {
  const Float3 x{high.x - low.x, 0, 0}, y{0, high.y - low.y, 0}, z{0, 0, high.z - low.z};
  scene.quad(low, x, y).quad({low.x, low.y, high.z}, x, y);
  scene.quad(low, x, z).quad({low.x, high.y, low.z}, x, z);
  scene.quad(low, y, z).quad({high.x, low.y, low.z}, y, z);
}

// Two closed rooms of 4 × 5 × 2.5 m with a wall between them; of one sheet if it is 0 thick.
QuadScene two_rooms(float wall_m) {
  QuadScene scene;
  if (wall_m == 0) {
    add_room(scene, {-4, 0, 0}, {4, 5, 2.5f});
    scene.quad({0, 0, 0}, {0, 5, 0}, {0, 0, 2.5f});
  } else {
    add_room(scene, {-4, 0, 0}, {0, 5, 2.5f});
    add_room(scene, {wall_m, 0, 0}, {4 + wall_m, 5, 2.5f});
  }
  return scene;
}

Simulator surroundings(const Scene& scene, const EngineInfo& engine) {
  SimulatorConfig config;
  config.engine = engine.engine;
  config.device_index = engine.device_index;
  config.user_size_m = 0.3;
  config.point_spacing_m = 0.1;
  return surroundings_of(Simulator(scene, coarse_scanner(1), config));
}

EngineInfo on_embree() {
  EngineInfo info;
  info.engine = Engine::embree;
  return info;
}

PlacedStation at(const Vec3& position) {
  PlacedStation station;
  station.position = position;
  return station;
}

// The share of the smaller scan, by every ray, by all sampled voxels, and by columns of candidates.
std::vector<double> shares(Simulator& around, const Vec3& a, const Vec3& b) {
  const Network network{{a}, {b}};
  const std::vector<PlacedStation> placed{at(a), at(b)};
  const NetworkCounts sampled = around.evaluate_sampled({&network, 1}, {.voxels = every_voxel})[0];
  std::uint64_t shared = 0;
  for (const NetworkCounts& group : sampled.groups) shared += group.shared_by(0, 1);
  EXPECT_EQ(shared, sampled.shared_by(0, 1));
  return {scan_overlap_matrix(around.evaluate(network))(0, 1), scan_overlap_matrix(sampled)(0, 1),
          static_cast<double>(overlap_graph(around, placed, every_voxel).overlap(0, 1))};
}

TEST(OneSided, ClosedRoomsShareNothing) {
  for (const EngineInfo& engine : test::usable_engines())
    for (const float wall_m : {0.0f, 0.012f, 0.1f, 0.24f}) {
      SCOPED_TRACE(test::name_of(engine) + ", a wall of " + std::to_string(wall_m) + " m");
      Simulator around = surroundings(two_rooms(wall_m).scene(), engine);
      for (const double share : shares(around, {-1.3, 2.2, 1.7}, {1.9, 3.1, 1.5})) EXPECT_EQ(share, 0);
      const auto within = shares(around, {-1.3, 2.2, 1.7}, {-2.4, 1.1, 1.5});
      for (const double share : within) EXPECT_GT(share, 0.9);
      EXPECT_DOUBLE_EQ(within[0], within[1]);
      EXPECT_FLOAT_EQ(static_cast<float>(within[0]), static_cast<float>(within[2]));
    }
}

// Each captures the other's room through the pane, and is not linked with it. The pane is no surface of its own.
TEST(OneSided, WhatIsSeenThroughGlassIsToldAndNotShared) {
  QuadScene scene;
  add_room(scene, {-4, 0, 0}, {4, 5, 2.5f});
  scene.quad({0, 0, 0}, {0, 5, 0}, {0, 0, 2.5f}, Role::blocking);
  QuadScene without = scene;
  scene.data().meshes.back().glass = true;
  without.data().meshes.pop_back(), without.data().ranges.pop_back();
  without.data().triangles.resize(without.data().triangles.size() - 2);
  for (const EngineInfo& engine : test::usable_engines()) {
    SCOPED_TRACE(test::name_of(engine));
    SimulatorConfig config;
    config.engine = engine.engine, config.device_index = engine.device_index;
    config.user_size_m = 0.3;
    config.point_spacing_m = 0.1;
    Simulator simulator(scene.scene(), coarse_scanner(1), config);
    const Network network{{{-1.3, 2.2, 1.7}}, {{1.9, 3.1, 1.5}}};
    const NetworkCounts counts = simulator.evaluate(network);
    EXPECT_GT(counts.shared_by(0, 1), counts.voxels / 2);
    Simulator around = surroundings_of(simulator);
    EXPECT_EQ(scan_overlap_matrix(around.evaluate(network))(0, 1), 0);
    Simulator through = surroundings_of(simulator, true);
    EXPECT_EQ(through.voxel_count(), around.voxel_count());
    const double told = scan_overlap_matrix(through.evaluate(network))(0, 1);
    Simulator open = surroundings_of(Simulator(without.scene(), coarse_scanner(1), config));
    EXPECT_EQ(told, scan_overlap_matrix(open.evaluate(network))(0, 1)) << "no echo is too weak for this scanner";
    EXPECT_GT(told, 0.8);
  }
}

// Two stations 8 m apart over a floor. Within 60° of its normal each reaches 2.9 m of it.
TEST(OneSided, ALimitOfIncidenceIsOneOfSurveyedVoxels) {
  QuadScene scene;
  scene.quad({0, 0, 0}, {12, 0, 0}, {0, 4, 0});
  SimulatorConfig config;
  config.engine = Engine::embree;
  config.user_size_m = 0.3;
  config.point_spacing_m = 0.1;
  const Network network{{{2, 2, 1.7}}, {{10, 2, 1.7}}};
  Simulator any(scene.scene(), coarse_scanner(1), config);
  config.max_incidence = Angle::degrees(60);
  Simulator limited(scene.scene(), coarse_scanner(1), config);
  EXPECT_GT(any.evaluate(network).shared_by(0, 1), any.voxel_count() / 3);
  EXPECT_EQ(limited.evaluate(network).shared_by(0, 1), 0u);
  Simulator around = surroundings_of(limited), around_any = surroundings_of(any);
  const double linked = scan_overlap_matrix(around.evaluate(network))(0, 1);
  EXPECT_EQ(linked, scan_overlap_matrix(around_any.evaluate(network))(0, 1));
  EXPECT_GT(linked, 0.2);
}

TEST(OneSided, ASheetHasTwoSurfaces) {
  QuadScene scene;
  scene.quad({0, -3, 0}, {0, 6, 0}, {0, 0, 3});
  Simulator around = surroundings(scene.scene(), on_embree());
  for (const double share : shares(around, {-3, 0.2, 1.5}, {3, 0.1, 1.6})) EXPECT_EQ(share, 0);
  for (const double share : shares(around, {-3, 0.2, 1.5}, {-2, 0.1, 1.6})) EXPECT_EQ(share, 1);
}

// A vault of small triangles over a hall, and the mound upon it: the inside shares nothing with the outside.
TEST(OneSided, ACurvedSheetHasTwoSurfaces) {
  QuadScene scene;
  constexpr int kParts = 24;
  constexpr float kRadius = 4, kLength = 9;
  for (int k = 0; k < kParts; ++k)
    for (int slice = 0; slice < 30; ++slice) {
      const auto at = [&](int part) {
        const float angle = static_cast<float>(part) * 3.14159265f / kParts;
        return Float3{kRadius * std::cos(angle), static_cast<float>(slice) * kLength / 30, kRadius * std::sin(angle)};
      };
      const Float3 a = at(k), b = at(k + 1);
      scene.quad(a, {b.x - a.x, 0, b.z - a.z}, {0, kLength / 30, 0});
    }
  Simulator around = surroundings(scene.scene(), on_embree());
  for (const double share : shares(around, {0.5, 4, 1.7}, {1, 5, 6})) EXPECT_LT(share, 0.02);
  for (const double share : shares(around, {0.5, 4, 1.7}, {-1, 5, 1.5})) EXPECT_GT(share, 0.9);
}

// Both heads see the treads; it does not matter that one is behind the risers.
TEST(OneSided, StationsOnAStairShareItsTreads) {
  QuadScene scene;
  for (int k = 0; k < 9; ++k) {
    const auto step = static_cast<float>(k);
    scene.quad({0.3f * step, 0, 0.17f * step}, {0.3f, 0, 0}, {0, 1.2f, 0});
    scene.quad({0.3f * (step + 1), 0, 0.17f * step}, {0, 1.2f, 0}, {0, 0, 0.17f});
  }
  Simulator around = surroundings(scene.scene(), on_embree());
  for (const double share : shares(around, {-0.5, 0.6, 1.7}, {4, 0.6, 3.2})) EXPECT_GT(share, 0.5);
}

// Against one voxel and one pair after the other, for few and for many stations.
TEST(OneSided, PairsAreThoseOfEachVoxelAlone) {
  QuadScene scene;
  add_room(scene, {-4, -4, 0}, {4, 4, 3});
  for (const float x : {-2.0f, 0.0f, 2.0f}) scene.quad({x, -4, 0}, {0, 8, 0}, {0, 0, 3});
  scene.quad({-4, 0.5f, 0}, {8, 0, 0}, {0, 0, 3});
  const Simulator around = surroundings(scene.scene(), on_embree());
  const VoxelPlanes* const planes = sides_of(around);
  ASSERT_NE(planes, nullptr);
  const std::size_t voxels = around.voxel_count();
  RandomStream random(7);
  for (const std::size_t stations : {std::size_t{9}, std::size_t{150}}) {
    std::vector<TraceStation> heads;
    for (std::uint32_t k = 0; k < stations; ++k)
      heads.push_back(
          {.origin = {static_cast<float>(8 * random.uniform() - 4), static_cast<float>(8 * random.uniform() - 4), 1.7f},
           .place = k});
    std::vector<std::uint64_t> words(voxels * mask_words(stations));
    StationMasks masks(voxels, stations);
    for (std::size_t w = 0; w < mask_words(stations); ++w) {
      const std::size_t here = std::min(stations - w * mask_bits, mask_bits);
      for (std::size_t v = 0; v < voxels; ++v)
        for (std::size_t b = 0; b < here; ++b)
          if (random.uniform() < 0.2) words[w * voxels + v] |= std::uint64_t{1} << b;
      masks.set_words(w, std::span(words).subspan(w * voxels, voxels));
    }
    std::vector<std::uint64_t> expected;
    for (std::size_t i = 0; i < stations; ++i)
      for (std::size_t j = i + 1; j < stations; ++j) {
        std::uint64_t both = 0;
        for (std::size_t v = 0; v < voxels; ++v)
          both += (masks.word(i / mask_bits, v) >> (i % mask_bits) & 1) != 0 &&
                  (masks.word(j / mask_bits, v) >> (j % mask_bits) & 1) != 0 &&
                  planes->side(v, heads[i].origin) == planes->side(v, heads[j].origin);
        expected.push_back(both);
      }
    NetworkCounts counts;
    counts.stations = static_cast<std::uint32_t>(stations);
    share_one_sided(counts, heads, *planes, masks);
    EXPECT_EQ(counts.shared, expected);
    std::vector<std::uint32_t> all(voxels);
    for (std::uint32_t v = 0; v < voxels; ++v) all[v] = v;
    NetworkCounts sampled;
    sampled.stations = counts.stations;
    sampled.groups.resize(20);
    share_one_sided(sampled, heads, *planes, all, words);
    EXPECT_EQ(sampled.shared, expected);
  }
}

}  // namespace
}  // namespace vantage
