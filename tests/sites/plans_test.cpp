// SPDX-License-Identifier: Apache-2.0
// The default question on whole sites: its requirements are met, every room is visited, and the time on site is
// plausible.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/graph.hpp"
#include "sites/random_site.hpp"
#include "sites/site.hpp"
#include "support/site_of.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/planner.hpp"
#include "vantage/question.hpp"
#include "vantage/site.hpp"

namespace vantage {
namespace {

// Rays and voxels that let a plan take seconds.
constexpr double kStep_deg = 0.6, kVoxel_m = 0.3, kSpacing_m = 0.1;
constexpr std::uint64_t kSample = 4'000;
// Least coverage of a room without a station, relative to that of the whole site.
constexpr double kRoomShare = 0.7;

Scanner coarse_scanner() {
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(kStep_deg);
  return scanner;
}

bool within(const test::Place& place, const Vec3& local, double low, double high) {
  return local.x >= place.x0 && local.x <= place.x1 && local.y >= place.y0 && local.y <= place.y1 &&
         local.z >= place.z + low && local.z <= place.z + high;
}

// Mean fill of the voxels from a place's floor up to a person's reach.
double captured_of(const test::Place& place, const test::KnownSite& site, const Simulator& simulator,
                   const VoxelField& field) {
  double sum = 0, count = 0;
  for (std::uint64_t voxel = 0; voxel < simulator.voxel_count(); ++voxel) {
    if (!within(place, simulator.voxel_centre(voxel) - site.offset, -0.5 * simulator.voxel_size_m(), 2)) continue;
    sum += std::min(1.0, field.count[voxel] / simulator.goal_density());
    ++count;
  }
  return count > 0 ? sum / count : 1;
}

Site site_in(const std::filesystem::path& file) {
  return test::site_of(Simulator(Scene::load(file), coarse_scanner(),
                                 {.engine = Engine::embree, .user_size_m = kVoxel_m, .point_spacing_m = kSpacing_m}));
}

class Plans : public testing::TestWithParam<std::string> {};

TEST_P(Plans, MeetWhatIsAskedAndVisitEveryRoom) {
  const test::TemporaryFolder folder;
  const test::KnownSite site = test::make_site(GetParam());
  test::write_site(site, {}, folder / "site.glb");
  Site planned = site_in(folder / "site.glb");
  const PlanResult result = plan(planned, fewest_stations(), {.iterations = 0, .sample_voxels = kSample});
  ASSERT_EQ(result.front.size(), 1u);
  const PlanEntry& entry = result.front[answer(result)];
  std::string missing;
  for (const std::string& help : what_would_help(result)) missing += help + "\n";
  EXPECT_TRUE(met(result)) << missing;
  EXPECT_GE(entry.value("capture"), 0.9);
  EXPECT_GE(entry.value("link"), 0.3);
  EXPECT_NEAR(entry.value("link"), connectivity(entry.scan_overlap_matrix, 0).weakest_overlap, 1e-12);
  EXPECT_GE(entry.value("apart"), 1);

  Simulator& simulator = planned.simulator();
  VoxelField field;
  const NetworkCounts counts = simulator.evaluate(to_network(entry.stations), {.overlap = false, .field = &field});
  const double whole = coverage(counts, simulator.goal_density());
  EXPECT_NEAR(entry.value("coverage"), whole, 1e-12);
  for (const test::Place& place : site.places) {
    const bool visited = std::ranges::any_of(entry.stations, [&](const PlacedStation& station) {
      return within(place, station.ground - site.offset, -0.2, 0.5);
    });
    EXPECT_TRUE(visited || captured_of(place, site, simulator, field) >= kRoomShare * whole) << place.name;
  }

  // Straight lines in the order of visits, plus a quarter for obstacles.
  ASSERT_TRUE(entry.visit);
  const OnSiteOptions on_site;
  double walk = 0;
  for (std::size_t k = 0; k < entry.visit->order.size(); ++k) {
    const Vec3 way = entry.stations[entry.visit->order[(k + 1) % entry.visit->order.size()]].ground -
                     entry.stations[entry.visit->order[k]].ground;
    walk += 1.25 * std::sqrt(dot(way, way));
  }
  const auto count = static_cast<double>(entry.stations.size());
  const double minutes = count * (on_site.set_up_min + static_cast<double>(coarse_scanner().rays()) / 1e6 / 60) +
                         walk / on_site.walking_m_per_s / 60;
  EXPECT_NEAR(entry.visit->minutes, minutes, 0.3 * minutes);
  EXPECT_EQ(entry.visit->order.size(), entry.stations.size());
}

TEST(PlansInATime, HaveAsManyStationsAsThereIsTimeFor) {
  const test::TemporaryFolder folder;
  test::write_site(test::make_site("office"), {}, folder / "site.glb");
  Site office = site_in(folder / "site.glb");
  const PlanConfig config{.iterations = 2, .sample_voxels = kSample};
  const auto planned = [&](const SurveyProblem& problem) { return plan(office, problem, config); };
  const PlanResult free = planned(fewest_stations());
  const PlanEntry& all = free.front[answer(free)];
  ASSERT_TRUE(all.visit);

  SurveyProblem hurried = fewest_stations();
  const double limit = 0.6 * all.visit->minutes;
  hurried.requirements.push_back({make_objective("time"), Requirement::Bound::at_most, limit});
  const PlanResult result = planned(hurried);
  const PlanEntry& entry = result.front[answer(result)];
  ASSERT_TRUE(entry.visit);
  EXPECT_LE(entry.visit->minutes, limit);
  EXPECT_LT(entry.value("capture"), all.value("capture"));
  EXPECT_FALSE(met(result));
  // The walk of the whole network is about as long as that of a part.
  const double each = (all.visit->scan_min + all.visit->set_up_min) / static_cast<double>(all.stations.size());
  EXPECT_GE(static_cast<double>(entry.stations.size()) + 1, std::floor((limit - all.visit->walk_min) / each));
  const std::vector<std::string> help = what_would_help(result);
  ASSERT_FALSE(help.empty());
  EXPECT_NE(help.front().find("more time than"), std::string::npos) << help.front();
}

// Number of parts that links leave of a plan of a random site in feet, by coarse scans.
std::size_t parts_of_plan(std::uint64_t seed) {
  const test::TemporaryFolder folder;
  test::write_site(test::make_random_site(seed), folder / "site.glb");
  const Angle step = Angle::degrees(0.4);
  SiteOptions coarse;
  coarse.scene = {.unit = seed == 5 ? Unit::foot : Unit::metre, .up = UpAxis::z};
  coarse.engine = Engine::embree;
  coarse.steps = {step, step};
  coarse.user_size_m = kVoxel_m, coarse.spacing_m = kSpacing_m;
  Site site = Site::open(folder / "site.glb", coarse);
  SurveyQuestion question;
  question.targets = 0;
  const PlanResult result = plan(site, question);
  const auto links = result.front[answer(result)].links();
  return links ? links->parts.size() : 0;
}

// Candidates far apart do not link the storeys of the one building, but some along its stair do. No stair joins those
// of the other: they are two parts, and not each room one.
TEST(PlansOfParts, MendTheLinksThatCanBeMended) {
  EXPECT_EQ(parts_of_plan(5), 1u);
  EXPECT_EQ(parts_of_plan(10), 2u);
}

// The windows of the house show its garden, and the rooms over each other the same of it. The truth about the site
// tells the hall and the landing, which the stair leads from and to.
TEST(PlansWithStairs, TieStoreysInTheStairwell) {
  const test::TemporaryFolder folder;
  const test::KnownSite site = test::make_site("house");
  test::write_site(site, {}, folder / "site.glb");
  SiteOptions fine;
  fine.engine = Engine::embree;
  fine.steps = {Angle::degrees(0.2), Angle::degrees(0.2)};
  fine.user_size_m = 0.2, fine.spacing_m = 0.1;
  Site house = Site::open(folder / "site.glb", fine);
  SurveyQuestion question;
  question.targets = 0;
  const PlanResult result = plan(house, question);
  const PlanEntry& entry = result.front[answer(result)];
  EXPECT_TRUE(met(result));
  const auto in_stairwell = [&](const PlacedStation& station) {
    return std::ranges::any_of(site.places, [&](const test::Place& place) {
      return (place.name == "hall" || place.name == "landing") &&
             within(place, station.ground - site.offset, -0.2, 0.5);
    });
  };
  const auto parts = [&](bool only_by_the_stair) {
    return components(entry.stations.size(),
                      [&](std::size_t a, std::size_t b) {
                        const PlacedStation &one = entry.stations[a], &other = entry.stations[b];
                        const bool same_storey = std::abs(one.ground.z - other.ground.z) < 1;
                        return entry.scan_overlap_matrix(a, b) >= 0.3 &&
                               (!only_by_the_stair || same_storey || (in_stairwell(one) && in_stairwell(other)));
                      })
        .count;
  };
  EXPECT_EQ(parts(false), 1u);
  EXPECT_EQ(parts(true), 1u) << "storeys are tied past the stair";
  EXPECT_TRUE(entry.storey_ties.empty());
}

// The larger two only with VANTAGE_WHOLE_SITES=1.
std::vector<std::string> planned_sites() {
  if (std::getenv("VANTAGE_WHOLE_SITES")) return {"office", "house", "street", "plant"};
  return {"office", "house"};
}
INSTANTIATE_TEST_SUITE_P(OfEverySite, Plans, testing::ValuesIn(planned_sites()),
                         [](const auto& site) { return site.param; });

}  // namespace
}  // namespace vantage
