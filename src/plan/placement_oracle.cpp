// SPDX-License-Identifier: Apache-2.0
#include "plan/placement_oracle.hpp"

#include <string>

#include "vantage/error.hpp"

namespace vantage {

PlacedStation place_station(const PlacementOracle& oracle, Uv uv, double height_m) {
  PlacedStation station{.uv = uv, .position = {}, .status = StationStatus::hole};
  const std::optional<Vec3> ground = oracle.locate(uv);
  if (!ground) return station;
  station.position = *ground + Vec3{0, 0, height_m};
  station.ground = *ground;
  station.status = oracle.clashes(*ground, height_m) ? StationStatus::clash : StationStatus::ok;
  return station;
}

std::vector<PlacedStation> existing_stations(const PlacementOracle& oracle, std::span<const Vec3> heads,
                                             std::span<const StationSetup> setups) {
  if (!setups.empty() && setups.size() != heads.size())
    throw Error(Errc::invalid_argument, "existing stations: " + std::to_string(heads.size()) + " heads and " +
                                            std::to_string(setups.size()) + " setups; one each, or none");
  std::vector<PlacedStation> existing;
  for (std::size_t k = 0; k < heads.size(); ++k) {
    existing.push_back(oracle.check_head(heads[k]));
    existing.back().kept = true;
    if (!setups.empty()) existing.back().setup = setups[k];
  }
  return existing;
}

std::size_t visibility_parts(const PlacementOracle& oracle, const Network& network) {
  OverlapMatrix seen(network.size());
  for (std::size_t i = 0; i < network.size(); ++i) {
    for (std::size_t j = i + 1; j < network.size(); ++j) {
      if (!network[i].active || !network[j].active) continue;
      const Vec3 &a = network[i].position, &b = network[j].position;
      if (dot(a - b, a - b) <= oracle.range_m * oracle.range_m && oracle.sees(a, b)) seen.set(i, j, 1);
    }
  }
  return connectivity(seen, 1).parts;
}

Network to_network(std::span<const PlacedStation> stations) {
  Network network;
  network.reserve(stations.size());
  for (const PlacedStation& station : stations)
    network.push_back({.position = station.position, .active = active(station), .setup = station.setup});
  return network;
}

}  // namespace vantage
