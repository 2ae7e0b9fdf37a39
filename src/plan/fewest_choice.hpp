// SPDX-License-Identifier: Apache-2.0
// The fewest stations, first half: how many. Stages look at candidates, choose among them and refine the choice, on
// arrays of counts.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "candidates/candidate_table.hpp"
#include "candidates/floor_units.hpp"
#include "site/placement_oracle.hpp"
#include "vantage/cover.hpp"
#include "vantage/planner.hpp"

namespace vantage {

// Violation that a further station has to make up for where nothing feasible is found. Else a hundred stations that
// capture next to nothing would come before a loft that no link reaches.
inline constexpr double kLeastHelp = 0.005;

// The part of a survey problem that a covering problem can express.
struct FewestAsked {
  std::size_t existing = 0;            // number of existing stations
  std::size_t fewest = 1, most = 1;    // further stations
  bool captured = false;               // coverage is the share of what is attainable; else equation 8
  double whole = 1;                    // what a coverage of 1 has of equation 8, at least
  double coverage = 0;                 // at least; 1 where as much as so many stations can have is asked for
  bool most_coverage = false;          // the latter
  double link = 0, apart_m = 0;        // 0: not asked
  std::optional<double> minutes = {};  // on site, at most
  double least_help = kLeastHelp;      // as of the covering problem

  // The measure that `coverage` is.
  const char* measure() const { return captured ? "capture" : "coverage"; }
  // What a value of 1 of an objective on coverage is in `coverage`.
  double of_one(const Objective& objective) const { return objective.coverage_of_one / whole; }
};
FewestAsked fewest_asked(const SurveyProblem& problem);

// Meshes of which a least share of what is attainable has to be captured.
struct AskedOfMeshes {
  std::string measure;              // its name
  double share = 0;                 // at least
  double margin = 0;                // beyond it, as of the limits below
  std::vector<double> weight = {};  // of each element, 0 for those of other meshes
};
std::vector<AskedOfMeshes> asked_of_meshes(const SurveyProblem& problem, const AttainableCounts& attainable,
                                           std::span<const std::uint32_t> weights);

// Distances from the limits, since a sample favours what it chose: of the choice and the search by coverage, of the
// search alone by links.
struct Margins {
  double coverage = 0, link = 0;
};

// Standard errors by which a sampled link is taken for weaker than it seems, at most.
inline constexpr double kMostLinkErrors = 2;

// The network chosen from a table, and the inputs of the next stages.
struct FewestChoice {
  FewestAsked asked;
  CandidateTable table;  // existing stations first
  Margins margins = {};
  double link_errors = 0;  // standard errors by which the choice takes sampled overlaps for less than they seem
  CoverSolution network = {};
  std::optional<CoverSolution> one_fewer = {};  // the best network of one station fewer, which is not feasible
  const UnitsToVisit* to_visit = nullptr;       // borrowed
  std::vector<std::size_t> visiting = {};       // stations of units that had none, or for some meshes; they stay, as
                                                // existing ones do
  std::vector<AskedOfMeshes> of_meshes = {};
  std::vector<double> attainable = {};  // points of each element that count, for these
  PastStairs past_stairs = {};          // empty: all links are alike
  WayBetween way = {};                  // empty: unknown
  // The choice without links past the stair, if they do not count.
  struct AlongStairs {
    CoverSolution before = {};    // the network that has such ties
    std::size_t unavoidable = 0;  // ties that no others replace
  };
  std::optional<AlongStairs> along_stairs = {};

  // All stations of a network, or those besides the existing ones.
  std::vector<PlacedStation> stations_of(const CoverSolution& solution) const;
  std::vector<PlacedStation> placed_of(const CoverSolution& solution) const;
  std::size_t placed() const { return network.chosen.size() - asked.existing; }
};

// Borrows the table.
CoverProblem cover_problem(const FewestChoice& choice);

// Traces existing stations into the table, then candidates with known columns. `stop` ends it early, after some
// candidates; `abort` at once.
void look(CandidateTable& table, std::span<const PlacedStation> existing, std::span<const PlacedStation> candidates,
          const CoverageMatrix& known, const Progress& progress, const std::stop_token& abort);

// Time of a survey.
struct VisitTime {
  double each_min = 0;                                                 // a station, without paths
  std::function<double(std::span<const PlacedStation>)> minutes = {};  // the round over the placed ones
};

// True if no network of the candidates is known to meet what is asked.
bool out_of_reach(const FewestChoice& choice);
// Chooses from none, and from now on with another least help of a further station.
void choose_anew(FewestChoice& choice, double least_help, const std::stop_token& stop);
// Swaps stations until the weakest link has what is asked and the margin of its error. Stronger links serve nobody.
void strengthen(FewestChoice& choice, const std::stop_token& stop);
// Chooses the fewest stations, and strengthens their links. If their round is longer than
// `asked.minutes`, chooses as many as fit, and lowers `asked.most` to that number.
void choose(FewestChoice& choice, const VisitTime& visit, std::stop_token stop);
// Starts from a network of the table, or from none.
void choose_from(FewestChoice& choice, std::optional<CoverSolution> start, std::stop_token stop);

// If linked stations are short of what is asked, takes some more than the choice found any use for, with swaps: of two
// that link a room the first adds nothing. True if they reach it.
bool grow_into_reach(FewestChoice& choice, const std::stop_token& stop);

// If what is asked is out of reach, looks along the ways to what no link reaches from the network, such as rooms behind
// doorways, and chooses again. True if that serves.
bool look_along_ways(FewestChoice& choice, const PlacementOracle& oracle, const std::stop_token& stop);

// Adds a station to each unit of floor that has none and takes one, and chooses again with these. True if there was
// one. Not where the time on site ends the choice.
bool visit_units(FewestChoice& choice, const std::stop_token& stop);
// Adds stations until the network captures what is asked of some meshes, and chooses again with these. True if there
// was one to add.
bool capture_meshes(FewestChoice& choice, const std::stop_token& stop);
// Swaps each station that bars a door or a stair for the best one nearby that does not, if what is asked holds no worse
// with it. True if there was one to swap. Not where stations are chosen for the most coverage alone.
bool stand_aside(FewestChoice& choice, const PlacementOracle& oracle, const std::stop_token& stop);
// True if a network has no station in some unit where the one before has one.
bool leaves_units(const FewestChoice& choice, std::span<const PlacedStation> before,
                  std::span<const PlacedStation> after);

// Number of links past the stair that alone tie storeys of a network. `linked`: whether two of its stations are.
std::size_t ties_past_stairs(std::span<const PlacedStation> stations, const PastStairs& past_stairs,
                             const std::function<bool(std::size_t, std::size_t)>& linked);
// Chooses again without links past the stair (candidate_table.hpp) if they alone tie storeys of the network. Returns
// true if it found a network of hardly more stations; otherwise the choice is as before, and all links are alike from
// now on.
bool keep_to_stairs(FewestChoice& choice, const std::stop_token& stop);
// Goes back to the network before, since the one along stairs does not hold.
void leave_stairs(FewestChoice& choice, const std::stop_token& stop);

// Adds allowed positions within `radius_m` of the chosen stations, and of the best network of one fewer, to the table,
// and chooses again from the present network.
void refine_around(FewestChoice& choice, const PlacementOracle& oracle, double radius_m, const Progress& progress);

}  // namespace vantage
