// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/quad_scene.hpp"
#include "support/site_of.hpp"
#include "unit/plan/toy_survey.hpp"
#include "vantage/candidates.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

// A wall and a floor to stand on.
class SeedNetworks : public testing::Test {
 protected:
  static SimulatorConfig config() {
    SimulatorConfig c;
    c.engine = Engine::embree;
    c.user_size_m = 0.5;
    c.point_spacing_m = 0.2;
    return c;
  }
  static SearchArea ground() {
    SearchMesh mesh;
    mesh.positions = {{-8, -8, -1.5}, {4, -8, -1.5}, {4, 8, -1.5}, {-8, 8, -1.5}};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return SearchArea::from_mesh(mesh);
  }

  Site site = test::site_of(Simulator(test::wall_and_floor().scene(), test::coarse_scanner(3), config()), ground());
  Simulator& simulator = site.simulator();
};

TEST_F(SeedNetworks, GreedyTakesWhatAddsMost) {
  const GreedyConfig config{.stations = 4, .candidates = 40, .sample_voxels = every_voxel};
  const GreedyResult result = greedy_network(site, config);
  ASSERT_EQ(result.stations.size(), 4u);
  ASSERT_EQ(result.coverage.size(), 4u);
  EXPECT_FALSE(result.cancelled);
  // Reference: every candidate is tried again at every step, by every ray.
  const auto candidates = candidate_positions(site, 40);
  const auto coverage_of = [&](const std::vector<PlacedStation>& network) {
    return coverage(simulator.evaluate(to_network(network)), simulator.goal_density());
  };
  std::vector<PlacedStation> network;
  for (std::size_t step = 0; step < 4; ++step) {
    double best = 0;
    for (const PlacedStation& candidate : candidates) {
      const auto same = [&](const PlacedStation& one) {
        return one.uv.u == candidate.uv.u && one.uv.v == candidate.uv.v;
      };
      if (std::ranges::any_of(network, same)) continue;  // a candidate is chosen once
      std::vector<PlacedStation> with = network;
      with.push_back(candidate);
      best = std::max(best, coverage_of(with));
    }
    network.push_back(result.stations[step]);
    EXPECT_NEAR(coverage_of(network), best, 1e-12) << step;
    EXPECT_NEAR(result.coverage[step], best, 1e-12) << step;
  }
}

TEST_F(SeedNetworks, GreedyAddsToWhatIsThere) {
  const GreedyResult alone = greedy_network(site, {.stations = 3, .candidates = 40});
  GreedyConfig config{.stations = 2, .candidates = 40};
  config.existing = {alone.stations[0].position};
  const GreedyResult rest = greedy_network(site, config);
  ASSERT_EQ(rest.stations.size(), 2u);
  EXPECT_EQ(rest.stations[0].position, alone.stations[1].position);
  EXPECT_EQ(rest.stations[1].position, alone.stations[2].position);
  EXPECT_NEAR(rest.coverage[1], alone.coverage[2], 1e-12);
}

TEST_F(SeedNetworks, ExistingStationsAreTracedAsTheyAreSetUp) {
  const PlacedStation lying{.position = {-2, 0, 0}, .existing = true, .setup = {.tilt = Angle::degrees(90)}};
  const auto coverage_with = [&](std::span<const PlacedStation> chosen) {
    std::vector<PlacedStation> all{lying};
    all.insert(all.end(), chosen.begin(), chosen.end());
    return coverage(simulator.evaluate(to_network(all)), simulator.goal_density());
  };
  const GreedyResult greedy = greedy_network(site, {.stations = 1,
                                                    .candidates = 12,
                                                    .sample_voxels = every_voxel,
                                                    .existing = {lying.position},
                                                    .existing_setups = {lying.setup}});
  EXPECT_NEAR(greedy.coverage[0], coverage_with(greedy.stations), 1e-12);
  const ExactResult exact = exact_network(site, {.stations = 1,
                                                 .candidates = 12,
                                                 .sample_voxels = every_voxel,
                                                 .existing = {lying.position},
                                                 .existing_setups = {lying.setup}});
  EXPECT_NEAR(exact.choice.coverage, coverage_with(exact.stations), 1e-12);
}

