// SPDX-License-Identifier: Apache-2.0
#include "vantage/attainable.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stop_token>
#include <utility>

#include "support/quad_scene.hpp"
#include "vantage/candidates.hpp"
#include "vantage/error.hpp"
#include "vantage/evaluate.hpp"
#include "vantage/evaluation.hpp"

namespace vantage {
namespace {

using test::coarse_scanner;
using test::wall_and_floor;
using test::walls_of_two_details;

SimulatorConfig config() {
  SimulatorConfig c;
  c.engine = Engine::embree;
  c.user_size_m = 0.5;
  c.point_spacing_m = 0.05;  // more points than one of these scans has in most voxels
  return c;
}

// Heads before the wall and above the floor, none of which sees all of them well.
Network heads() {
  Network all;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) all.push_back({.position = {-6 + 2.0 * i, -4 + 2.0 * j, 0.3 * j}});
  return all;
}

// Points of each station alone, by every ray, in all voxels.
std::vector<std::vector<std::uint32_t>> counts_of(Simulator& simulator, const Network& stations) {
  std::vector<std::vector<std::uint32_t>> counts;
  for (const Station& station : stations) {
    VoxelField field;
    simulator.evaluate({station}, {.overlap = false, .field = &field});
    counts.push_back(field.count);
  }
  return counts;
}

struct Expected {
  double attainable = 0, captured = 0;
};

// Computes the shares by their definition, from counts of every candidate, over some voxels.
Expected by_definition(const Simulator& simulator, const std::vector<std::vector<std::uint32_t>>& candidates,
                       const std::vector<std::uint32_t>& network, std::span<const std::uint32_t> voxels) {
  double wanted = 0, attainable = 0, captured = 0;
  for (const std::uint32_t v : voxels) {
    const double goal = simulator.goal_density(v), weight = simulator.voxel_weight(v);
    double best = 0;
    for (const auto& counts : candidates) best = std::max(best, std::min(static_cast<double>(counts[v]), goal));
    wanted += weight;
    attainable += weight * (best / goal);
    captured += weight * (std::min(best, static_cast<double>(network[v])) / goal);
  }
  return {attainable / wanted, captured / attainable};
}

std::vector<std::uint32_t> sum_of(const std::vector<std::vector<std::uint32_t>>& counts,
                                  std::span<const std::size_t> chosen) {
  std::vector<std::uint32_t> sum(counts.front().size());
  for (const std::size_t k : chosen)
    for (std::size_t v = 0; v < sum.size(); ++v) sum[v] += counts[k][v];
  return sum;
}

TEST(Attainable, IsTheBestSingleStationOfEachVoxel) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(), config());
  const Network stations = heads();
  const auto counts = counts_of(simulator, stations);
  const std::vector<std::size_t> chosen{3, 12, 21};
  Network network;
  for (const std::size_t k : chosen) network.push_back(stations[k]);
  for (const std::uint64_t sample : {simulator.voxel_count(), simulator.voxel_count() / 3}) {
    AttainableCounts attainable(simulator, sample);
    ASSERT_TRUE(raise_attainable(attainable, simulator, stations));
    const Expected expected = by_definition(simulator, counts, sum_of(counts, chosen), attainable.voxels());
    EXPECT_DOUBLE_EQ(attainable.coverage().value, expected.attainable) << sample;
    const auto shares = captured_shares(simulator, attainable, {&network, 1});
    ASSERT_EQ(shares.size(), 1u);
    EXPECT_DOUBLE_EQ(shares[0].all.value, expected.captured) << sample;
    EXPECT_GT(expected.captured, 0.2);
    EXPECT_LT(expected.captured, 0.95);
    const bool all = sample == simulator.voxel_count();
    EXPECT_EQ(attainable.coverage().standard_error == 0, all);
    EXPECT_EQ(shares[0].all.standard_error == 0, all);
  }
}

TEST(Attainable, IsNoMoreThanTheirCoverageAndEachOfThemCapturesAllOfItsOwn) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(), config());
  const Network stations = heads();
  AttainableCounts attainable(simulator, simulator.voxel_count());
  raise_attainable(attainable, simulator, stations);
  const NetworkCounts all = simulator.evaluate(stations);
  EXPECT_LT(attainable.coverage().value, coverage(all, simulator.goal_density())) << "points add up";
  EXPECT_DOUBLE_EQ(captured_shares(simulator, attainable, {&stations, 1})[0].all.value, 1);
  AttainableCounts own(simulator, simulator.voxel_count());
  const Network one{stations[7]};
  raise_attainable(own, simulator, one);
  EXPECT_DOUBLE_EQ(captured_shares(simulator, own, {&one, 1})[0].all.value, 1);
  EXPECT_DOUBLE_EQ(own.coverage().value, coverage(simulator.evaluate(one), simulator.goal_density()))
      << "of one station, its coverage";
}

