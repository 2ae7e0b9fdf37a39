// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <string_view>

#include "vantage/planner.hpp"

namespace vantage {

// The strictest limit that is required of an objective from one side.
inline std::optional<double> limit_of(const SurveyProblem& problem, std::string_view name, Requirement::Bound bound) {
  std::optional<double> limit;
  for (const Requirement& r : problem.requirements) {
    if (r.objective.name != name || r.bound != bound) continue;
    const double here = limit.value_or(r.limit);
    limit = bound == Requirement::Bound::at_least ? std::max(here, r.limit) : std::min(here, r.limit);
  }
  return limit;
}

}  // namespace vantage
