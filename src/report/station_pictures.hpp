// SPDX-License-Identifier: Apache-2.0
// What stations see, as small pictures for a report.
#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "vantage/placement.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

// A JPEG a station, all around with the middle of the site in its middle; smaller ones where there are many stations,
// so that all together stay within 1.2 MB and take about the same time. Empty for a station without a place, and for
// all where they were stopped, or cannot be made: the simulator's configuration is warned then.
std::vector<std::vector<std::uint8_t>> station_pictures(const Simulator& simulator,
                                                        std::span<const PlacedStation> stations, std::stop_token stop);

}  // namespace vantage
