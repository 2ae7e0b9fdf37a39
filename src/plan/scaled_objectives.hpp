// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "vantage/planner.hpp"

namespace vantage {

// scaled_objectives() into `f`; with requirements that are missed by `missed` above 0, behind all that keep them.
void scale_objectives(const SurveyProblem& problem, std::span<const double> x, std::span<const double> values,
                      double missed, std::span<double> f);

}  // namespace vantage
