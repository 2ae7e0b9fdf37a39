// SPDX-License-Identifier: Apache-2.0
// Views of the stations, as small pictures for a report.
#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "vantage/placement.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

// Returns a JPEG for each station, all around, with the middle of the site in its centre. Many stations get smaller
// ones, so that all together stay within 1.2 MB and take about the same time. Empty for a station without a place; all
// are empty if stopped or impossible, with a warning by the simulator's configuration.
std::vector<std::vector<std::uint8_t>> station_pictures(const Simulator& simulator,
                                                        std::span<const PlacedStation> stations, std::stop_token stop);

}  // namespace vantage
