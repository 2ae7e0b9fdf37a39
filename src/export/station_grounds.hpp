// SPDX-License-Identifier: Apache-2.0
// What all files for the crew ask of stations.
#pragma once

#include <string>
#include <vector>

#include "vantage/error.hpp"
#include "vantage/station_files.hpp"

namespace vantage {

// Whether there is a place to go to.
inline bool has_ground(const PlacedStation& station) { return station.status != StationStatus::hole; }

// The places of those that have one, in order. Throws Error invalid_argument where names are missing.
inline std::vector<Vec3> grounds_of(const NamedStations& named) {
  if (named.names.size() != named.stations.size())
    throw Error(Errc::invalid_argument, std::to_string(named.stations.size()) + " stations, but " +
                                            std::to_string(named.names.size()) + " names");
  std::vector<Vec3> grounds;
  for (const PlacedStation& station : named.stations)
    if (has_ground(station)) grounds.push_back(station.ground);
  return grounds;
}

}  // namespace vantage
