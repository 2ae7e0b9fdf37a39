// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "plan/search.hpp"

namespace vantage {

struct ConfirmedFront {
  std::vector<PlanEntry> entries;
  std::size_t spared = 0;  // networks that are no entries: others are better by more than their standard errors allow
};

// The front as entries, best first: what the search saw with its standard errors, and beside it the exact values.
ConfirmedFront confirm_front(const SearchOutcome& found, const DecisionSpace& space, const SurveyProblem& problem,
                             const Measures& measures, std::uint64_t sample_voxels, NetworkEvaluator& evaluator,
                             const PlanWatch& watch);

// Drops those that another's values dominate, and all but the first of equals: exact values, or where a confirmation
// was cut short what is known.
void keep_undominated(std::vector<PlanEntry>& entries, const SurveyProblem& problem, const Measures& measures);

// Says of entries by how much their exact values miss the requirements, and marks those that another's dominate.
// Returns the hypervolume of the exact values, NaN unless all entries are confirmed.
double judge_by_every_ray(std::vector<PlanEntry>& entries, const SurveyProblem& problem, const Measures& measures);

}  // namespace vantage
