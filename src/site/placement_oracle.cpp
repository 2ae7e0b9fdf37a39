// SPDX-License-Identifier: Apache-2.0
#include "site/placement_oracle.hpp"

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
    existing.back().existing = true;
    if (!setups.empty()) existing.back().setup = setups[k];
  }
  return existing;
}

}  // namespace vantage
