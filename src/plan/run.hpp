// SPDX-License-Identifier: Apache-2.0
// What judging networks of a site takes, made once for all the searches of a plan: surroundings, ways, an evaluator.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "plan/confirm.hpp"
#include "plan/search.hpp"
#include "plan/simulator_evaluator.hpp"
#include "plan/site.hpp"

namespace vantage {

class Run {
 public:
  // Borrows all. The problem is settled: its `capture` knows what can be seen.
  Run(Simulator& simulator, const SearchArea& area, const ClashChecker& clash, const PlanConfig& config);

  // Networks are judged by this problem's measures from now on.
  void ask(const SurveyProblem& problem);
  const SurveyProblem& problem() const { return problem_; }
  const Measures& measures() const { return measures_; }
  const Site& site() const { return site_; }
  const SearchArea& area() const { return area_; }
  SimulatorEvaluator& evaluator() { return *evaluator_; }
  // Made when first needed.
  Simulator& surroundings();
  const OnSite& on_site();
  std::uint64_t surroundings_voxels() const;

  // With the asked problem narrowed to so many stations, other limits, or left as it is.
  SearchOutcome search(const SurveyProblem& narrowed, const PlanConfig& config, const std::vector<double>& start,
                       const PlanWatch& watch);
  ConfirmedFront confirm(const SearchOutcome& found, const SurveyProblem& narrowed, const PlanWatch& watch);
  // Everything of a result but its front, as found.
  PlanResult result(const SearchOutcome& found) const;

 private:
  Simulator& simulator_;
  const SearchArea& area_;
  const ClashChecker& clash_;
  const PlanConfig& config_;
  Site site_;
  SurveyProblem problem_;
  Measures measures_;
  std::unique_ptr<Simulator> surroundings_;
  std::optional<OnSite> on_site_;
  std::optional<SimulatorEvaluator> evaluator_;
};

// Offspring at once in the steady state.
std::size_t batch_of(const Simulator& simulator, const PlanConfig& config);

}  // namespace vantage
