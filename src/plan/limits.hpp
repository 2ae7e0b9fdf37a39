// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "vantage/planner.hpp"

namespace vantage {

// The strictest limit of a kind from one side; limits on coverage in units of coverage, even if given as a share.
inline std::optional<double> limit_of(const SurveyProblem& problem, Objective::Kind kind, Requirement::Bound bound) {
  std::optional<double> limit;
  for (const Requirement& r : problem.requirements) {
    if (r.objective.kind != kind || r.bound != bound) continue;
    const double own = kind == Objective::Kind::coverage ? r.limit * r.objective.coverage_of_one : r.limit;
    const double here = limit.value_or(own);
    limit = bound == Requirement::Bound::at_least ? std::max(here, own) : std::min(here, own);
  }
  return limit;
}

// A share rounded down, with digits that a surveyor reads.
inline double rounded_down(double share) {
  constexpr double kDigits = 1000;
  return std::floor(share * kDigits) / kDigits;
}

// Tells whether a requirement says how much of what is attainable has to be captured.
inline bool requires_capture(const Requirement& r) {
  return r.objective.kind == Objective::Kind::coverage && r.objective.needs.attainable &&
         r.bound == Requirement::Bound::at_least;
}

}  // namespace vantage
