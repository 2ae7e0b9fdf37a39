// SPDX-License-Identifier: Apache-2.0
// The fewest stations, first half: how many. Stages that look at candidates, choose among them and refine the choice,
// on arrays of counts.
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

// What a survey problem asks of a network, as a covering problem can say it.
struct FewestAsked {
  std::size_t existing = 0;            // stations that are there
  std::size_t fewest = 1, most = 1;    // further stations
  double coverage = 0;                 // equation 8
  double link = 0, apart_m = 0;        // 0: not asked
  std::optional<double> minutes = {};  // on site, at most
};
FewestAsked fewest_asked(const SurveyProblem& problem);

// How far a choice keeps from its limits, since the sample that it is made by flatters it.
struct Margins {
  double coverage = 0, link = 0;
};

// The network chosen from a table, and what the next stages have to know of it.
struct FewestChoice {
  FewestAsked asked;
  CandidateTable table;  // existing stations first
  Margins margins = {};
  CoverSolution network = {};
  std::optional<CoverSolution> one_fewer = {};  // the best network of one station fewer, which does not do

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

// Looks: existing stations into the table, then candidates of known columns. `stop` ends it early, with some candidates
// at least; `abort` at once.
void look(CandidateTable& table, std::span<const PlacedStation> existing, std::span<const PlacedStation> candidates,
          const CoverageMatrix& known, const Progress& progress, const std::stop_token& abort);

// How long a survey takes.
struct VisitTime {
  double each_min = 0;                                                 // a station, without ways
  std::function<double(std::span<const PlacedStation>)> minutes = {};  // the round over the placed ones
};

// Chooses the fewest stations, with as strong a weakest link as their number allows. Where their round lasts longer
// than `asked.minutes`, as many as there is time for: then `asked.most` is lowered to that number.
void choose(FewestChoice& choice, const VisitTime& visit, std::stop_token stop);
// From a network of the table, or none.
void choose_from(FewestChoice& choice, std::optional<CoverSolution> start, std::stop_token stop);

// Refines: adds allowed positions within `radius_m` of the chosen stations, and of the best network of one fewer, to
// the table, and chooses from where it was.
void refine_around(FewestChoice& choice, const PlacementOracle& oracle, double radius_m, const Progress& progress);

// Of the candidates of a short list: for each chosen station so many that replace it best, and so many that add most.
inline constexpr std::size_t kBestReplacements = 8, kBestAdditions = 64;

// Refines: a choice among thousands by a sample is what the sample flatters. So the best candidates are traced on a
// larger sample, into `larger`, which is empty, and chosen from anew with a smaller coverage margin; where that choice
// is worse than it seemed, more of them. `larger` takes the place of the table. Returns how many stations were traced.
std::size_t refine_on_larger_sample(FewestChoice& choice, CandidateTable larger, double coverage_margin,
                                    const Progress& progress, const std::stop_token& abort);

}  // namespace vantage
