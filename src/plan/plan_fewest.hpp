// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plan/run.hpp"

namespace vantage {

// plan() for problems that ask for the fewest stations. `run` has been asked the problem; the candidates took so long.
PlanResult plan_fewest(Run& run, Simulator& simulator, std::shared_ptr<const Candidates> candidates,
                       double candidates_seconds, const PlanConfig& config, const PlanWatch& watch);

}  // namespace vantage
