// SPDX-License-Identifier: Apache-2.0
// Measures of each network in a run, once by name: objectives, then those of requirements, then those always reported.
// The search evaluates the first `searched` of them.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "vantage/problem.hpp"

namespace vantage {

struct Measures {
  std::vector<Objective> all;
  std::size_t searched = 0;
  std::vector<std::size_t> required;  // index in `all` of each requirement's objective

  RequiredInputs searched_needs() const;
  RequiredInputs all_needs() const;
};

// Throws Error invalid_argument: no objective, one without name or value, two different ones of one name.
Measures measures_of(const SurveyProblem& problem);

// True if an objective or a requirement needs this input.
bool asks_for(const SurveyProblem& problem, bool RequiredInputs::*input);
// True if an objective or a requirement is a share of what is attainable.
bool needs_attainable(const SurveyProblem& problem);
// Patterns of the meshes that such shares are of.
std::vector<std::string> meshes_asked_for(const SurveyProblem& problem);

// Sum of violations; 0 if all requirements are met. `values`: of the measures.
double missed_by(const SurveyProblem& problem, const Measures& measures, std::span<const double> values);

}  // namespace vantage
