// SPDX-License-Identifier: Apache-2.0
#include "vantage/candidates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stop_token>

#include "candidates/candidate_table.hpp"
#include "candidates/spread_positions.hpp"
#include "support/quad_scene.hpp"
#include "support/site_of.hpp"
#include "vantage/error.hpp"
#include "vantage/planner.hpp"

namespace vantage {
namespace {

using test::coarse_scanner;
using test::QuadScene;
using test::wall_and_floor;
using test::walls_of_two_details;

SimulatorConfig config() {
  SimulatorConfig c;
  c.engine = Engine::embree;
  c.user_size_m = 0.5;
  c.point_spacing_m = 0.2;
  return c;
}

// A rectangle of ground as two triangles; (u, v) is where it is told to be.
void add_ground(SearchMesh& mesh, const Vec3& corner, double x, double y, const Uv& low, const Uv& high) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const auto& [a, b] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
    mesh.positions.push_back(corner + Vec3{a * x, b * y, 0});
    mesh.uvs.push_back({a ? high.u : low.u, b ? high.v : low.v});
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

SearchArea ground(const Vec3& corner, double x, double y) {
  SearchMesh mesh;
  add_ground(mesh, corner, x, y, {0, 0}, {1, 1});
  return SearchArea::from_mesh(mesh);
}

PlacedStation at(const Vec3& head) {
  PlacedStation station;
  station.position = head;
  return station;
}

TEST(SampledCoverage, AreTheVoxelFieldsOfSingleStations) {
  Scanner scanner = coarse_scanner();
  scanner.noise = rtc360_noise();
  Simulator simulator(wall_and_floor().scene(), scanner, config());
  std::vector<PlacedStation> stations{at({0, 0, 0}), at({3, 2, 0}), at({0, 0, 0}), at({9, 0, 0})};
  stations[2].status = StationStatus::clash;
  const SampledCoverage sampled = sample_coverage(simulator, stations, simulator.voxel_count());
  ASSERT_EQ(sampled.size(), 4u);
  EXPECT_EQ(sampled.matrix().column(2).size(), 0u);
  EXPECT_EQ(sampled.voxels().size(), simulator.voxel_count());
  for (const std::size_t k : {0u, 1u, 3u}) {
    VoxelField field;
    simulator.evaluate({{stations[k].position}}, {.overlap = false, .field = &field});
    std::vector<std::uint32_t> dense(field.count.size());
    for (const CoverageMatrix::Entry& one : sampled.matrix().column(k)) dense[one.element] = one.amount;
    const auto goal = static_cast<std::uint32_t>(std::ceil(simulator.goal_density()));
    for (std::uint32_t& count : field.count) count = std::min(count, goal);
    EXPECT_EQ(dense, field.count) << k << ", up to the goal";
    EXPECT_GT(sampled.matrix().column(k).size(), 0u);
  }
}

TEST(SampledCoverage, SumToNetworks) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(4), config());
  const std::vector<PlacedStation> stations{at({0, 0, 0}), at({3, 2, 0}), at({2, -2, 0.5})};
  constexpr std::uint64_t sample = 90;
  const SampledCoverage sampled = sample_coverage(simulator, stations, sample);
  EXPECT_EQ(sampled.voxels(), simulator.sampled_voxels(sample));
  const std::vector<Network> networks{to_network(stations)};
  const NetworkCounts counts = simulator.evaluate_sampled(networks, {.voxels = sample}).front();
  const Estimate expected = coverage_estimate(counts, simulator.goal_density(), simulator.voxel_count());
  const std::vector<std::size_t> all{0, 1, 2};
  EXPECT_DOUBLE_EQ(sampled.coverage(all).value, expected.value);
  EXPECT_DOUBLE_EQ(sampled.coverage(all).standard_error, expected.standard_error);
  EXPECT_EQ(sampled.coverage().value, sampled.coverage(all).value);
  EXPECT_GT(expected.standard_error, 0);
}

