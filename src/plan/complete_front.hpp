// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plan/plan_context.hpp"
#include "vantage/progress.hpp"

namespace vantage {

// Fills in what is known only once all networks of a plan are confirmed: shares of attainable coverage, names, rounds
// on site, the answer's targets, and its place in the trade-off. A stop leaves out what takes rays, and the rounds of
// networks other than the answer.
void complete_front(PlanResult& result, PlanContext& context, Site& site, const Progress& progress);

}  // namespace vantage
