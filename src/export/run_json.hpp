// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "vantage/planner.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

// See run_parameters_json(). Equal runs give equal objects: nothing here depends on time or on file names.
nlohmann::ordered_json run_parameters(const Simulator& simulator, const PlanResult* result);

}  // namespace vantage
