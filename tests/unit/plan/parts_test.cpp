// SPDX-License-Identifier: Apache-2.0
// A search for objectives and requirements that see counts by mesh.
#include <gtest/gtest.h>

#include <string>

#include "support/quad_scene.hpp"
#include "support/site_of.hpp"
#include "vantage/attainable.hpp"
#include "vantage/candidates.hpp"
#include "vantage/error.hpp"
#include "vantage/evaluate.hpp"
#include "vantage/planner.hpp"
#include "vantage/question.hpp"
#include "vantage/summary.hpp"

namespace vantage {
namespace {

Objective captured_part(const std::string& name, const std::string& pattern) {
  return {
      .name = name, .scale = maximise(1, 0), .needs = {.meshes = true}, .value = [pattern](const MeasuredNetwork& m) {
        return captured(m, pattern);
      }};
}

TEST(Parts, AreSearchedForRequiredAndConfirmed) {
  test::QuadScene quads = test::wall_and_floor();
  quads.quad({-6, -3, -1.5f}, {0, 6, 0}, {0, 0, 4});
  quads.data().meshes[0].name = "facade-east", quads.data().meshes[2].name = "facade-west";
  Site site = test::site_of(Simulator(quads.scene(), test::coarse_scanner(1),
                                      {.engine = Engine::embree, .user_size_m = 0.4, .point_spacing_m = 0.1}));
  SurveyProblem problem = coverage_fix(1);
  problem.objectives = {captured_part("all", "facade*")};
  problem.requirements = {{captured_part("east", "facade-east"), Requirement::Bound::at_least, 0.3}};
  const PlanResult result = plan(site, problem, {.population = 8, .iterations = 5, .sample_voxels = 150, .seed = 7});
  ASSERT_FALSE(result.front.empty());
  const PlanEntry& best = result.front.front();
  ASSERT_TRUE(best.exact);
  EXPECT_GE(best.value("east"), 0.3);
  EXPECT_EQ(best.violation, 0);
  const Evaluation again = site.evaluate(best.stations, {.field = true, .measures = {problem.objectives.front()}});
  EXPECT_EQ(best.value("all"), again.value("all"));
  const auto open = static_cast<double>(uncovered(site.simulator(), again).voxels.size());
  EXPECT_NEAR(best.value("all"), 1 - open / static_cast<double>(site.simulator().voxel_count()), 1e-12);
}

// The fewest stations by what they capture of all see one wall; those that 90 % of the other are asked of see it, too.
TEST(Parts, AreCapturedByTheFewestStationsThatTheyAreAskedOf) {
  test::QuadScene quads;
  quads.quad({5, -3, -1.5F}, {0, 6, 0}, {0, 0, 4});
  quads.quad({-20, -8, -1.5F}, {28, 0, 0}, {0, 16, 0}, Role::blocking, 0.2);
  quads.quad({-18, -1, -1.5F}, {0, 2, 0}, {0, 0, 2});
  quads.data().meshes[0].name = "IfcWall east", quads.data().meshes[2].name = "IfcSlab west";
  Site site = test::site_of(Simulator(quads.scene(), test::coarse_scanner(0.5),
                                      {.engine = Engine::embree, .user_size_m = 0.4, .point_spacing_m = 0.1}));
  const auto planned = [&](const std::vector<std::string>& requirements) {
    SurveyQuestion question{.capture = 0.7, .link = 0.0, .requirements = requirements};
    return plan(site, question, {.sample_voxels = 400, .seed = 7});
  };
  const PlanResult plain = planned({"capture(IfcSlab*)>=0"}),
                   both = planned({"capture(IfcSlab*)>=0.9", "capture(!IfcSlab*)>=0.6"});
  EXPECT_TRUE(met(plain) && met(both));
  const PlanEntry &one = plain.front[answer(plain)], &two = both.front[answer(both)];
  EXPECT_LT(one.value("capture(IfcSlab*)"), 0.9) << "or nothing was to be asked for";
  EXPECT_GE(two.value("capture(IfcSlab*)"), 0.9);
  EXPECT_GE(two.value("capture(!IfcSlab*)"), 0.6);
  // Counts what the candidates and the stations can attain, on every voxel.
  AttainableCounts attainable(site.simulator(), site.simulator().voxel_count());
  attainable.tell_of(site.simulator(), "IfcSlab*");
  raise_attainable(attainable, site.simulator(), to_network(both.candidates->stations()));
  raise_attainable(attainable, site.simulator(), to_network(two.stations));
  const Network network = to_network(two.stations);
  const auto shares = captured_shares(site.simulator(), attainable, {&network, 1});
  EXPECT_NEAR(shares[0].meshes.at("IfcSlab*").value, two.value("capture(IfcSlab*)"),
              0.01 + 3 * two.estimate("capture(IfcSlab*)").standard_error);
  EXPECT_NE(summary_text(both).find("of what is attainable of IfcSlab*, of which at least 90 % were asked for"),
            std::string::npos)
      << summary_text(both);
  EXPECT_THROW(planned({"capture(IfcDoor*)>=0.5"}), Error) << "there is none";
}

}  // namespace
}  // namespace vantage
