// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "evaluate/evaluator.hpp"

namespace vantage {

// Returns the data in a network's scans, without existing stations: points as every ray counted them, or estimated from
// the share of the surroundings' rays that hit. Empty if neither was counted.
std::optional<ScanData> scan_data(const CountedNetwork& network, const Simulator& simulator,
                                  const Simulator* surroundings);

}  // namespace vantage
