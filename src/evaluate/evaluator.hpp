// SPDX-License-Identifier: Apache-2.0
// Makes evaluations of counted networks: the one place that does, whether every ray counted them, a sample, or sums
// over single stations.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "vantage/attainable.hpp"
#include "vantage/evaluate.hpp"
#include "vantage/evaluation.hpp"

namespace vantage {

// Counts of several networks with every ray, or on one sample.
struct CountedNetworks {
  std::vector<NetworkCounts> surveyed, surroundings;  // the latter empty: not counted
  VoxelField field = {};                              // of a single network, if it was asked for
  // False for a network that was not counted to its end.
  bool whole(std::size_t network) const {
    return !surveyed[network].cancelled && (surroundings.empty() || !surroundings[network].cancelled);
  }
};

// All that evaluate() knows of one network; it borrows that.
struct CountedNetwork {
  std::span<const PlacedStation> stations;
  const NetworkCounts& surveyed;
  const NetworkCounts* surroundings = nullptr;  // null: not counted
  CapturedShares captured = {};                 // by the attainable counts, if a measure needs them
  const Visit* visit = nullptr;                 // the round, if it is worked out; null: `time` is of the shortest one
  std::optional<Estimate> attainable = {};      // coverage by the attainable counts, if they are known
  VoxelField* field = nullptr;                  // points of every voxel, moved from; null: not kept
};

class Evaluator {
 public:
  // `measures`: all that are measured, each once by name, in place of those of the options. Borrows the site's parts.
  Evaluator(const EvaluationSite& site, EvaluationOptions options, std::vector<Objective> measures);

  const std::vector<Objective>& measures() const { return measures_; }
  const RequiredInputs& needs() const { return needs_; }
  // Counts networks as the options say, and their surroundings if the site has some. A stop leaves the rest cancelled.
  CountedNetworks count(std::span<const Network> networks, bool field, const Progress& progress) const;
  // The arguments of measures with these needs. It keeps references to the network.
  MeasuredNetwork measured(const CountedNetwork& network, const RequiredInputs& needs) const;
  // The round along the links of a network.
  Visit visit(const CountedNetwork& network, double most_min) const;
  // All figures that follow from counts and stations. REQUIRES: counts of all needs().
  Evaluation evaluate(const CountedNetwork& network) const;

 private:
  EvaluationSite site_;
  EvaluationOptions options_;
  std::vector<Objective> measures_;
  RequiredInputs needs_;
};

// Gives an evaluation what the options say of it: names, least values of links and the class of accuracy.
void take_options(Evaluation& evaluation, const EvaluationOptions& options);
// Sets the round along links, and the time that it takes if that is a measure. `most_min` as in `OnSite::visit()`.
void add_round(Evaluation& evaluation, const OnSite& on_site, double most_min);
// Figures of a network that is shown, as far as the site has parts for them: sessions and ties of storeys along its
// round, and moves of stations that do not stand well.
void look_closer(Evaluation& evaluation, const EvaluationSite& site);
// The same, and what takes rays: links that glass stops, and places of checks. A stop leaves the links out.
void complete(Evaluation& evaluation, const EvaluationSite& site, const Progress& progress);

}  // namespace vantage