TEST(SampledCoverage, GoByTheGoalOfEachVoxel) {
  Scanner scanner = coarse_scanner(2);
  scanner.beam_divergence = Angle::radians(1e-4), scanner.exit_diameter_m = 0.005;
  SimulatorConfig by_detail = config();
  by_detail.spacing_by_detail = true;
  Simulator simulator(walls_of_two_details().scene(), scanner, by_detail);
  const std::vector<PlacedStation> stations{at({0, 0, 0}), at({3, 2, 0}), at({-3, -2, 0.5})};
  const SampledCoverage sampled = sample_coverage(simulator, stations, simulator.voxel_count());
  const double covered = coverage(simulator.evaluate(to_network(stations)), simulator.goal_density());
  const std::vector<std::size_t> all{0, 1, 2};
  EXPECT_NEAR(sampled.coverage(all).value, covered, 1e-12);
  EXPECT_GT(covered, 0.3);
  EXPECT_LT(covered, 0.9);
  SampledCoverage first(simulator, simulator.voxel_count());
  first.append(sampled, 2);
  EXPECT_EQ(first.size(), 2u);
  EXPECT_EQ(first.coverage().value, sampled.coverage(std::vector<std::size_t>{0, 1}).value);
}

TEST(SampledCoverage, StopWhereTold) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(), config());
  const std::vector<PlacedStation> stations(200, at({0, 0, 0}));
  std::stop_source stop;
  const SampledCoverage sampled = sample_coverage(simulator, stations, 50,
                                                  {.report =
                                                       [&](double done) {
                                                         if (done > 0.5) stop.request_stop();
                                                       },
                                                   .stop = stop.get_token()});
  EXPECT_TRUE(sampled.cancelled());
  EXPECT_GT(sampled.size(), 0u);
  EXPECT_LT(sampled.size(), stations.size());
}

TEST(SampledCoverage, JoinsOnlyWithinOneSample) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(3), config());
  const std::vector<PlacedStation> stations{at({0, 0, 0}), at({3, 2, 0})};
  SampledCoverage some = sample_coverage(simulator, stations, 60);
  some.append(sample_coverage(simulator, stations, 60));
  EXPECT_EQ(some.size(), 4u);
  EXPECT_THROW(some.append(sample_coverage(simulator, stations, 50)), Error);
}

TEST(OverlapGraph, HasTheScanOverlapOfEachPair) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(3), config());
  Simulator surroundings = surroundings_of(simulator);
  std::vector<PlacedStation> stations{at({0, 0, 0}), at({3, 2, 0}), at({-6, -6, 0})};
  const StationGraph graph = overlap_graph(surroundings, stations, surroundings.voxel_count());
  const ScanOverlapMatrix expected = scan_overlap_matrix(surroundings.evaluate(to_network(stations)));
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_FLOAT_EQ(graph.overlap(i, j), static_cast<float>(expected(i, j))) << i << " and " << j;
  std::stop_source stopped;
  stopped.request_stop();
  EXPECT_EQ(overlap_graph(surroundings, stations, 100, {.stop = stopped.get_token()}).size(), 3u)
      << "a stopped call knows no overlap, but all stations";
}

TEST(SpreadPositions, ThatSeeNoCandidateNearThemAreFound) {
  PlacementOracle oracle;
  // A closet behind x = 10, and another one behind x = 20 without a candidate.
  oracle.sees = [](const Vec3& a, const Vec3& b) { return (a.x < 10) == (b.x < 10) && (a.x < 20) == (b.x < 20); };
  const std::vector<PlacedStation> stations{at({1, 0, 0}), at({9, 0, 0}), at({14, 0, 0})};
  const std::vector<PlacedStation> others{at({8, 0, 0}),  at({9, 2, 0}),  at({11, 0, 0}), at({10.5, 0.5, 0}),
                                          at({14, 1, 0}), at({21, 0, 0}), at({9, -40, 0})};
  const std::vector<PlacedStation> unseen = unseen_positions(oracle, stations, others, 3);
  ASSERT_EQ(unseen.size(), 3u);
  EXPECT_EQ(unseen[0].position.x, 10.5) << "the only candidate in its closet is 3.5 m away";
  EXPECT_EQ(unseen[1].position.x, 21);
  EXPECT_EQ(unseen[2].position.y, -40);
  const std::vector<PlacedStation> nearer = unseen_positions(oracle, stations, others, 2.5);
  ASSERT_EQ(nearer.size(), 3u);
  EXPECT_EQ(nearer[0].position.x, 11) << "it is enough for its neighbour";
}

