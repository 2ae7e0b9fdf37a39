// SPDX-License-Identifier: Apache-2.0
// The search loop: asks the optimiser for networks, evaluates them and tells it their values. It keeps history and
// checkpoint, until a stop rule holds or it is stopped.
#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "search/decision_space.hpp"
#include "search/measures.hpp"
#include "search/search_evaluator.hpp"

namespace vantage {

struct SearchSetup {
  const DecisionSpace& space;
  const SurveyProblem& problem;
  const Measures& measures;
  const PlanConfig& config;
  SearchEvaluator& evaluator;
  std::size_t batch = 1;  // offspring at once in the steady state
  std::string identity = {};
  // First network, evaluated unchanged, so that no front is worse; empty: that of `config`.
  std::vector<double> start = {};
  std::function<void(const PlanProgress&)> watch = {};
  // Called if a checkpoint cannot be written, or is damaged, and the search goes on without it. If empty, failure to
  // write is an Error.
  std::function<void(const std::string&)> warn = {};
  std::stop_token stop = {};
};

struct SearchOutcome {
  // The whole archive if it is re-evaluated (SearchEvaluator::archive): every ray then chooses the front.
  std::vector<ParetoPoint> front;
  SearchEstimates estimates = {};  // of each, by all its samples together; empty if there was one
  VoxelWindow sample = {};         // the voxels that `front` and `estimates` are of; none: every ray
  std::vector<PlanIteration> history;
  double hypervolume = 0;
  std::uint64_t evaluations = 0, resumed_evaluations = 0;
  std::uint64_t drawn = 0, redrawn = 0;
  StopReason stop_reason = StopReason::running;
  double seconds = 0, trace_seconds = 0;
};

SearchOutcome search(const SearchSetup& setup);

// Takes a network out of the front.
void drop_point(SearchOutcome& found, std::size_t k);

}  // namespace vantage
