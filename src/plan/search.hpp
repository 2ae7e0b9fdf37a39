// SPDX-License-Identifier: Apache-2.0
// The search loop: asks the optimiser for networks, evaluates them, tells it their values, and keeps history and
// checkpoint, until the optimiser has enough or somebody stops it.
#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "plan/decision_space.hpp"
#include "plan/measures.hpp"
#include "plan/search_evaluator.hpp"

namespace vantage {

struct SearchSetup {
  const DecisionSpace& space;
  const SurveyProblem& problem;
  const Measures& measures;
  const PlanConfig& config;
  SearchEvaluator& evaluator;
  std::size_t batch = 1;  // offspring at once in the steady state
  std::string identity = {};
  // A network to begin with that is evaluated as it stands, so that no front is worse; empty: what `config` says.
  std::vector<double> start = {};
  std::function<void(const PlanProgress&)> watch = {};
  // Called where a checkpoint cannot be written, or is damaged, and the search goes on without. If empty, one that
  // cannot be written is an Error.
  std::function<void(const std::string&)> warn = {};
  std::stop_token stop = {};
};

struct SearchOutcome {
  // The whole archive where it is evaluated again (SearchEvaluator::archive): every ray then chooses the front.
  std::vector<ParetoPoint> front;
  SearchEstimates estimates = {};  // of each, by all its samples together; empty where there was one
  VoxelWindow sample = {};         // by which it is reported; no voxels: every ray
  std::vector<PlanIteration> history;
  double hypervolume = 0;
  std::uint64_t evaluations = 0, resumed_evaluations = 0;
  std::uint64_t drawn = 0, redrawn = 0;
  StopReason stop_reason = StopReason::running;
  double seconds = 0, trace_seconds = 0;
};

SearchOutcome search(const SearchSetup& setup);

}  // namespace vantage
