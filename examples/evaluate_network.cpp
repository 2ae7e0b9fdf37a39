// SPDX-License-Identifier: Apache-2.0
// What a set of stations captures of a site, exactly and from a sample: evaluate_network SCENE X Y Z [X Y Z ...]
#include <cstdio>
#include <cstdlib>
#include <vantage/vantage.hpp>

using namespace vantage;

int main(int argc, char** argv) try {
  if (argc < 5 || (argc - 2) % 3 != 0)
    return std::fprintf(stderr, "usage: evaluate_network SCENE X Y Z [X Y Z ...]\n"), 2;

  const Scene scene = Scene::load(argv[1]);
  Network network;
  for (int k = 2; k < argc; k += 3)
    network.push_back({.position = {std::atof(argv[k]), std::atof(argv[k + 1]), std::atof(argv[k + 2])}});

  Simulator simulator(scene, Scanner{}, {.user_size_m = 0.1, .point_spacing_m = 0.01});

  const NetworkCounts counts = simulator.evaluate(network);
  std::printf("coverage %.3f, overlap %.3f, from %llu rays\n", coverage(counts, simulator.goal_density()),
              clustering_coefficient(overlap_matrix(counts)), static_cast<unsigned long long>(counts.rays));

  // The same from 5000 voxels, with standard errors: what a search would use, many networks at a time.
  const NetworkCounts sample = simulator.evaluate_sampled({&network, 1}, {.voxels = 5'000}).front();
  const Estimate covered = coverage_estimate(sample, simulator.goal_density(), simulator.voxel_count());
  const Estimate overlapped = overlap_estimate(sample, simulator.voxel_count());
  std::printf("sampled: coverage %.3f +- %.3f, overlap %.3f +- %.3f, from %llu rays\n", covered.value,
              covered.standard_error, overlapped.value, overlapped.standard_error,
              static_cast<unsigned long long>(sample.rays));
  return 0;
} catch (const Error& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  for (const auto& line : error.details()) std::fprintf(stderr, "  - %s\n", line.c_str());
  return 1;
}
