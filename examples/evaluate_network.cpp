// SPDX-License-Identifier: Apache-2.0
// Coverage and overlap of stations, exactly and from a sample: evaluate_network SCENE X Y Z [X Y Z ...]
#include <cstdio>
#include <cstdlib>
#include <vantage/vantage.hpp>

using namespace vantage;

int main(int argc, char** argv) try {
  if (argc < 5 || (argc - 2) % 3 != 0)
    return std::fprintf(stderr, "usage: evaluate_network SCENE X Y Z [X Y Z ...]\n"), 2;

  Site site = Site::open(argv[1], {.user_size_m = 0.1, .spacing_m = 0.01});
  std::vector<PlacedStation> stations;
  for (int k = 2; k < argc; k += 3)
    stations.push_back(site.place_head({std::atof(argv[k]), std::atof(argv[k + 1]), std::atof(argv[k + 2])}).station);

  const Evaluation exact = site.evaluate(stations);
  std::printf("%scoverage %.3f, overlap %.3f, from %llu rays\n", summary_text(exact).c_str(), exact.value("coverage"),
              exact.value("overlap"), static_cast<unsigned long long>(exact.counts.rays));

  // The same from 5000 voxels, with standard errors.
  const Evaluation sampled = site.evaluate(stations, {.sample_voxels = 5'000});
  const auto [coverage, coverage_se] = sampled.values.at("coverage");
  const auto [overlap, overlap_se] = sampled.values.at("overlap");
  std::printf("sampled: coverage %.3f +- %.3f, overlap %.3f +- %.3f, from %llu rays\n", coverage, coverage_se, overlap,
              overlap_se, static_cast<unsigned long long>(sampled.counts.rays));
  return 0;
} catch (const Error& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  for (const auto& line : error.details()) std::fprintf(stderr, "  - %s\n", line.c_str());
  return 1;
}
