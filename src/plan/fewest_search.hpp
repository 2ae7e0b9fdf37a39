// SPDX-License-Identifier: Apache-2.0
// The fewest stations, second half: where. What is asked of the search that begins at the chosen network, and how long
// it will take.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "plan/fewest_choice.hpp"
#include "plan/network_evaluator.hpp"

namespace vantage {

// Rounds of refinement around the chosen stations, and how many times as large the sample after them is.
inline constexpr std::size_t kRounds = 3;
inline constexpr std::uint64_t kLargerSample = 5;

// Requirements moved further from their limits by what is known of the sample of the search: by how much it overstates
// the coverage of the network it begins at.
SurveyProblem with_margins(SurveyProblem problem, double overstated, double link_margin);

// Small first steps, and where no number of iterations is given, as many as let the search trace so many stations for
// each candidate that was looked at.
PlanConfig refining_config(const SurveyProblem& problem, PlanConfig config, std::size_t candidates);

// What the first stages took.
struct StageTimes {
  double look_s = 0;               // a station on the sample
  double station_s = 0;            // a station of the table: with the surroundings
  double round_s = 0;              // a round of refinement around the chosen stations
  std::size_t round_stations = 0;  // traced in that round
};

// Seconds that all the rest will take, from the first round of refinement on: further rounds, the larger sample, the
// search by `config`, and every ray. Times the evaluator on the chosen network. Empty where it was stopped.
std::optional<double> expected_seconds(const FewestChoice& choice, const SurveyProblem& problem,
                                       const PlanConfig& config, NetworkEvaluator& evaluator, const StageTimes& times,
                                       const PlanWatch& watch);

}  // namespace vantage
