// SPDX-License-Identifier: Apache-2.0
#include "plan/site.hpp"

#include <string>

#include "vantage/error.hpp"

namespace vantage {

PlacedStation place_station(const Site& site, Uv uv, double height_m) {
  PlacedStation station{.uv = uv, .position = {}, .status = StationStatus::hole};
  const std::optional<Vec3> ground = site.locate(uv);
  if (!ground) return station;
  station.position = *ground + Vec3{0, 0, height_m};
  station.ground = *ground;
  station.status = site.clashes(*ground, height_m) ? StationStatus::clash : StationStatus::ok;
  return station;
}

std::vector<PlacedStation> kept_stations(const Site& site, std::span<const Vec3> heads,
                                         std::span<const StationSetup> setups) {
  if (!setups.empty() && setups.size() != heads.size())
    throw Error(Errc::invalid_argument, "kept stations: " + std::to_string(heads.size()) + " heads and " +
                                            std::to_string(setups.size()) + " setups; one each, or none");
  std::vector<PlacedStation> kept;
  for (std::size_t k = 0; k < heads.size(); ++k) {
    kept.push_back(site.check_head(heads[k]));
    kept.back().kept = true;
    if (!setups.empty()) kept.back().setup = setups[k];
  }
  return kept;
}

std::size_t visibility_parts(const Site& site, const Network& network) {
  OverlapMatrix seen(network.size());
  for (std::size_t i = 0; i < network.size(); ++i) {
    for (std::size_t j = i + 1; j < network.size(); ++j) {
      if (!network[i].active || !network[j].active) continue;
      const Vec3 &a = network[i].position, &b = network[j].position;
      if (dot(a - b, a - b) <= site.range_m * site.range_m && site.sees(a, b)) seen.set(i, j, 1);
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