// Square metres decide, not (u, v): the small field has most of the chart.
TEST(SpreadPositions, FollowTheGroundInSquareMetres) {
  SearchMesh mesh;
  add_ground(mesh, {0, 0, 0}, 30, 20, {0, 0}, {0.2, 1});
  add_ground(mesh, {40, 0, 5}, 10, 20, {0.3, 0}, {1, 1});
  const Scene scene = QuadScene().quad({0, 0, -50}, {1, 0, 0}, {0, 1, 0}).scene();
  Site site = test::site_of(Simulator(scene, coarse_scanner(), config()), SearchArea::from_mesh(mesh));
  const SpreadPositions spread = spread_positions(make_placement_oracle(site), site.area().mesh(), 1.5, 512);
  ASSERT_EQ(spread.stations.size(), 512u);
  for (const std::size_t n : {64u, 128u, 512u}) {
    const auto in_large = std::count_if(spread.stations.begin(), spread.stations.begin() + static_cast<int>(n),
                                        [](const PlacedStation& s) { return s.position.x <= 30; });
    // 600 of 800 m²; borders of the fields draw a little more than the middle
    EXPECT_NEAR(static_cast<double>(in_large) / static_cast<double>(n), 0.75, 0.06) << n;
    double nearest = 1e300;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Vec3 apart = spread.stations[i].position - spread.stations[j].position;
        nearest = std::min(nearest, std::sqrt(dot(apart, apart)));
      }
    // Farthest point first: what is taken is no nearer to the rest than what is left over.
    EXPECT_GE(nearest, spread.spacing_m[n - 1] - 1e-12) << n;
    // And covers: no disc of that radius around n points is smaller than their share of the ground.
    EXPECT_LT(spread.spacing_m[n - 1], 1.6 * std::sqrt(800.0 / static_cast<double>(n))) << n;
  }
  EXPECT_NEAR(spread.stations.front().position.z, spread.stations.front().position.x <= 30 ? 1.5 : 6.5, 1e-9);
}

// A loft over a floor, 4 m by 6 m, whose edge at x = 0 falls by 3 m; and a walkway of 0.6 m that goes on from it.
TEST(SpreadPositions, KeepFromADropUnlessTheGroundIsNarrow) {
  SearchMesh mesh;
  add_ground(mesh, {-4, 0, 3}, 4, 6, {0, 0}, {0.5, 1});
  add_ground(mesh, {0, 2.7, 3}, 5, 0.6, {0.6, 0}, {1, 0.2});
  const Scene scene = QuadScene()
                          .quad({-10, -10, 0}, {20, 0, 0}, {0, 20, 0})
                          .quad({-4, 0, 3}, {4, 0, 0}, {0, 6, 0})
                          .quad({0, 2.7, 3}, {5, 0, 0}, {0, 0.6, 0})
                          .scene();
  Site site = test::site_of(Simulator(scene, coarse_scanner(), config()), SearchArea::from_mesh(mesh));
  const PlacementOracle oracle = make_placement_oracle(site);
  const SpreadPositions spread = spread_positions(oracle, site.area().mesh(), 1.5, 128);
  std::size_t on_loft = 0, on_walkway = 0;
  for (const PlacedStation& station : spread.stations) {
    const bool loft = station.ground.x < -0.6;
    (loft ? on_loft : on_walkway) += 1;
    EXPECT_FALSE(loft && oracle.at_brink(station.ground)) << station.ground.x << " " << station.ground.y;
  }
  EXPECT_GT(on_loft, 60u);
  EXPECT_GT(on_walkway, 5u);
  EXPECT_EQ(spread.spacing_m.size(), spread.stations.size());
  const PlacedStation by_edge{.ground = {-1, 4.5, 3}};
  for (const PlacedStation& station : positions_around(oracle, std::span(&by_edge, 1), 32, 2))
    EXPECT_FALSE(oracle.at_brink(station.ground)) << station.ground.x << " " << station.ground.y;
}

