// SPDX-License-Identifier: Apache-2.0
// Searches for the best networks of N stations, coverage against overlap, and writes the front: plan_survey SCENE N
// FOLDER
#include <cstdio>
#include <cstdlib>
#include <vantage/vantage.hpp>

using namespace vantage;

int main(int argc, char** argv) try {
  if (argc != 4) return std::fprintf(stderr, "usage: plan_survey SCENE N FOLDER\n"), 2;

  const Scene scene = Scene::load(argv[1]);
  const Scanner scanner{.azimuth_step = Angle::degrees(0.2), .zenith_step = Angle::degrees(0.2), .height_m = 1.5};
  Simulator simulator(scene, scanner, {.user_size_m = 0.2, .point_spacing_m = 0.05});
  const SearchArea area = SearchArea::build(scene);
  const ClashChecker clash(scene);

  const auto stations = static_cast<std::size_t>(std::atoi(argv[2]));
  const PlanConfig config{.population = 20, .iterations = 10, .sample_voxels = 5'000, .seed = 42};
  const PlanResult result =
      plan(simulator, area, clash, coverage_overlap_fix(stations), config, {.report = [](const PlanProgress& now) {
             std::fprintf(stderr, "\r%zu of %zu, hypervolume %.3f", now.iteration, now.iterations, now.hypervolume);
           }});
  std::fprintf(stderr, "\n");

  for (const PlanEntry& entry : result.front)
    std::printf("coverage %.3f, overlap %.3f\n", entry.value("coverage"), entry.value("overlap"));
  write_plan(argv[3], result, simulator, area);
  return 0;
} catch (const Error& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  for (const auto& line : error.details()) std::fprintf(stderr, "  - %s\n", line.c_str());
  return 1;
}
