// SPDX-License-Identifier: Apache-2.0
// A search for objectives and requirements that see counts by mesh.
#include <gtest/gtest.h>

#include <string>

#include "support/quad_scene.hpp"
#include "support/site_of.hpp"
#include "vantage/planner.hpp"

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

}  // namespace
}  // namespace vantage
