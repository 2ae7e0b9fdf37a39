// SPDX-License-Identifier: Apache-2.0
#include "plan/site.hpp"

namespace vantage {

PlacedStation place_station(const Site& site, Uv uv, double height_m) {
  PlacedStation station{.uv = uv, .position = {}, .status = StationStatus::hole};
  const std::optional<Vec3> ground = site.locate(uv);
  if (!ground) return station;
  station.position = *ground + Vec3{0, 0, height_m};
  station.status = site.clashes(*ground) ? StationStatus::clash : StationStatus::ok;
  return station;
}

Network to_network(std::span<const PlacedStation> stations) {
  Network network;
  network.reserve(stations.size());
  for (const PlacedStation& station : stations)
    network.push_back({.position = station.position, .active = station.status == StationStatus::ok});
  return network;
}

}  // namespace vantage
