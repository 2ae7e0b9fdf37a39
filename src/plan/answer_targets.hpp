// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "search/measures.hpp"
#include "vantage/planner.hpp"
#include "vantage/progress.hpp"
#include "vantage/site.hpp"

namespace vantage {

// Gives the answer its existing targets and those that the problem has proposed, and predicts its registration with
// and without them. Leaves a plan without either as it is, and one that is stopped meanwhile. Takes every ray once.
void add_targets(PlanResult& result, Site& site, const Measures& measures, const Progress& progress);

}  // namespace vantage