TEST(Attainable, CountsNoMoreWhereAStationReachedTheGoal) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(0.5), config());
  const Network stations = heads();
  const std::uint64_t sample = simulator.voxel_count() / 2;
  AttainableCounts together(simulator, sample), one_by_one(simulator, sample);
  ASSERT_TRUE(raise_attainable(together, simulator, stations));
  const std::uint64_t alone = simulator.work().sampled_rays;
  for (const Station& station : stations) ASSERT_TRUE(raise_attainable(one_by_one, simulator, {&station, 1}));
  EXPECT_EQ(one_by_one.counts(), together.counts());
  EXPECT_GT(std::ranges::count(together.counts(), together.goal()), 10);
  EXPECT_LT(simulator.work().sampled_rays - alone, 2 * alone / 3);
}

TEST(Attainable, GoesByTheGoalAndWeightOfEachVoxel) {
  Scanner scanner = coarse_scanner(2);
  scanner.beam_divergence = Angle::radians(1e-4), scanner.exit_diameter_m = 0.005;
  SimulatorConfig by_detail = config();
  by_detail.spacing_by_detail = true;
  Simulator simulator(walls_of_two_details().scene(), scanner, by_detail);
  const Network stations{{.position = {0, 0, 0}}, {.position = {3, 2, 0}}, {.position = {-3, -2, 0.5}}};
  const auto counts = counts_of(simulator, stations);
  AttainableCounts attainable(simulator, simulator.voxel_count());
  raise_attainable(attainable, simulator, stations);
  const Network network{stations[0], stations[2]};
  const Expected expected =
      by_definition(simulator, counts, sum_of(counts, std::vector<std::size_t>{0, 2}), attainable.voxels());
  // Point weights are rounded up, by less than 1 in 4096.
  EXPECT_NEAR(attainable.coverage().value, expected.attainable, 1e-3);
  EXPECT_NEAR(captured_shares(simulator, attainable, {&network, 1})[0].all.value, expected.captured, 1e-3);
}

TEST(Attainable, IsWhatTheCoveringProblemGoesBy) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(), config());
  std::vector<PlacedStation> placed;
  for (const Station& station : heads()) placed.emplace_back().position = station.position;
  const SampledCoverage sampled = sample_coverage(simulator, placed, 90);
  AttainableCounts attainable(simulator, 90);
  raise_attainable(attainable, simulator, to_network(placed));
  CoverageMatrix matrix = sampled.matrix();
  matrix.set_goals(attainable.counts());
  for (const std::vector<std::size_t>& chosen : {std::vector<std::size_t>{4}, {4, 20}, {1, 9, 13, 24}}) {
    Network network;
    for (const std::size_t k : chosen) network.push_back(to_network(placed)[k]);
    EXPECT_NEAR(matrix.coverage(chosen), captured_shares(simulator, attainable, {&network, 1})[0].all.value, 1e-12);
  }
}

// Samples of one walk through the voxels: their estimates scatter by about what they say.
TEST(Attainable, StandardErrorsAreThoseOfTheSamples) {
  SimulatorConfig fine = config();
  fine.user_size_m = 0.25, fine.point_spacing_m = 0.04;
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(), fine);
  const Network stations = heads(), network{stations[2], stations[22]};
  const std::uint64_t n = simulator.voxel_count() / 12;
  double sum = 0, squares = 0, variance = 0;
  constexpr int kSamples = 12;
  for (int s = 0; s < kSamples; ++s) {
    AttainableCounts attainable(simulator, n, static_cast<std::uint64_t>(s) * n);
    raise_attainable(attainable, simulator, stations);
    const Estimate share = captured_shares(simulator, attainable, {&network, 1})[0].all;
    sum += share.value, squares += share.value * share.value, variance += share.standard_error * share.standard_error;
  }
  const double mean = sum / kSamples,
               scatter = std::sqrt((squares / kSamples - mean * mean) * kSamples / (kSamples - 1));
  const double told = std::sqrt(variance / kSamples);
  EXPECT_GT(told, 0.4 * scatter);
  EXPECT_LT(told, 3 * scatter);
}

