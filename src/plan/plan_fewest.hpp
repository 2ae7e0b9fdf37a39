// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plan/plan_context.hpp"
#include "vantage/candidates.hpp"

namespace vantage {

// plan() for problems that ask for the fewest stations. `context` has been asked the problem.
PlanResult plan_fewest(PlanContext& context, Simulator& simulator, std::shared_ptr<const Candidates> candidates,
                       const PlanConfig& config, const PlanWatch& watch);

}  // namespace vantage
