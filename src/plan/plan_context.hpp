// SPDX-License-Identifier: Apache-2.0
// Shared parts of all searches of one plan: site, walking graph, evaluator.
#pragma once

#include <optional>
#include <vector>

#include "candidates/floor_units.hpp"
#include "plan/confirm.hpp"
#include "search/search.hpp"
#include "search/simulator_evaluator.hpp"
#include "site/placement_oracle.hpp"

namespace vantage {

class PlanContext {
 public:
  // Borrows site and configuration. `scanners`: those of the site to choose from.
  PlanContext(Site& site, const PlanConfig& config, std::vector<std::uint32_t> scanners);

  // Attainable counts that captured shares refer to: of choices among candidates, of searches on part of their voxels,
  // and of confirmed networks on other voxels. If a measure needs them, the caller sets them before ask().
  AttainableCounts chosen, searched, confirmed;
  // Both are set if the plan places the stations that pay.
  std::optional<UnitsToVisit> to_visit;
  std::optional<StationsThatPay> pays;
  double asked_capture = 0;  // by the problem, whatever pays

  // Uses this problem's measures from now on. REQUIRES: its `capture` is relative to what is attainable.
  void ask(const SurveyProblem& problem);
  const SurveyProblem& problem() const { return problem_; }
  const Measures& measures() const { return measures_; }
  const PlacementOracle& oracle() const { return oracle_; }
  const SearchArea& area() { return site_.area(); }
  SimulatorEvaluator& evaluator() { return *evaluator_; }
  Simulator& surroundings() { return site_.surroundings(); }
  const OnSite& on_site();                    // made at first use
  std::uint64_t surroundings_voxels() const;  // sample of all surfaces that evaluates networks
  std::uint64_t link_voxels() const;          // sample that decides links between candidates

  // Searches the present problem, perhaps narrowed to a number of stations or with other limits.
  SearchOutcome search(const SurveyProblem& narrowed, const PlanConfig& config, const std::vector<double>& start,
                       const PlanWatch& watch);
  ConfirmedFront confirm(const SearchOutcome& found, const SurveyProblem& narrowed, const PlanWatch& watch);
  // Returns the result without its front.
  PlanResult result(const SearchOutcome& found);

 private:
  Site& site_;
  Simulator& simulator_;
  const PlanConfig& config_;
  PlacementOracle oracle_;
  SurveyProblem problem_;
  Measures measures_;
  std::optional<OnSite> on_site_;
  std::optional<SimulatorEvaluator> evaluator_;
};

// Offspring at once in the steady state.
std::size_t batch_of(const Simulator& simulator, const PlanConfig& config);

}  // namespace vantage