TEST(Attainable, EvaluatedStationsRaiseIt) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(), config());
  const Network stations = heads();
  AttainableCounts few(simulator, simulator.voxel_count());
  raise_attainable(few, simulator, std::span(stations).first(3));
  std::vector<PlacedStation> placed(2);
  placed[0].position = stations[20].position, placed[1].position = stations[8].position;
  const Evaluation found = evaluate_stations({.simulator = simulator}, placed, {.attainable = &few});
  AttainableCounts all = few;
  raise_attainable(all, simulator, to_network(placed));
  EXPECT_GT(all.coverage().value, few.coverage().value);
  ASSERT_TRUE(found.attainable);
  EXPECT_EQ(found.attainable->value, all.coverage().value);
  const Network network = to_network(placed);
  EXPECT_EQ(found.value("capture"), captured_shares(simulator, all, {&network, 1})[0].all.value);
}

TEST(Attainable, TellsOfMeshesByPattern) {
  test::QuadScene quads = wall_and_floor();
  quads.quad({-6, -3, -1.5F}, {0, 6, 0}, {0, 0, 4});
  quads.quad({-4, 5, -1}, {6, 0, 0}, {0, 0, 2});
  const char* names[] = {"IfcWall a", "floor", "IfcWall b", "IfcSlab"};
  for (std::size_t m = 0; m < std::size(names); ++m) quads.data().meshes[m].name = names[m];
  quads.data().meshes[2].weight = 3;
  Simulator simulator(quads.scene(), coarse_scanner(), config());
  const Network stations = heads();
  const auto counts = counts_of(simulator, stations);
  const std::vector<std::size_t> chosen{3, 12, 21};
  Network network;
  for (const std::size_t k : chosen) network.push_back(stations[k]);
  const struct {
    const char* pattern;
    std::vector<std::uint32_t> meshes;
  } all[] = {{"IfcWall*", {0, 2}}, {"!IfcWall*", {3}}, {"*b|IfcSlab", {2, 3}}, {"!*b|IfcSlab", {0}}, {"*", {0, 2, 3}}};
  for (const std::uint64_t sample : {simulator.voxel_count(), simulator.voxel_count() / 3}) {
    AttainableCounts attainable(simulator, sample);
    for (const auto& one : all) attainable.tell_of(simulator, one.pattern);
    ASSERT_TRUE(raise_attainable(attainable, simulator, stations));
    const AttainableCounts part = attainable.part(simulator, sample / 2);
    for (const AttainableCounts* of : {&std::as_const(attainable), &part}) {
      const auto shares = captured_shares(simulator, *of, {&network, 1});
      const std::vector<VoxelPatch> patches = simulator.voxel_patches(of->voxels());
      for (const auto& [pattern, meshes] : all) {
        std::vector<std::uint32_t> voxels;
        for (std::size_t k = 0; k < patches.size(); ++k)
          if (std::ranges::count(meshes, patches[k].mesh) > 0) voxels.push_back(of->voxels()[k]);
        const Expected expected = by_definition(simulator, counts, sum_of(counts, chosen), voxels);
        EXPECT_NEAR(shares[0].meshes.at(pattern).value, expected.captured, 1e-12) << pattern;
        EXPECT_EQ(shares[0].meshes.at(pattern).standard_error == 0, of->voxels().size() == simulator.voxel_count());
      }
      EXPECT_EQ(shares[0].meshes.at("*").value, shares[0].all.value);
      EXPECT_EQ(shares[0].meshes.at("*").standard_error, shares[0].all.standard_error);
    }
  }
  AttainableCounts attainable(simulator, 10);
  for (const char* none : {"floor", "IfcDoor*", "!*"})
    EXPECT_THROW(attainable.tell_of(simulator, none), Error) << "no surveyed mesh: " << none;
}

TEST(Attainable, StopsWhereTold) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(), config());
  std::stop_source stop;
  stop.request_stop();
  AttainableCounts attainable(simulator, 50);
  EXPECT_FALSE(raise_attainable(attainable, simulator, heads(), {.stop = stop.get_token()}));
  const Network network = heads();
  EXPECT_TRUE(captured_shares(simulator, attainable, {&network, 1}, {.stop = stop.get_token()}).empty());
  EXPECT_EQ(attainable.coverage().value, 0);
  EXPECT_EQ(attainable.captured(std::vector<std::uint32_t>(attainable.voxels().size(), 3)).value, 0)
      << "all of nothing";
}

}  // namespace
}  // namespace vantage
