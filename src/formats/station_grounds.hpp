// SPDX-License-Identifier: Apache-2.0
// Helpers of all files for the crew.
#pragma once

#include <string>
#include <vector>

#include "formats/station_files.hpp"
#include "vantage/error.hpp"

namespace vantage {

// True if the station has a place to go to.
inline bool has_ground(const PlacedStation& station) { return station.status != StationStatus::hole; }

// Grounds of the stations that have one, in order. Throws Error invalid_argument if names are missing.
inline std::vector<Vec3> grounds_of(const NamedStations& named) {
  if (named.names.size() != named.stations.size())
    throw Error(Errc::invalid_argument, std::to_string(named.stations.size()) + " stations, but " +
                                            std::to_string(named.names.size()) + " names");
  std::vector<Vec3> grounds;
  for (const PlacedStation& station : named.stations)
    if (has_ground(station)) grounds.push_back(station.ground);
  return grounds;
}

inline std::vector<Vec3> centres_of(const NamedStations& named) {
  std::vector<Vec3> centres;
  for (const Target& target : named.targets) centres.push_back(target.centre);
  return centres;
}

inline const char* kind_of(const Target& target) { return target.control_m > 0 ? "control point" : "target"; }

}  // namespace vantage
