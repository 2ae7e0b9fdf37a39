// SPDX-License-Identifier: Apache-2.0
// The optimiser that suits a problem.
#pragma once

#include <memory>

#include "plan/decision_space.hpp"
#include "vantage/optimiser.hpp"

namespace vantage {

// Never 0.
std::size_t population_of(const SurveyProblem& problem, const PlanConfig& config);

// With the limits of `config`, but for those of time. Borrows the space. `batch`: see PlanConfig. `start`: where to
// begin in place of what `config` says; may be empty.
std::unique_ptr<Optimiser> choose_optimiser(const DecisionSpace& space, const SurveyProblem& problem,
                                            const PlanConfig& config, std::size_t batch,
                                            const std::vector<double>& start = {});

}  // namespace vantage
