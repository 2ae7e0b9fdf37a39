// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include "vantage/error.hpp"
#include "vantage/measure.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

std::uint64_t voxels_for_standard_error(Simulator& simulator, std::span<const Network> networks, double wanted,
                                        bool overlap, const Progress& progress) {
  if (!(wanted > 0))
    throw Error(Errc::invalid_argument,
                "the wanted standard error is " + std::to_string(wanted) + ", but must be above 0");
  constexpr std::uint64_t kFirstPilot = 5000;  // below this, neither pair overlaps nor their errors are reliable
  constexpr double kReserve = 1.1;             // the pilot's error is an estimate, too
  const std::uint64_t population = simulator.voxel_count();
  for (std::uint64_t size = std::min(kFirstPilot, population);;) {
    if (size >= population) return population;
    double error = 0;
    for (const NetworkCounts& counts :
         simulator.evaluate_sampled(networks, {.voxels = size, .overlap = overlap}, progress)) {
      if (counts.cancelled) return size;
      error = std::max(error, coverage_estimate(counts, simulator.goal_density(), population).standard_error);
      if (overlap) error = std::max(error, overlap_estimate(counts, population).standard_error);
    }
    if (error <= wanted || progress.stopped()) return size;
    // error² = s²·(1/n − 1/N) gives s², and s² gives the n for the wanted error.
    const double n = static_cast<double>(size), all = static_cast<double>(population);
    const double variance = error * error / (1 / n - 1 / all);
    const double needed = kReserve / (wanted * wanted / variance + 1 / all);
    size = needed >= all ? population : std::max(static_cast<std::uint64_t>(needed), size + size / 8);
  }
}

}  // namespace vantage
