// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plan/plan_context.hpp"
#include "vantage/progress.hpp"

namespace vantage {

// Gives the networks of a plan whatever is known only once all are confirmed: shares of what they and the candidates
// can capture together, names, rounds on site, the answer's targets, and its place in the trade-off. A stop leaves out
// what takes rays, and the rounds of networks other than the answer.
void complete_front(PlanResult& result, PlanContext& context, Site& site, const Progress& progress);

}  // namespace vantage
