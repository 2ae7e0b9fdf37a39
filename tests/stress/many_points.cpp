// SPDX-License-Identifier: Apache-2.0
#include "stress/many_points.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "stress/leaks.hpp"
#include "vantage/error.hpp"
#include "vantage/objective.hpp"

namespace vantage::test {

double ManyPoints::wanted() const { return std::min(1.0, static_cast<double>(points) / goal); }
double ManyPoints::wrapped() const {
  return std::min(1.0, static_cast<double>(static_cast<std::uint32_t>(points)) / goal);
}

std::vector<ManyPoints> trace_many_points(const EngineInfo& engine, double step_degrees) {
  constexpr double goal = 2e9;
  const ClosedMesh box = cube();
  const Scene scene = Scene::from_triangles(box.positions, box.triangles);
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(step_degrees);
  SimulatorConfig config{.engine = engine.engine, .user_size_m = 3};
  if (engine.engine != Engine::embree) config.device_index = engine.device_index;
  config.point_spacing_m = Simulator(scene, scanner, config).voxel_size_m() / std::sqrt(goal);
  Simulator simulator(scene, scanner, config);
  if (simulator.voxel_count() != 1) throw Error(Errc::invalid_argument, "the cube has more than one voxel");

  Network network;
  for (int k = 0; k < 64; ++k) network.push_back({{0.1 * (k % 4), 0.1 * (k / 4 % 4), 0.1 * (k / 16)}});
  std::vector<ManyPoints> all;
  for (const std::size_t stations : {16u, 64u}) {
    VoxelField field;
    const NetworkCounts counts = simulator.evaluate(
        {network.begin(), network.begin() + static_cast<std::ptrdiff_t>(stations)}, {.field = &field});
    all.push_back(
        {stations, scanner.rays() * stations,
         std::accumulate(counts.points_on_surveyed.begin(), counts.points_on_surveyed.end(), std::uint64_t{0}),
         field.count.at(0), simulator.goal_density(), coverage(counts, simulator.goal_density())});
  }
  return all;
}

}  // namespace vantage::test
