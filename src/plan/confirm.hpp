// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <stop_token>
#include <vector>

#include "plan/search.hpp"

namespace vantage {

// The front as entries, by falling coverage: what the search saw with its standard errors, and beside it the exact
// values.
std::vector<PlanEntry> confirm_front(const SearchOutcome& found, const DecisionSpace& space, const PlanConfig& config,
                                     NetworkEvaluator& evaluator, const std::function<void(const PlanProgress&)>& watch,
                                     std::stop_token abort);

// Marks entries that another's exact values dominate. Returns the hypervolume of the exact values (the best of them
// where there is one objective), NaN unless all entries are confirmed.
double judge_by_every_ray(std::vector<PlanEntry>& entries, const DecisionSpace& space, const PlanConfig& config);

}  // namespace vantage
