// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "vantage/simulator.hpp"

namespace vantage {

// Number of connected components of the graph of stations that see each other within range. A skipped station is one of
// its own. `sees`: whether nothing stands between two heads.
std::size_t visibility_parts(const std::function<bool(const Vec3&, const Vec3&)>& sees, double range_m,
                             const Network& network);

}  // namespace vantage
