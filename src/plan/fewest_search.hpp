// SPDX-License-Identifier: Apache-2.0
// The fewest stations, second half: where. Sets up the search from the chosen network.
#pragma once

#include <cstddef>
#include <cstdint>

#include "plan/fewest_choice.hpp"

namespace vantage {

// Rounds of refinement around the chosen stations.
inline constexpr std::size_t kRounds = 3;

// Requirements moved further from their limits by what is known of the sample of the search: by how much it overstates
// the coverage of the network it begins at.
SurveyProblem with_margins(SurveyProblem problem, const FewestAsked& asked, double overstated, double link_margin);

// Small first steps. If no number of iterations is given, it limits the stations that the search traces for each traced
// candidate.
PlanConfig refining_config(const SurveyProblem& problem, PlanConfig config, std::size_t candidates);

// True if the search tries some networks for each coordinate, and has something to trade. With fewer it cannot tell
// directions apart, and the network it begins at stays the best. Where all that so many stations can capture is
// required, it can only give up capture, within the margins of that limit.
bool worth_searching(const SurveyProblem& problem, const PlanConfig& config);

}  // namespace vantage
