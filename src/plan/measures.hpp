// SPDX-License-Identifier: Apache-2.0
// What a run measures of each network, once by name: the objectives, then what requirements bound, then what is always
// told. The search asks for the first `searched` of them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "vantage/planner.hpp"

namespace vantage {

struct Measures {
  std::vector<Objective> all;
  std::size_t searched = 0;
  std::vector<std::size_t> required;  // where each requirement's objective stands in `all`

  RequiredInputs searched_needs() const;
  RequiredInputs all_needs() const;
};

// Throws Error invalid_argument: no objective, one without name or value, two different ones of one name.
Measures measures_of(const SurveyProblem& problem);

// By how much the requirements are missed in all; 0 where they are kept. `values`: of the measures.
double missed_by(const SurveyProblem& problem, const Measures& measures, std::span<const double> values);

}  // namespace vantage
