// SPDX-License-Identifier: Apache-2.0
#include "plan/candidate_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace vantage {

TraceColumns columns_of(Simulator& simulator, std::uint64_t sample_voxels) {
  return [&simulator, sample_voxels](std::span<const PlacedStation> stations, const Progress& progress) {
    return sample_coverage(simulator, stations, sample_voxels, progress).matrix();
  };
}

CandidateTable::CandidateTable(TraceColumns surveyed, TraceColumns surroundings, double nearest_m)
    : surveyed_(std::move(surveyed)),
      surroundings_(std::move(surroundings)),
      nearest_m_(nearest_m),
      matrix_(surveyed_({}, {})),
      around_(surroundings_ ? surroundings_({}, {}) : CoverageMatrix()) {}

bool CandidateTable::add(std::span<const PlacedStation> stations, const Progress& progress) {
  const CoverageMatrix fresh = surveyed_(stations, progress);
  const std::size_t count = std::min(stations.size(), fresh.candidates());
  return add(stations.first(count), fresh, progress) && count == stations.size();
}

bool CandidateTable::add(std::span<const PlacedStation> stations, const CoverageMatrix& known,
                         const Progress& progress) {
  std::size_t count = std::min(stations.size(), known.candidates());
  if (surroundings_) {
    const CoverageMatrix fresh = surroundings_(stations.first(count), {.report = {}, .stop = progress.stop});
    around_.append(fresh);
    count = std::min(count, fresh.candidates());
  }
  matrix_.append(known, count);
  stations_.insert(stations_.end(), stations.begin(), stations.begin() + static_cast<std::ptrdiff_t>(count));
  graph_ = StationGraph(around_, stations_.size());
  std::vector<Vec3> positions;
  for (const PlacedStation& station : stations_) positions.push_back(station.position);
  graph_.exclude_nearer(positions, nearest_m_);
  return count == stations.size();
}

std::vector<PlacedStation> positions_around(const PlacementOracle& site, std::span<const PlacedStation> stations,
                                            std::size_t each, double radius_m) {
  // Sunflower seeds: each is turned on by the golden angle and has an equal share of the disc (Vogel: A Better Way to
  // Construct the Sunflower Head, 1979).
  const double golden = 2 * std::numbers::pi * (2 - std::numbers::phi);
  std::vector<PlacedStation> found;
  for (const PlacedStation& station : stations) {
    for (std::size_t k = 0; k < each; ++k) {
      const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(each);
      const double away = radius_m * std::sqrt(share), turn = golden * static_cast<double>(k);
      const auto uv = site.project(station.ground + Vec3{away * std::cos(turn), away * std::sin(turn), 0});
      if (!uv) continue;
      PlacedStation placed = place_station(site, *uv, site.height_m);
      placed.setup = station.setup;
      // Excludes the floor below, where a station would see everything else.
      if (placed.status == StationStatus::ok && std::abs(placed.ground.z - station.ground.z) <= radius_m)
        found.push_back(placed);
    }
  }
  return found;
}

}  // namespace vantage
