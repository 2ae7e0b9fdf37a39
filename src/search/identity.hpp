// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "vantage/problem.hpp"

namespace vantage {

// Lines "name = value" of everything that decides the bits of a search. Two runs with the same text may share a
// checkpoint.
std::string identity(Site& site, const SurveyProblem& problem, const PlanConfig& config, std::size_t population,
                     std::size_t batch);

}  // namespace vantage
