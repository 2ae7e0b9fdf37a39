// SPDX-License-Identifier: Apache-2.0
// Scans with a scanner whose rays form no grid: own_pattern SCENE X Y Z [DIRECTIONS.csv]
//
// Without a file, the rosette of two turning prisms, of half a second, which looks along +X. Tells how the points come
// in, and how much of the site this and a spinning scanner of 16 rows capture from the point.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <vantage/vantage.hpp>

using namespace vantage;

// Each prism bends the beam by 9.5° towards where it points, so the field is a circle of 38°.
static DirectionTable rosette(double seconds, double points_per_second) {
  DirectionTable table;
  for (double k = 0; k < seconds * points_per_second; ++k) {
    const double time = k / points_per_second, first = 2 * std::numbers::pi * 121.6 * time,
                 second = -2 * std::numbers::pi * 77.7 * time;
    const Angle aside = Angle::degrees(9.5 * (std::cos(first) + std::cos(second))),
                up = Angle::degrees(9.5 * (std::sin(first) + std::sin(second)));
    table.directions.push_back({.zenith = Angle::degrees(90 - up.in_degrees()), .azimuth = aside});
    table.times_s.push_back(time);
  }
  return table;
}

int main(int argc, char** argv) try {
  if (argc != 5 && argc != 6) return std::fprintf(stderr, "usage: own_pattern SCENE X Y Z [DIRECTIONS.csv]\n"), 2;
  const Scene scene = Scene::load(argv[1]);
  const Vec3 head{std::atof(argv[2]), std::atof(argv[3]), std::atof(argv[4])};

  Scanner prisms;
  prisms.name = "two prisms";
  prisms.min_range_m = 0.5, prisms.max_range_m = 90;
  const DirectionTable table = argc == 6 ? load_directions(argv[5]) : rosette(0.5, prisms.points_per_second = 200'000);
  prisms.set_directions(table.directions, table.times_s);

  Scanner spinning;
  spinning.name = "16 rows";
  std::vector<Angle> zeniths;
  for (double zenith = 75; zenith <= 105; zenith += 2) zeniths.push_back(Angle::degrees(zenith));
  spinning.azimuth_step = Angle::degrees(0.2);
  spinning.set_row_zeniths(zeniths);

  const std::array scanners{prisms, spinning};
  Simulator simulator(scene, scanners, {.user_size_m = 0.2, .point_spacing_m = 0.1});
  std::size_t points = 0;
  double first_s = -1, last_s = 0;
  const auto count = [&](const ScanChunk& chunk) {
    for (std::size_t k = 0; k < chunk.ray_count; ++k) {
      if (!std::isfinite(chunk.range_m[k])) continue;
      last_s = prisms.time_s(chunk.first_ray + k);  // rays come in the order of the list
      if (points++ == 0) first_s = last_s;
    }
  };
  simulator.scan({.position = head}, {.outputs = scan_range}, count);
  std::printf("%zu points of %zu rays, the first after %.4f s, the last after %.4f s\n", points,
              table.directions.size(), first_s, last_s);
  for (std::uint32_t k = 0; k < scanners.size(); ++k) {
    const Network network{{.position = head, .setup = {.scanner = k}}};
    std::printf("%s: coverage %.4f\n", scanners[k].name.c_str(),
                coverage(simulator.evaluate(network), simulator.goal_density()));
  }
  return 0;
} catch (const Error& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 1;
}
