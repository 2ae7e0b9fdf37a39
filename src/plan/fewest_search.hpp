// SPDX-License-Identifier: Apache-2.0
// The fewest stations, second half: where. Sets up the search from the chosen network, and predicts its time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "plan/fewest_choice.hpp"
#include "plan/network_evaluator.hpp"

namespace vantage {

// Rounds of refinement around the chosen stations.
inline constexpr std::size_t kRounds = 3;

// Requirements moved further from their limits by what is known of the sample of the search: by how much it overstates
// the coverage of the network it begins at.
SurveyProblem with_margins(SurveyProblem problem, const FewestAsked& asked, double overstated, double link_margin);

// Small first steps. If no number of iterations is given, it limits the stations that the search traces for each traced
// candidate.
PlanConfig refining_config(const SurveyProblem& problem, PlanConfig config, std::size_t candidates);

// Whether the search tries as many networks as there are stations at least. With fewer it cannot tell directions apart,
// and the network it begins at stays the best.
bool worth_searching(const SurveyProblem& problem, const PlanConfig& config);

// `round_s`: what a round of refinement took. Seconds that all the rest will take, from the first round of refinement
// on: further rounds, the search by `config`, and every ray. Times the evaluator on the chosen network. Empty where it
// was stopped, or there are so many stations that this would take long.
std::optional<double> expected_seconds(const FewestChoice& choice, const SurveyProblem& problem,
                                       const PlanConfig& config, NetworkEvaluator& evaluator, double round_s,
                                       const PlanWatch& watch);

}  // namespace vantage
