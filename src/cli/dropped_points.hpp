// SPDX-License-Identifier: Apache-2.0
// How many points were not good enough to count, and why.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "vantage/vantage.hpp"

namespace vantage::cli {

nlohmann::json dropped_json(const DroppedPoints& dropped);
// One line, as shares of the points in surveyed voxels. REQUIRES: counts.dropped is not empty.
std::string dropped_text(const NetworkCounts& counts);

}  // namespace vantage::cli
