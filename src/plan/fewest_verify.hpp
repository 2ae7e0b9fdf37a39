// SPDX-License-Identifier: Apache-2.0
// The fewest stations, by every ray: networks that a sample chose are evaluated in full, and chosen anew where that
// shows the sample to be wrong.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "plan/confirm.hpp"
#include "plan/fewest_choice.hpp"
#include "plan/measures.hpp"
#include "plan/network_evaluator.hpp"

namespace vantage {

// Networks of a problem that were evaluated with every ray, as entries of a plan.
class VerifiedNetworks {
 public:
  // Borrows all. `sample_voxels`: of a search, by which entries tell what they seemed to be; 0: every ray.
  VerifiedNetworks(const SurveyProblem& problem, const Measures& measures, const PlacementOracle& oracle,
                   NetworkEvaluator& evaluator, std::uint64_t sample_voxels, const PlanWatch& watch);

  // Evaluates a network of these stations besides the existing ones, or the front of a search for so many of them.
  void add(std::span<const PlacedStation> placed);
  void add(const SearchOutcome& found, std::size_t placed);

  const SurveyProblem& problem() const { return problem_; }
  const std::vector<PlanEntry>& entries() const { return entries_; }
  // Of those evaluated in full the one that violates least; null if there is none.
  const PlanEntry* best() const;

  // Of the networks evaluated in full, or of all if none was: those of fewest stations that keep what is required, else
  // those that violate it least; and of these, those that no other one dominates.
  std::vector<PlanEntry> front() const;

 private:
  const SurveyProblem& problem_;
  const Measures& measures_;
  const PlacementOracle& oracle_;
  NetworkEvaluator& evaluator_;
  std::uint64_t sample_voxels_;
  const PlanWatch& watch_;
  std::vector<PlanEntry> entries_;
};

// The problem with so many stations to place.
SurveyProblem with_stations(SurveyProblem problem, std::size_t placed);

// Verifies the chosen network. Returns by how much the sample of a search overstates its coverage; the coverage margin
// where that is not known.
double verify(const FewestChoice& choice, VerifiedNetworks& verified);

// Chooses anew with margins raised by what the best verified network is short of. False where that cannot help.
bool repair(FewestChoice& choice, const VerifiedNetworks& verified, const std::stop_token& stop);

// Once the chosen network is verified, the sample's error is known: where it is less than the margin, a station fewer
// may do, or as many may be linked better. Chooses and verifies such a network, and keeps it, with the new
// `overstated`, if it keeps what is required. False where it does not, and then the choice is as it was.
bool choose_by_known_error(FewestChoice& choice, VerifiedNetworks& verified, double& overstated,
                           const std::stop_token& stop);

}  // namespace vantage
