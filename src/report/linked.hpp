// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "vantage/planner.hpp"

namespace vantage {

// Whether all stations are known to hang together.
inline bool linked(const PlanEntry& entry, const PlanResult& result) {
  return entry.confirmed && connectivity(entry.exact_overlap_matrix, result.problem.link_overlap).parts == 1;
}

// Whether it is asked how scans overlap.
inline bool links_matter(const PlanResult& result) {
  return std::any_of(result.problem.objectives.begin(), result.problem.objectives.end(),
                     [](const Objective& objective) { return objective.needs.pairs; });
}

}  // namespace vantage
