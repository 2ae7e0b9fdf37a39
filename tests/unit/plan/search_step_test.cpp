// SPDX-License-Identifier: Apache-2.0
// The step angle as a decision variable: fine steps where surfaces are far, coarse ones where they are near.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "support/site_of.hpp"
#include "vantage/candidates.hpp"
#include "vantage/error.hpp"
#include "vantage/planner.hpp"
#include "vantage/question.hpp"
#include "vantage/scene_builder.hpp"

namespace vantage {
namespace {

constexpr Vec3 closet{0, 0, 0}, hall{100, 0, 0};

// The inside of a box, six walls.
SceneMesh room(const Vec3& middle, const Vec3& half, std::uint32_t weight) {
  std::vector<Vec3> corners;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const auto along = [&](int a, double s) {
        return Vec3{a == 0 ? s * half.x : 0, a == 1 ? s * half.y : 0, a == 2 ? s * half.z : 0};
      };
      const auto first = static_cast<std::uint32_t>(corners.size());
      for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
        corners.push_back(middle + along(axis, side) + along((axis + 1) % 3, a) + along((axis + 2) % 3, b));
      triangles.push_back({first, first + 1, first + 2});
      triangles.push_back({first, first + 2, first + 3});
    }
  }
  return {.positions = corners, .triangles = triangles, .role = Role::surveyed, .weight = weight};
}

// They count about the same.
Scene closet_and_hall() {
  SceneBuilder builder;
  builder.add(room(closet, {1.5, 1.5, 1.5}, 20));
  builder.add(room(hall, {9, 9, 3}, 1));
  return builder.build();
}

// One may stand in the middle of either; u below ½ is in the closet.
SearchArea middles() {
  SearchMesh mesh;
  for (const Vec3& middle : {closet, hall}) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const double u = middle == closet ? 0 : 0.5;
    for (const auto& [a, b] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      mesh.positions.push_back(middle + Vec3{0.4 * (a - 0.5), 0.4 * (b - 0.5), -1});
      mesh.uvs.push_back({u + 0.5 * a, static_cast<double>(b)});
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  return SearchArea::from_mesh(mesh);
}

// Coarse and fine.
std::vector<Scanner> scanners() {
  std::vector<Scanner> both(2);
  for (Scanner& scanner : both) {
    scanner.height_m = 1;
    scanner.points_per_second = 500;
  }
  both[0].azimuth_step = both[0].zenith_step = Angle::degrees(4);
  both[1].azimuth_step = both[1].zenith_step = Angle::degrees(1);
  return both;
}

Site closet_or_hall() {
  return test::site_of(
      Simulator(closet_and_hall(), scanners(), {.engine = Engine::embree, .user_size_m = 0.5, .point_spacing_m = 0.2}),
      middles(), {.radius_m = 0});
}

TEST(SearchStep, IsCoarseWhereSurfacesAreNearAndFineWhereTheyAreFar) {
  Site site = closet_or_hall();
  Simulator& simulator = site.simulator();

  // Coverage of each choice, from the middles.
  const auto captured = [&](std::uint32_t in_closet, std::uint32_t in_hall) {
    const NetworkCounts counts =
        simulator.evaluate({{closet, true, {.scanner = in_closet}}, {hall, true, {.scanner = in_hall}}});
    return coverage(counts, simulator.goal_density());
  };
  const double cheap = captured(0, 0), wise = captured(0, 1), foolish = captured(1, 0), dear = captured(1, 1);
  ASSERT_GT(wise, cheap + 0.2);
  ASSERT_GT(wise, foolish + 0.2) << "for the same time";
  ASSERT_LT(dear, wise + 0.05) << "and for more time next to nothing";

  const std::vector<std::string> objectives{"time", "coverage"};
  SurveyProblem problem = survey_problem(objectives, 2, 2);
  problem.scanners = {simulator.scanners()[0], simulator.scanners()[1]};
  problem.on_site.set_up_min = 0;
  const PlanResult result = plan(site, problem, {.population = 16, .iterations = 30, .sample_voxels = 500, .seed = 4});
  bool found = false;
  for (const PlanEntry& entry : result.front) {
    ASSERT_TRUE(entry.exact);
    ASSERT_EQ(entry.x.size(), 6u);
    std::array<int, 2> many{};   // stations in closet and hall
    std::array<bool, 2> fine{};  // any of them
    for (const PlacedStation& station : entry.stations) {
      const std::size_t room = station.position.x < 50 ? 0 : 1;
      ++many[room];
      fine[room] |= station.setup.scanner == 1;
    }
    if (many != std::array<int, 2>{1, 1}) continue;
    EXPECT_FALSE(fine[0] && !fine[1]) << "a fine step is wasted on the closet";
    found |= !fine[0] && fine[1];
    ASSERT_TRUE(entry.visit);
    const double rays = (fine[0] ? 360 * 150 : 90 * 37) + (fine[1] ? 360 * 150 : 90 * 37);
    EXPECT_NEAR(entry.visit->scan_min, rays / 500 / 60, 1e-9);
    EXPECT_NEAR(entry.value("coverage"), fine[0] ? dear : fine[1] ? wise : cheap, 0.1);
  }
  EXPECT_TRUE(found) << "the front lacks the fine step in the hall alone";
}

TEST(SearchStep, TheFewestStationsAreChosenByTheStepThatSeesMost) {
  Site site = closet_or_hall();
  SurveyProblem problem = fewest_stations(0.9, 0, 1, 8, 0);
  problem.scanners.assign(site.scanners().begin(), site.scanners().end());
  ASSERT_EQ(problem.scanners.size(), 2u);
  const PlanConfig config{.population = 6, .iterations = 4, .sample_voxels = 500, .seed = 4};
  const PlanResult result = plan(site, problem, config);
  ASSERT_FALSE(result.front.empty());
  EXPECT_EQ(result.front.front().violation, 0) << "the coarse step, the first of the list, cannot capture as much";
  ASSERT_TRUE(result.candidates);
  for (const PlacedStation& candidate : result.candidates->stations()) EXPECT_EQ(candidate.setup.scanner, 1u);

  problem.scanners[1].height_m = -1;
  EXPECT_THROW(plan(site, problem, config), Error);
}

}  // namespace
}  // namespace vantage
