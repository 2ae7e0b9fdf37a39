// SPDX-License-Identifier: Apache-2.0
#include "stress/reference_differences.hpp"

#include <algorithm>
#include <cmath>

#include "vantage/objective.hpp"

namespace vantage::test {

ReferenceDifferences compare_with_reference(const EngineInfo& engine, const TestSite& site) {
  constexpr double goal_density = 12.5;
  const TraceScene clean_scene = site.trace_scene(false), noisy_scene = site.trace_scene(true);
  const auto clean = make_tracer(engine, clean_scene), noisy = make_tracer(engine, noisy_scene);
  noisy->set_goal_density(goal_density);

  ReferenceDifferences d;
  std::vector<std::vector<ReferenceHit>> hits;
  for (std::size_t s = 0; s < site.stations.size(); ++s) {
    const std::vector<ReferenceHit>& reference = site.reference(s, false);
    d.rays.add(compare(*clean, clean_scene, site.stations[s], reference));
    d.rays.sigma_m =
        std::max(d.rays.sigma_m, sigma_difference(*noisy, *clean, *site.noise, site.stations[s], reference));
    hits.push_back(site.reference(s, true));
  }

  const BruteForce expected = brute_force_objectives(*site.grid, goal_density, hits);
  const auto stations = static_cast<std::uint32_t>(site.stations.size());
  const NetworkCounts counts = noisy->count(site.stations, stations, {}, {});
  const OverlapMatrix overlap = overlap_matrix(counts);
  d.coverage = std::abs(vantage::coverage(counts, goal_density) - expected.coverage);
  for (std::size_t i = 0; i < stations; ++i)
    for (std::size_t j = i + 1; j < stations; ++j)
      d.overlap = std::max(d.overlap, std::abs(overlap(i, j) - expected.overlap(i, j)));
  d.clustering = std::abs(clustering_coefficient(overlap) - expected.clustering);
  return d;
}

}  // namespace vantage::test
