// SPDX-License-Identifier: Apache-2.0
// The search loop: asks, draws stations out of holes, evaluates, tells, keeps the history and the checkpoint, and knows
// when to stop.
#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "plan/decision_space.hpp"
#include "plan/measures.hpp"
#include "plan/network_evaluator.hpp"

namespace vantage {

struct SearchSetup {
  const DecisionSpace& space;
  const SurveyProblem& problem;
  const Measures& measures;
  const PlanConfig& config;
  NetworkEvaluator& evaluator;
  std::size_t batch = 1;  // offspring at once in the steady state
  std::string identity = {};
  // A network to begin with that is evaluated as it stands, so that no front is worse; empty: what `config` says.
  std::vector<double> start = {};
  std::function<void(const PlanProgress&)> watch = {};
  // Told what the search goes on without: a checkpoint that cannot be written, or is damaged. Where nobody is told, one
  // that cannot be written is an Error.
  std::function<void(const std::string&)> warn = {};
  std::stop_token stop = {};
};

struct SearchOutcome {
  // Where the sample is drawn anew all that was kept: the front is chosen from it by every ray.
  std::vector<ParetoPoint> front;
  // Of each, of the measures that were searched, by all its samples together; empty where there was one.
  std::vector<std::vector<Estimate>> estimates = {};
  VoxelWindow sample = {};  // by which it is told; no voxels: every ray
  std::vector<PlanIteration> history;
  double hypervolume = 0;
  std::uint64_t evaluations = 0, resumed_evaluations = 0;
  std::uint64_t drawn = 0, redrawn = 0;
  StopReason stop_reason = StopReason::running;
  double seconds = 0, trace_seconds = 0;
};

SearchOutcome search(const SearchSetup& setup);

}  // namespace vantage
