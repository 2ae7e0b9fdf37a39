// SPDX-License-Identifier: Apache-2.0
// The fewest stations, first half: how many. Stages look at candidates, choose among them and refine the choice, on
// arrays of counts.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "plan/candidate_table.hpp"
#include "plan/placement_oracle.hpp"
#include "vantage/cover.hpp"
#include "vantage/planner.hpp"

namespace vantage {

// The part of a survey problem that a covering problem can express.
struct FewestAsked {
  std::size_t existing = 0;            // number of existing stations
  std::size_t fewest = 1, most = 1;    // further stations
  double coverage = 0;                 // least coverage, equation 8
  double link = 0, apart_m = 0;        // least values; 0: none
  std::optional<double> minutes = {};  // largest time on site
};
FewestAsked fewest_asked(const SurveyProblem& problem);

// Distances of a choice from its limits, since the sample that chose it favours it.
struct Margins {
  double coverage = 0, link = 0;
};

// The network chosen from a table, and the inputs of the next stages.
struct FewestChoice {
  FewestAsked asked;
  CandidateTable table;  // existing stations first
  Margins margins = {};
  CoverSolution network = {};
  std::optional<CoverSolution> one_fewer = {};  // the best network of one station fewer, which is not feasible

  // All stations of a network, or those besides the existing ones.
  std::vector<PlacedStation> stations_of(const CoverSolution& solution) const;
  std::vector<PlacedStation> placed_of(const CoverSolution& solution) const;
  std::size_t placed() const { return network.chosen.size() - asked.existing; }
};

// Borrows the table.
CoverProblem cover_problem(const FewestAsked& asked, const CandidateTable& table, const Margins& margins);
inline CoverProblem cover_problem(const FewestChoice& choice) {
  return cover_problem(choice.asked, choice.table, choice.margins);
}

// Traces existing stations into the table, then candidates with known columns. `stop` ends it early, after some
// candidates; `abort` at once.
void look(CandidateTable& table, std::span<const PlacedStation> existing, std::span<const PlacedStation> candidates,
          const CoverageMatrix& known, const Progress& progress, const std::stop_token& abort);

// Time of a survey.
struct VisitTime {
  double each_min = 0;                                                 // a station, without paths
  std::function<double(std::span<const PlacedStation>)> minutes = {};  // the round over the placed ones
};

// Chooses the fewest stations, with the strongest weakest link of their number. If their round is longer than
// `asked.minutes`, chooses as many as fit, and lowers `asked.most` to that number.
void choose(FewestChoice& choice, const VisitTime& visit, std::stop_token stop);
// Starts from a network of the table, or from none.
void choose_from(FewestChoice& choice, std::optional<CoverSolution> start, std::stop_token stop);

// Adds allowed positions within `radius_m` of the chosen stations, and of the best network of one fewer, to the table,
// and chooses again from the present network.
void refine_around(FewestChoice& choice, const PlacementOracle& oracle, double radius_m, const Progress& progress);

// Lengths of a short list: the best replacements for each chosen station, and the best additions.
inline constexpr std::size_t kBestReplacements = 8, kBestAdditions = 64;

// Traces the best candidates on a larger sample, into `larger`, which is empty, and chooses again with a smaller
// coverage margin, since a choice among thousands is favoured by its sample. If that choice is worse than it seemed,
// more candidates follow. `larger` replaces the table. Returns the number of traced stations.
std::size_t refine_on_larger_sample(FewestChoice& choice, CandidateTable larger, double coverage_margin,
                                    const Progress& progress, const std::stop_token& abort);

}  // namespace vantage
