// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "core/part_of.hpp"
#include "plan/fewest_on_rows.hpp"
#include "plan/placement_oracle.hpp"
#include "vantage/error.hpp"
#include "vantage/planner.hpp"

namespace vantage {

std::vector<RowLink> links_between(Simulator& surroundings, std::span<const PlacedStation> stations, double least,
                                   std::uint64_t sample_voxels, const Progress& progress) {
  const CaptureRows rows = capture_rows(surroundings, stations, sample_voxels, progress);
  const PairTable pairs(rows, stations.first(rows.size()), 0);
  std::vector<RowLink> links;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    for (std::size_t j = i + 1; j < pairs.size(); ++j)
      if (pairs.overlap(i, j) > 0 && static_cast<double>(pairs.overlap(i, j)) >= least) links.push_back({i, j});
  return links;
}

ExactResult exact_network(Simulator& simulator, const SearchArea& area, const ClashChecker& clash,
                          const ExactConfig& config, const Progress& progress) {
  if (config.candidates < 1) throw Error(Errc::invalid_argument, "exact: at least one candidate is needed");
  if (!(config.apart_m >= 0 && std::isfinite(config.apart_m)))
    throw Error(Errc::invalid_argument,
                "exact: heads are to be " + std::to_string(config.apart_m) + " m apart; give 0 or more");
  if (!(config.max_seconds > 0))
    throw Error(Errc::invalid_argument,
                "exact: branch and bound is given " + std::to_string(config.max_seconds) + " s, but needs some");
  const PlacementOracle site = make_placement_oracle(area, clash, simulator.scanner());
  std::vector<PlacedStation> stations = existing_stations(site, config.fixed, {});
  for (PlacedStation& one : stations)
    if (active(one)) one.status = StationStatus::ok;  // rows of others are empty
  const std::size_t kept = stations.size();
  for (const PlacedStation& one : candidate_positions(area, clash, simulator.scanner(), config.candidates))
    stations.push_back(one);
  std::vector<std::size_t> fixed(kept);
  std::iota(fixed.begin(), fixed.end(), 0u);

  ExactResult result;
  const std::uint64_t sample = config.sample_voxels > 0 ? config.sample_voxels : simulator.voxel_count();
  const CaptureRows rows = capture_rows(simulator, stations, sample, part_of(progress, 0, 2));
  BoundConfig bound{.max_seconds = config.max_seconds, .exact_seconds = config.max_seconds};
  for (std::size_t i = 0; i < stations.size(); ++i)
    for (std::size_t j = std::max(i + 1, kept); j < stations.size(); ++j)
      if (const Vec3 apart = stations[i].position - stations[j].position;
          dot(apart, apart) < config.apart_m * config.apart_m)
        bound.exclude.push_back({i, j});
  if (config.link > 0 && !rows.cancelled()) {
    Simulator surroundings = surroundings_of(simulator);
    const auto links = links_between(surroundings, stations, config.link, 10'000, {{}, progress.stop});
    result.choice = bound_linked_capture(rows, config.stations, links, fixed, bound, part_of(progress, 1, 2));
  } else if (!rows.cancelled()) {
    result.choice = bound_capture(rows, config.stations, fixed, bound, part_of(progress, 1, 2));
  }
  result.cancelled = rows.cancelled() || progress.stopped();
  for (std::size_t k = kept; k < result.choice.chosen.size(); ++k)
    result.stations.push_back(stations[result.choice.chosen[k]]);
  return result;
}

}  // namespace vantage
