// SPDX-License-Identifier: Apache-2.0
// The fewest stations, second half: where. Sets up the search from the chosen network, and predicts its time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "plan/fewest_choice.hpp"
#include "plan/network_evaluator.hpp"

namespace vantage {

// Rounds of refinement around the chosen stations, and the size of the sample after them, in multiples of the first.
inline constexpr std::size_t kRounds = 3;
inline constexpr std::uint64_t kLargerSample = 5;

// Moves requirements away from their limits by the known error of the search's sample: the overstatement of the
// coverage of its first network.
SurveyProblem with_margins(SurveyProblem problem, double overstated, double link_margin);

// Small first steps. If no number of iterations is given, it limits the stations that the search traces for each traced
// candidate.
PlanConfig refining_config(const SurveyProblem& problem, PlanConfig config, std::size_t candidates);

// Durations of the first stages.
struct StageTimes {
  double look_s = 0;               // of a station on the sample
  double station_s = 0;            // of a station of the table, with the surroundings
  double round_s = 0;              // of a round of refinement around the chosen stations
  std::size_t round_stations = 0;  // traced in that round
};

// Predicted seconds of the rest, from the first round of refinement on: further rounds, the larger sample, the search
// by `config`, and every ray. Times the evaluator on the chosen network. Empty if stopped.
std::optional<double> expected_seconds(const FewestChoice& choice, const SurveyProblem& problem,
                                       const PlanConfig& config, NetworkEvaluator& evaluator, const StageTimes& times,
                                       const PlanWatch& watch);

}  // namespace vantage
