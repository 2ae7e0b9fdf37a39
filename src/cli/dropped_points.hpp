// SPDX-License-Identifier: Apache-2.0
// Number of points beyond a limit, and which limits.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "vantage/vantage.hpp"

namespace vantage::cli {

nlohmann::json dropped_json(const DroppedPoints& dropped);
// One line, with shares of the points in surveyed voxels. REQUIRES: counts.dropped is not empty.
std::string dropped_text(const NetworkCounts& counts);

}  // namespace vantage::cli