TEST_F(SeedNetworks, GreedyKeepsTheNumberAskedThoughNothingIsAdded) {
  const GreedyResult all = greedy_network(site, {.stations = 40, .candidates = 40});
  ASSERT_EQ(all.stations.size(), 40u);
  EXPECT_TRUE(std::ranges::is_sorted(all.coverage));
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(all.stations[i].status, StationStatus::ok);
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(all.stations[i].position == all.stations[j].position);
  }
}

TEST_F(SeedNetworks, GreedyRefusesWhatMakesNoSense) {
  EXPECT_THROW(greedy_network(site, {.stations = 8, .candidates = 5}), Error);
  EXPECT_THROW(greedy_network(site, {.stations = 0}), Error);
  EXPECT_THROW(greedy_network(site, {.stations = max_stations + 1, .candidates = 2000}), Error);
}

TEST_F(SeedNetworks, GreedyStopsWhenTold) {
  std::stop_source stop;
  const auto report = [&](double done) {
    if (done > 0.3) stop.request_stop();
  };
  const GreedyResult result =
      greedy_network(site, {.stations = 6, .candidates = 200}, {.report = report, .stop = stop.get_token()});
  EXPECT_TRUE(result.cancelled);
  EXPECT_TRUE(result.stations.empty());
}

// A greedy choice on the toy survey, each candidate tried again at every step.
std::vector<Vec3> toy_seed(std::size_t stations) {
  const PlacementOracle site = test::toy_site();
  std::vector<PlacedStation> candidates;
  for (int i = 0; i < 16; ++i)
    for (int j = 0; j < 16; ++j) {
      const PlacedStation one = place_station(site, {(i + 0.5) / 16, (j + 0.5) / 16}, site.height_m);
      if (one.status == StationStatus::ok) candidates.push_back(one);
    }
  PlacedNetwork network;
  std::vector<Vec3> heads;
  while (heads.size() < stations) {
    const auto with = [&](const PlacedStation& candidate) {
      PlacedNetwork all = network;
      all.push_back(candidate);
      return test::ToyEvaluator::coverage_of(all);
    };
    network.push_back(*std::ranges::max_element(candidates, {}, with));
    heads.push_back(network.back().position);
  }
  return heads;
}

TEST(Seed, HelpsTheSearch) {
  test::ToyEvaluator evaluator;
  const SurveyProblem problem = test::toy_problem("coverage-min");
  PlanConfig config = test::toy_config();
  config.iterations = 1;
  config.start = toy_seed(8);
  const SearchOutcome seeded = test::toy_search(problem, config, evaluator);
  config.start.clear();
  const SearchOutcome random = test::toy_search(problem, config, evaluator);
  EXPECT_GT(seeded.hypervolume, random.hypervolume);
}

TEST(Seed, IsNoBetterThanTheSearchFromIt) {
  test::ToyEvaluator evaluator;
  PlanConfig config = test::toy_config();
  config.iterations = 1;
  config.sigma0 = 1;  // far from the seed
  config.start = toy_seed(4);
  PlacedNetwork seed;
  for (const Vec3& head : config.start) seed.push_back(test::toy_site().check_head(head));
  const double covered = test::ToyEvaluator::coverage_of(seed);
  const SearchOutcome seeded = test::toy_search(test::toy_problem("coverage-fix"), config, evaluator);
  EXPECT_GE(seeded.hypervolume, covered - 1e-9);
  config.start.clear();
  const SearchOutcome random = test::toy_search(test::toy_problem("coverage-fix"), config, evaluator);
  EXPECT_LT(random.hypervolume, covered - 1e-3) << "or the seed would not tell";
}

}  // namespace
}  // namespace vantage
