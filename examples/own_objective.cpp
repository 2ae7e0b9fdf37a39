// SPDX-License-Identifier: Apache-2.0
// Searches for an objective that the library does not know, under a requirement: own_objective SCENE N FOLDER
//
// No scan should stand alone. For every station take the neighbour that shares most with it, as a share of the smaller
// scan; the least of these is to be as large as can be, and the coverage at least 0.5.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <vantage/vantage.hpp>

using namespace vantage;

double loneliest(const MeasuredNetwork& network) {
  const ScanOverlapMatrix overlap = scan_overlap_matrix(*network.surroundings);
  double least = 1;
  for (std::size_t i = 0; i < overlap.size(); ++i) least = std::min(least, std::ranges::max(overlap.row(i)));
  return least;
}

int main(int argc, char** argv) try {
  if (argc != 4) return std::fprintf(stderr, "usage: own_objective SCENE N FOLDER\n"), 2;

  const std::array steps{Angle::degrees(0.2), Angle::degrees(0.2)};
  Site site = Site::open(argv[1], {.steps = steps, .height_m = 1.5, .user_size_m = 0.2, .spacing_m = 0.05});

  const auto stations = static_cast<std::size_t>(std::atoi(argv[2]));
  SurveyProblem problem = coverage_fix(stations);
  problem.name = "custom";
  problem.objectives.push_back({.name = "neighbour",
                                .label = "What the loneliest scan shares with its neighbour",
                                .scale = maximise(1, 0),
                                .needs = {.surroundings = true},
                                .value = loneliest});
  problem.requirements = {make_requirement("coverage >= 0.5")};
  const PlanConfig config{.population = 20, .iterations = 10, .sample_voxels = 5'000, .seed = 42};
  const PlanResult result = plan(site, problem, config);

  for (const PlanEntry& entry : result.front)
    std::printf("coverage %.3f, neighbour %.3f%s\n", entry.value("coverage"), entry.value("neighbour"),
                entry.violation > 0 ? "  (misses what is required)" : "");
  write_plan(argv[3], result, site);
  return 0;
} catch (const Error& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  for (const auto& line : error.details()) std::fprintf(stderr, "  - %s\n", line.c_str());
  return 1;
}
