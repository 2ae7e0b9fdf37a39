// SPDX-License-Identifier: Apache-2.0
// The fewest stations, second half: where. Sets up the search from the chosen network.
#pragma once

#include <cstddef>
#include <cstdint>

#include "plan/fewest_choice.hpp"

namespace vantage {

// Rounds of refinement around the chosen stations.
inline constexpr std::size_t kRounds = 3;

// Raises lower limits by the known errors of the search's sample. `overstated`: excess of the sampled coverage of the
// initial network.
SurveyProblem with_margins(SurveyProblem problem, const FewestAsked& asked, double overstated, double link_margin);

// Returns a configuration with small first steps. If it has no number of iterations, it gets one that limits the
// stations that the search traces for each traced candidate.
PlanConfig refining_config(const SurveyProblem& problem, PlanConfig config, std::size_t candidates);

// True if the search evaluates enough networks for each coordinate, and has something to trade. With fewer it learns no
// direction, and the initial network stays the best. If the number of stations is the one that pays, its capture is
// required too: the search could only give up capture, within the margins of that limit.
bool worth_searching(const SurveyProblem& problem, const PlanConfig& config);

}  // namespace vantage
