// SPDX-License-Identifier: Apache-2.0
// Traces rays that belong to no scanner: own_rays SCENE X Y Z [ENGINE]
//
// Looks around from a point with 100 000 rays, says what is nearest and how open the place is, and which of a line of
// points it sees.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vantage/vantage.hpp>
#include <vector>

using namespace vantage;

// Directions that are spread evenly over the sphere, by the golden angle.
std::vector<Vec3> all_around(std::size_t many) {
  std::vector<Vec3> directions;
  for (std::size_t k = 0; k < many; ++k) {
    const double z = 1 - (2 * static_cast<double>(k) + 1) / static_cast<double>(many);
    const double around = 2.399963229728653 * static_cast<double>(k), level = std::sqrt(1 - z * z);
    directions.push_back({level * std::cos(around), level * std::sin(around), z});
  }
  return directions;
}

int main(int argc, char** argv) try {
  if (argc != 5 && argc != 6) return std::fprintf(stderr, "usage: own_rays SCENE X Y Z [ENGINE]\n"), 2;
  const Scene scene = Scene::load(argv[1]);
  const Vec3 eye{std::atof(argv[2]), std::atof(argv[3]), std::atof(argv[4])};

  // "auto" is the best graphics card, if there is one. The answers are the same.
  const RayTracer tracer(scene, {argc == 6 ? engine_from_string(argv[5]) : Engine::embree});
  const std::vector<Vec3> directions = all_around(100'000);
  const RayHits hits = tracer.nearest({.origins = {&eye, 1}, .directions = directions});

  std::map<std::string, std::size_t> met;  // rays by the name of the mesh
  for (const std::int32_t mesh : hits.mesh)
    if (mesh >= 0) ++met[scene.meshes()[static_cast<std::size_t>(mesh)].name];
  for (const auto& [name, rays] : met) std::printf("%s: %zu rays\n", name.c_str(), rays);
  const auto nearest = std::ranges::min_element(hits.range_m) - hits.range_m.begin();
  const auto k = static_cast<std::size_t>(nearest);
  if (hits.mesh[k] >= 0)
    std::printf("nearest surface at %.2f m, at (%.2f, %.2f, %.2f)\n", hits.range_m[k], hits.position[k].x,
                hits.position[k].y, hits.position[k].z);

  // It takes less time to tell that anything is met than what.
  const double within = 10;
  const auto blocked = tracer.blocked({.origins = {&eye, 1}, .directions = directions, .ranges_m = {&within, 1}});
  const auto stopped = std::ranges::count(blocked, 1);
  std::printf("%.1f %% of the view is open for 10 m\n", 100 - 100 * static_cast<double>(stopped) / 1e5);

  std::vector<Vec3> line;
  for (int x = -20; x <= 20; ++x) line.push_back(eye + Vec3{static_cast<double>(x), 20, 0});
  const auto sees = ClashChecker(scene).sees({&eye, 1}, line);
  std::printf("sees %d of %zu points\n", static_cast<int>(std::ranges::count(sees, 1)), line.size());
  return 0;
} catch (const Error& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 1;
}
