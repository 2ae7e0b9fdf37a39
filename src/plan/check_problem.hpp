// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vantage/planner.hpp"

namespace vantage {

// Throws Error invalid_argument for a value of the problem that is out of its range, and for a position that is not in
// reach of the site.
void check_problem(const Site& site, const SurveyProblem& problem);
// The same for the settings of a search.
void check_search(const Site& site, const PlanConfig& config);

}  // namespace vantage
