// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "evaluate/evaluator.hpp"

namespace vantage {

// What the scans of a network hold, besides those of existing stations: their points as every ray counted them, or by
// the share of the surroundings' rays that meet something. Empty if neither was counted.
std::optional<ScanData> scan_data(const CountedNetwork& network, const Simulator& simulator,
                                  const Simulator* surroundings);

}  // namespace vantage
