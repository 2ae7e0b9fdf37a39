// SPDX-License-Identifier: Apache-2.0
// Chooses the optimiser of a problem.
#pragma once

#include <memory>

#include "search/decision_space.hpp"
#include "vantage/optimiser.hpp"

namespace vantage {

// Never 0.
std::size_t population_of(const SurveyProblem& problem, const PlanConfig& config);

// With the limits of `config` except those of time. Borrows the space. `batch`: see PlanConfig. `start`: replaces the
// start of `config`; may be empty.
std::unique_ptr<Optimiser> choose_optimiser(const DecisionSpace& space, const SurveyProblem& problem,
                                            const PlanConfig& config, std::size_t batch,
                                            const std::vector<double>& start = {});

}  // namespace vantage
