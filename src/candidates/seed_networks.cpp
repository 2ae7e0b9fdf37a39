// SPDX-License-Identifier: Apache-2.0
// First networks for a search, chosen among candidates.
#include <algorithm>
#include <cmath>
#include <string>

#include "core/first_numbers.hpp"
#include "core/parse.hpp"
#include "core/part_of.hpp"
#include "site/placement_oracle.hpp"
#include "vantage/candidates.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

// Scan overlap is a share of a scan, some thousand voxels of this number: known to 0.01.
constexpr std::uint64_t kOverlapVoxels = 10'000;

struct Positions {
  std::vector<PlacedStation> stations;  // existing ones, then candidates
  std::vector<std::size_t> existing;    // their places
};

Positions positions_to_choose(Site& site, std::size_t candidates, std::span<const Vec3> existing,
                              std::span<const StationSetup> setups) {
  Positions found{.stations = existing_stations(make_placement_oracle(site), existing, setups), .existing = {}};
  for (PlacedStation& one : found.stations)
    if (active(one)) one.status = StationStatus::ok;  // others are not traced
  found.existing = first_numbers(found.stations.size());
  for (const PlacedStation& one : candidate_positions(site, candidates)) found.stations.push_back(one);
  return found;
}

SampledCoverage coverage_of(Site& site, const Positions& positions, std::uint64_t sample_voxels,
                            const Progress& progress) {
  return sample_coverage(site.simulator(), positions.stations, std::min(sample_voxels, site.simulator().voxel_count()),
                         progress);
}

}  // namespace

GreedyResult greedy_network(Site& site, const GreedyConfig& config, const Progress& progress) {
  if (config.stations < 1 || config.stations + config.existing.size() > max_stations)
    throw Error(Errc::invalid_argument, "greedy: 1 to " + std::to_string(max_stations) +
                                            " stations can be chosen, existing ones included, not " +
                                            std::to_string(config.stations + config.existing.size()));
  if (config.candidates < 1) throw Error(Errc::invalid_argument, "greedy: at least one candidate is needed");
  const Positions positions = positions_to_choose(site, config.candidates, config.existing, config.existing_setups);
  const std::size_t existing = positions.existing.size(), wanted = existing + config.stations;
  if (positions.stations.size() < wanted)
    throw Error(Errc::invalid_argument,
                "greedy: " + std::to_string(config.stations) + " stations cannot be chosen from " +
                    std::to_string(positions.stations.size() - existing) + " candidates; ask for more candidates");
  GreedyResult result;
  const SampledCoverage sampled = coverage_of(site, positions, config.sample_voxels, progress);
  result.cancelled = sampled.cancelled() || progress.stopped();
  if (result.cancelled) return result;
  std::vector<std::size_t> chosen =
      greedy({.matrix = sampled.matrix(), .existing = positions.existing, .most = config.stations});
  for (std::size_t k = existing; chosen.size() < wanted; ++k)
    if (std::ranges::find(chosen, k) == chosen.end()) chosen.push_back(k);
  for (std::size_t at = existing; at < wanted; ++at) {
    result.stations.push_back(positions.stations[chosen[at]]);
    result.coverage.push_back(sampled.matrix().coverage(std::span(chosen).first(at + 1)));
  }
  return result;
}

ExactResult exact_network(Site& site, const ExactConfig& config, const Progress& progress) {
  if (config.candidates < 1) throw Error(Errc::invalid_argument, "exact: at least one candidate is needed");
  check_number(config.apart_m, "exact: the least distance of heads in metres", kNotNegative);
  check_number(config.link, "exact: the least overlap of a link", kAnyShare);
  if (!(config.max_seconds > 0))
    throw Error(Errc::invalid_argument,
                "exact: branch and bound is given " + std::to_string(config.max_seconds) + " s, but needs some");
  const Positions positions = positions_to_choose(site, config.candidates, config.existing, config.existing_setups);
  const std::vector<PlacedStation>& stations = positions.stations;

  ExactResult result;
  const SampledCoverage sampled = coverage_of(site, positions, config.sample_voxels, part_of(progress, 0, 2));
  if (!sampled.cancelled()) {
    StationGraph graph(stations.size());
    if (config.link > 0) graph = overlap_graph(site.surroundings(), stations, kOverlapVoxels, {{}, progress.stop});
    std::vector<Vec3> heads;
    for (const PlacedStation& one : stations) heads.push_back(one.position);
    graph.exclude_nearer(heads, config.apart_m);
    result.choice =
        max_cover({.matrix = sampled.matrix(),
                   .graph = &graph,
                   .existing = positions.existing,
                   .most = config.stations,
                   .link = config.link},
                  {.max_seconds = config.max_seconds, .exact_seconds = config.max_seconds}, part_of(progress, 1, 2));
  }
  result.cancelled = sampled.cancelled() || progress.stopped();
  for (std::size_t at = positions.existing.size(); at < result.choice.chosen.size(); ++at)
    result.stations.push_back(stations[result.choice.chosen[at]]);
  return result;
}

}  // namespace vantage
