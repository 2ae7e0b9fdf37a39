// SPDX-License-Identifier: Apache-2.0
// Table 3 of the method: one station before three walls, without and with noise. Prints the rows that docs/cases.md
// shows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "scan/noise_model.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/objective.hpp"
#include "vantage/scene.hpp"
#include "vantage/simulator.hpp"

namespace vantage {
namespace {

struct Wall {
  std::uint64_t points = 0, on_surface = 0;
  double lost() const { return 1.0 - static_cast<double>(on_surface) / static_cast<double>(points); }
};

struct Evaluation {
  std::map<std::string, Wall> walls;
  ScanSummary scan;
  double coverage = 0;
};

class ThreeWalls : public testing::Test {
 protected:
  ThreeWalls() {
    write_built_in_scene("three-walls", 0, folder_ / "scene.glb");
    scene_ = Scene::load(folder_ / "scene.glb");
    scanner_.azimuth_step = scanner_.zenith_step = Angle::degrees(0.0356);
    scanner_.height_m = 1.5;
    scanner_.noise = rtc360_noise();
  }

  Evaluation evaluate(bool noise) const {
    Simulator simulator(scene_, scanner_,
                        {.engine = Engine::embree, .user_size_m = 0.01, .point_spacing_m = 0.006, .noise = noise});
    const Station station{{0, 0, 1.5}};
    Evaluation result;
    result.scan = simulator.scan(station, {.outputs = scan_ids | scan_voxel}, [&](const ScanChunk& chunk) {
      for (std::size_t k = 0; k < chunk.mesh.size(); ++k) {
        if (chunk.mesh[k] < 0) continue;
        Wall& wall = result.walls[scene_.meshes()[static_cast<std::size_t>(chunk.mesh[k])].name];
        ++wall.points;
        wall.on_surface += chunk.voxel[k] != 0xFFFFFFFFu;
      }
    });
    const Network network{station};
    result.coverage = coverage(simulator.evaluate(network), simulator.goal_density());
    return result;
  }

  test::TemporaryFolder folder_;
  Scene scene_{nullptr};
  Scanner scanner_;
};

TEST_F(ThreeWalls, HaveTheShapeOfTable3) {
  const Evaluation clean = evaluate(false), noisy = evaluate(true);
  std::printf("| | without noise | with noise |\n| --- | --- | --- |\n");
  std::printf("| points | %llu | %llu |\n", static_cast<unsigned long long>(clean.scan.points),
              static_cast<unsigned long long>(noisy.scan.points));
  std::printf("| points on surveyed surface | %llu | %llu |\n",
              static_cast<unsigned long long>(clean.scan.points_on_surveyed),
              static_cast<unsigned long long>(noisy.scan.points_on_surveyed));
  std::printf("| coverage | %.3f | %.3f |\n", clean.coverage, noisy.coverage);
  for (const auto& [name, wall] : noisy.walls)
    std::printf("| lost on %s | %.2f %% | %.2f %% |\n", name.c_str(), 100 * clean.walls.at(name).lost(),
                100 * wall.lost());

  // The paper's 383 659 points, to 0.1 %.
  EXPECT_NEAR(static_cast<double>(clean.scan.points), 383'659, 383.659);
  EXPECT_EQ(clean.scan.points, clean.scan.points_on_surveyed);
  EXPECT_EQ(noisy.scan.points, clean.scan.points);
  EXPECT_LT(noisy.scan.points_on_surveyed, clean.scan.points_on_surveyed);
  EXPECT_GE(clean.coverage, 0.27);
  EXPECT_LE(clean.coverage, 0.31);
  EXPECT_LT(noisy.coverage, clean.coverage);

  ASSERT_EQ(noisy.walls.size(), 3u);
  std::vector<std::pair<std::uint64_t, double>> by_points;  // the near wall has the most
  for (const auto& [name, wall] : noisy.walls) by_points.emplace_back(wall.points, wall.lost());
  std::sort(by_points.rbegin(), by_points.rend());
  EXPECT_GT(by_points[1].second, by_points[0].second);
  EXPECT_GT(by_points[2].second, by_points[0].second);
}

TEST_F(ThreeWalls, HaveNoiseOfHalfAMillimetreToTwo) {
  const NoiseModel model = make_noise_model(scanner_, 1);
  // Head on, R = 0.1 is the reflectivity.
  EXPECT_NEAR(model_sigma(model, 10, 0.1), 0.0006, 0.0001);
  EXPECT_GE(model_sigma(model, 10, 0.1), 0.0005);
  EXPECT_LE(model_sigma(model, 30, 0.1), 0.002);
  EXPECT_GT(model_sigma(model, 30, 0.1), model_sigma(model, 10, 0.1));
}

}  // namespace
}  // namespace vantage
