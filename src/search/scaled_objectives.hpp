// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "vantage/problem.hpp"

namespace vantage {

// Writes scaled_objectives() to `f`; with a violation `missed` above 0, behind all feasible ones.
void scale_objectives(const SurveyProblem& problem, std::span<const double> x, std::span<const double> values,
                      double missed, std::span<double> f);

}  // namespace vantage
