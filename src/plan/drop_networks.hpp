// SPDX-License-Identifier: Apache-2.0
// Networks that are no plan beside others: they are not shown.
#pragma once

#include <cstddef>
#include <vector>

#include "vantage/planner.hpp"

namespace vantage {

bool same_places(const PlanEntry& a, const PlanEntry& b);

// Those with a station that found nowhere to stand, after the `kept` ones, where there are others.
void drop_unplaced(std::vector<PlanEntry>& entries, std::size_t kept);

// Those of a front that stand where another does, and, where any keeps its stations apart and on allowed ground, those
// that do not. The problems of the method, by name, keep their fronts as they are.
void drop_networks(std::vector<PlanEntry>& front, const SurveyProblem& problem);

}  // namespace vantage
