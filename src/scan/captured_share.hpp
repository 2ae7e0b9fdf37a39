// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "vantage/simulator.hpp"

namespace vantage {

// Returns the share of a voxel's goal that this many points reach; 1 if it has its goal.
inline double captured_share(const Simulator& simulator, std::uint32_t voxel, std::uint32_t points) {
  return std::min(points / simulator.goal_density(voxel), 1.0);
}

}  // namespace vantage