// Two equal walls, one behind the other and out of sight from all of the ground.
TEST(Candidates, TellWhatIsAttainable) {
  QuadScene walls;
  walls.quad({5, -3, -1.5f}, {0, 6, 0}, {0, 0, 4});
  walls.quad({6, -2, -1.4f}, {0, 4, 0}, {0, 0, 3.4f});
  Site site = test::site_of(Simulator(walls.scene(), coarse_scanner(0.5), config()), ground({0, -1, -1.5}, 2, 2));
  const Simulator& simulator = site.simulator();
  const Candidates found = find_candidates(site, {.first = 8, .most = 64, .sample_voxels = every_voxel});
  double front = 0;
  for (std::uint64_t voxel = 0; voxel < simulator.voxel_count(); ++voxel)
    front += simulator.voxel_centre(voxel).x < 5.5;
  const double share = front / static_cast<double>(simulator.voxel_count());
  EXPECT_GT(share, 0.5);
  EXPECT_LT(share, 0.8);
  // Voxels at the wall's rim hold less of it than the goal asks of a whole one, but many scans fill them too.
  EXPECT_NEAR(found.attainable().value, share, 0.01);
  EXPECT_EQ(found.attainable().standard_error, 0);
  EXPECT_EQ(found.ended(), "enough");
  EXPECT_LT(found.change(), 0.01);
  EXPECT_EQ(found.coverage().size(), found.stations().size());
  EXPECT_GE(found.coverage().coverage().value, found.attainable().value) << "points of several stations add up";
  std::vector<std::size_t> all(found.stations().size());
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = k;
  EXPECT_NEAR(found.captured_matrix().coverage(all), 1, 1e-12);
  for (const PlacedStation& station : found.stations()) {
    EXPECT_EQ(station.status, StationStatus::ok);
    EXPECT_NEAR(station.position.z, -1.5 + simulator.scanner().height_m, 1e-9);
  }
}

TEST(Candidates, GrowAsFarAsTheyMay) {
  Site site =
      test::site_of(Simulator(wall_and_floor().scene(), coarse_scanner(3), config()), ground({-8, -8, -1.5}, 12, 16));
  const Candidates few = find_candidates(site, {.first = 4, .most = 12, .change = 0});
  EXPECT_EQ(few.ended(), "most");
  EXPECT_EQ(few.stations().size(), 12u);
  const Candidates more = find_candidates(site, {.first = 4, .most = 48, .change = 0});
  EXPECT_LE(few.attainable().value, more.attainable().value);
  EXPECT_GT(few.spacing_m(), more.spacing_m());
  const Candidates again = find_candidates(site, {.first = 4, .most = 48, .change = 0});
  EXPECT_EQ(again.attainable().value, more.attainable().value);
  const Candidates timed = find_candidates(site, {.first = 100, .most = 1000, .change = 0, .max_seconds = 1e-6});
  EXPECT_EQ(timed.ended(), "time");
  EXPECT_GT(timed.stations().size(), 0u);
  EXPECT_LT(timed.stations().size(), 1000u);
}

TEST(Candidates, RefuseGroundWithoutAPlaceToStandAndSamplesOfNothing) {
  const auto site_on = [](const SearchArea& area) {
    return test::site_of(Simulator(wall_and_floor().scene(), coarse_scanner(3), config()), area);
  };
  Site in_the_wall = site_on(ground({4.9, -1, -1.5}, 0.2, 2)), site = site_on(ground({-8, -8, -1.5}, 12, 16));
  EXPECT_THROW(find_candidates(in_the_wall), Error);
  EXPECT_THROW(find_candidates(site, {.sample_voxels = 0}), Error);
}

}  // namespace
}  // namespace vantage
