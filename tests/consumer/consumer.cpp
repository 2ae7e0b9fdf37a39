// SPDX-License-Identifier: Apache-2.0
// A program of somebody else's: one wall, one station, and a count that must not be zero.
#include <array>
#include <cstdio>
#include <vantage/vantage.hpp>
#include <vector>

int main() {
  using namespace vantage;
  const std::vector<Vec3> corners{{3, -2, 0}, {3, 2, 0}, {3, 2, 2}, {3, -2, 2}};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}, {0, 2, 3}};
  const Scanner scanner{.azimuth_step = Angle::degrees(1), .zenith_step = Angle::degrees(1)};
  Simulator simulator(Scene::from_triangles(corners, triangles), scanner,
                      {.engine = Engine::embree, .user_size_m = 0.5, .point_spacing_m = 0.1});
  const NetworkCounts counts = simulator.evaluate({{.position = {0, 0, 1}}});
  std::printf("vantage %s: coverage %.3f\n", version(), coverage(counts, simulator.goal_density()));
  return counts.voxels > 0 && counts.points_on_surveyed.at(0) > 0 ? 0 : 1;
}
