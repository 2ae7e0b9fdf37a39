// SPDX-License-Identifier: Apache-2.0
// The fewest stations, by every ray: networks chosen on a sample are evaluated in full, and chosen again if the sample
// proves wrong.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "plan/confirm.hpp"
#include "plan/fewest_choice.hpp"
#include "search/measures.hpp"
#include "search/network_evaluator.hpp"

namespace vantage {

// Networks of a problem that were evaluated with every ray, as entries of a plan.
class VerifiedNetworks {
 public:
  // Returns the order in which to visit stations, as indices.
  using VisitOrder = std::function<std::vector<std::size_t>(std::span<const PlacedStation>)>;
  // Returns the number of links past the stair that alone tie storeys of a network, and that others could replace.
  using TiesPastStairs = std::function<std::size_t(const Evaluation&)>;
  // Borrows all but the functions. `sample_voxels`: size of the search's sample, for the entries' searched values; 0:
  // every ray.
  VerifiedNetworks(const SurveyProblem& problem, const Measures& measures, const PlacementOracle& oracle,
                   NetworkEvaluator& evaluator, std::uint64_t sample_voxels, const PlanWatch& watch,
                   VisitOrder visit_order = {}, TiesPastStairs ties_past_stairs = {});

  // Evaluates a network of these stations and the existing ones, or the front of a search for as many stations.
  // Stations are numbered in the order of visiting.
  void add(std::span<const PlacedStation> placed);
  void add(const SearchOutcome& found, std::size_t placed);

  // Computes all violations again, after a change of the ties that count.
  void judge_again();
  // Gives the last network a value known from its choice, if the time was over before it was evaluated.
  void fill_in(const std::string& measure, double value);

  const SurveyProblem& problem() const { return problem_; }
  const std::vector<PlanEntry>& entries() const { return entries_; }
  // The network with the least violation among those evaluated in full; null if there is none.
  const PlanEntry* best() const;
  // Number of ties past the stair that count as missing links; 0 if the entry was not evaluated with every ray.
  std::size_t ties_past_stairs(const PlanEntry& entry) const {
    return entry.exact && ties_past_stairs_ ? ties_past_stairs_(entry) : 0;
  }

  // Returns the networks with fewest stations that meet the requirements, else those with the least violation; of
  // these, the non-dominated ones. Only networks evaluated in full count, if there are any.
  std::vector<PlanEntry> front() const;

 private:
  double violation_of(const PlanEntry& entry) const;

  const SurveyProblem& problem_;
  const Measures& measures_;
  const PlacementOracle& oracle_;
  NetworkEvaluator& evaluator_;
  std::uint64_t sample_voxels_;
  const PlanWatch& watch_;
  VisitOrder visit_order_;
  TiesPastStairs ties_past_stairs_;
  std::vector<PlanEntry> entries_;
};

// The problem with exactly `placed` stations to place.
SurveyProblem with_stations(SurveyProblem problem, std::size_t placed);

// Verifies the chosen network. Returns the overstatement of its coverage by the sample of a search, or the coverage
// margin if that is not known.
double verify(const FewestChoice& choice, VerifiedNetworks& verified);

// Keeps to stairs (fewest_choice.hpp) if the last verified network, the chosen one, shows ties past them only with
// every ray. Returns true if another network is chosen.
bool keep_to_stairs(FewestChoice& choice, VerifiedNetworks& verified, const std::stop_token& stop);

// Chooses again, starting from the present network: with as many stations, else with more.
void choose_again(FewestChoice& choice, const std::stop_token& stop);

// Raises the margins by somewhat more than `missing`, and chooses again.
void raise_margins(FewestChoice& choice, const Margins& missing, const std::stop_token& stop);

// Raises the margins of meshes whose limits the last verified network, the chosen one, misses. Adds stations for them
// and chooses again; returns false if it adds none.
bool repair_meshes(FewestChoice& choice, const VerifiedNetworks& verified, const std::stop_token& stop);

// Chooses again with margins for what the best verified network lacks. If links are too weak, the table takes the
// exact overlaps of the chosen stations, and lower bounds of all other ones. Links that hold stay; the others are
// mended, by new candidates along the path between stations if no known one does. Returns false if that cannot
// help.
bool repair(FewestChoice& choice, const VerifiedNetworks& verified, const PlacementOracle& oracle,
            const std::stop_token& stop);

// Returns lower bounds of scan overlaps, from a sample that did not choose the stations; empty if stopped.
using LeastOverlaps = std::function<std::optional<ScanOverlapMatrix>(std::span<const PlacedStation>)>;

// Checks the links of the chosen network on another sample, long before every ray is traced. Links chosen among
// millions of pairs are those that their sample overestimates. Mends links that do not hold, as `repair` does.
void check_links(FewestChoice& choice, const PlacementOracle& oracle, const LeastOverlaps& least_overlaps,
                 const std::stop_token& stop);

// Uses the sample's error, known once the chosen network is verified. If it is below the margin, a station fewer may
// do, or as many may be linked better. Chooses and verifies such a network, and keeps it, with the new `overstated`, if
// it meets the requirements. Otherwise returns false and leaves the choice unchanged.
bool choose_by_known_error(FewestChoice& choice, VerifiedNetworks& verified, double& overstated,
                           const std::stop_token& stop);

}  // namespace vantage
