// SPDX-License-Identifier: Apache-2.0
// Removes networks from a front that are no useful plans beside others.
#pragma once

#include <cstddef>
#include <vector>

#include "vantage/planner.hpp"

namespace vantage {

bool same_places(const PlanEntry& a, const PlanEntry& b);

// Removes networks with a station, after the `kept` ones, that found no allowed position, if there are others.
void drop_unplaced(std::vector<PlanEntry>& entries, std::size_t kept);

// Removes networks that repeat another's positions. If some networks keep their stations apart and on allowed ground,
// removes those that do not. The problems of the method, by name, keep their fronts unchanged.
void drop_networks(std::vector<PlanEntry>& front, const SurveyProblem& problem);

}  // namespace vantage
