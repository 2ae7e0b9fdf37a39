// SPDX-License-Identifier: Apache-2.0
// Section 5.1.2 of the method: the four walls at the paper's parameters.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <set>

#include "support/temporary_folder.hpp"
#include "vantage/built_in_scenes.hpp"
#include "vantage/objective.hpp"
#include "vantage/scene.hpp"
#include "vantage/simulator.hpp"

namespace vantage {
namespace {

class FourWalls : public testing::Test {
 protected:
  FourWalls() {
    write_built_in_scene("four-walls", 0, folder_ / "scene.glb");
    scene_ = Scene::load(folder_ / "scene.glb");
    scanner_.height_m = 1.5;
  }
  Simulator simulator() const {
    return {scene_, scanner_, {.engine = Engine::embree, .user_size_m = 0.1, .point_spacing_m = 0.01}};
  }

  test::TemporaryFolder folder_;
  Scene scene_{nullptr};
  Scanner scanner_;
};

TEST_F(FourWalls, HaveThePapersRaysAndGoal) {
  const Simulator s = simulator();
  EXPECT_EQ(s.scanner().rays(), 5'400'000u);
  EXPECT_NEAR(s.goal_density(), 61.3, 0.1);
}

// The walls are axis-aligned rectangles, so the voxels that they touch are plain intervals. Counted in double, on the
// simulator's own grid, by the centres of its voxels.
TEST_F(FourWalls, TouchAsManyVoxelsAsCountedInDouble) {
  const Simulator s = simulator();
  const double size = s.voxel_size_m();
  EXPECT_NEAR(size, 10.02 / 128, 1e-5);
  const Vec3 first = s.voxel_centre(0);
  const auto cell = [&](double v, double anchor) { return static_cast<int>(std::floor((v - anchor) / size + 0.5)); };
  std::set<std::array<int, 3>> cells;
  const auto add = [&](double x0, double x1, double y0, double y1) {
    for (int x = cell(x0, first.x); x <= cell(x1, first.x); ++x)
      for (int y = cell(y0, first.y); y <= cell(y1, first.y); ++y)
        for (int z = cell(0, first.z); z <= cell(5, first.z); ++z) cells.insert({x, y, z});
  };
  add(-5, 5, -5, -5);
  add(-5, 5, 5, 5);
  add(-5, -5, -5, 5);
  add(5, 5, -5, 5);
  EXPECT_EQ(s.voxel_count(), cells.size());
}

// A station 3 m in front of each wall sees only that wall.
TEST_F(FourWalls, ReachThePapersCoverageWithAStationBeforeEach) {
  Simulator s = simulator();
  const Network network{{{8, 0, 1.5}}, {{-8, 0, 1.5}}, {{0, 8, 1.5}}, {{0, -8, 1.5}}};
  const NetworkCounts counts = s.evaluate(network);
  const double share = coverage(counts, s.goal_density());
  std::printf("coverage %.4f\n", share);
  EXPECT_NEAR(share, 0.89, 0.005);
  // Two walls share only the column of voxels at their corner.
  const auto column = static_cast<std::uint64_t>(std::ceil(5 / s.voxel_size_m()));
  for (const std::uint64_t both : counts.shared) EXPECT_LE(both, column);
}

}  // namespace
}  // namespace vantage
