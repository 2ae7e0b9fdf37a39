// SPDX-License-Identifier: Apache-2.0
// Evaluates a station while something on the site moves, as a crane or a vehicle does:
//   changed_scene SCENE X Y Z PATTERN [ENGINE]
//
// Moves the meshes whose names match the pattern along x, a metre at a time, and lets one simulator take each scene.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vantage/vantage.hpp>

using namespace vantage;

static double milliseconds_of(const auto& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

int main(int argc, char** argv) try {
  if (argc < 6 || argc > 7) return std::fprintf(stderr, "usage: changed_scene SCENE X Y Z PATTERN [ENGINE]\n"), 2;
  const Scene first = Scene::load(argv[1]);
  const Network network{{.position = {std::atof(argv[2]), std::atof(argv[3]), std::atof(argv[4])}}};
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(0.2);
  const SimulatorConfig config{
      .engine = argc == 7 ? engine_from_string(argv[6]) : Engine::embree, .user_size_m = 0.1, .point_spacing_m = 0.02};

  std::optional<Simulator> simulator;
  std::printf("a new simulator: %.1f ms\n", milliseconds_of([&] { simulator.emplace(first, scanner, config); }));
  for (int metres = 0; metres <= 3; ++metres) {
    // Each scene is made of the first, so that roundings do not add up.
    const Scene moved =
        with_changes(first, {.move = {{argv[5], {.translation = {static_cast<double>(metres), 0, 0}}}}});
    bool kept = false;
    const double taken = milliseconds_of([&] { kept = simulator->set_scene(moved); });
    NetworkCounts counts;
    const double counted = milliseconds_of([&] { counts = simulator->evaluate(network); });
    std::printf("%d m: taken in %.1f ms%s, counted in %.1f ms, coverage %.3f\n", metres, taken,
                kept ? "" : " by making all anew", counted, coverage(counts, simulator->goal_density()));
  }
  const Scene without = with_changes(first, {.remove = {argv[5]}});
  simulator->set_scene(without);
  std::printf("gone: %zu meshes, coverage %.3f\n", without.meshes().size(),
              coverage(simulator->evaluate(network), simulator->goal_density()));
  return 0;
} catch (const Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
