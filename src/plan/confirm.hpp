// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "search/search.hpp"
#include "vantage/planner.hpp"

namespace vantage {

// Options with which a plan evaluates its networks, except for registration.
EvaluationOptions evaluation_options(const SurveyProblem& problem);

struct ConfirmedFront {
  std::vector<PlanEntry> entries;
  std::size_t spared = 0;  // networks without entries: others are better by more than the standard errors allow
};

// The front as entries, best first: values of the search with standard errors, and the exact values.
ConfirmedFront confirm_front(const SearchOutcome& found, const DecisionSpace& space, const SurveyProblem& problem,
                             const Measures& measures, std::uint64_t sample_voxels, NetworkEvaluator& evaluator,
                             const PlanWatch& watch);

// Drops entries dominated by another, and all but the first of equal ones, by exact values, or by known values if a
// confirmation was cut short.
void keep_undominated(std::vector<PlanEntry>& entries, const SurveyProblem& problem, const Measures& measures);

// Sets the violation of each entry by its exact values, and marks dominated ones. Returns the hypervolume of the exact
// values, NaN unless all entries are confirmed.
double judge_by_every_ray(std::vector<PlanEntry>& entries, const SurveyProblem& problem, const Measures& measures);

}  // namespace vantage
