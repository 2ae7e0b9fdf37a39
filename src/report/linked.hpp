// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vantage/planner.hpp"

namespace vantage {

// Whether all stations are known to hang together.
inline bool linked(const PlanEntry& entry, const PlanConfig& config) {
  return entry.confirmed && connectivity(entry.exact_overlap_matrix, link_overlap(config)).parts == 1;
}

}  // namespace vantage
