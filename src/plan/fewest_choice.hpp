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

// Decrease of the violation for which an infeasible network takes a further station. Without it, a hundred stations
// that capture next to nothing would come before a loft that no link reaches.
inline constexpr double kLeastHelp = 0.005;

// The part of a survey problem that a covering problem can express.
struct FewestAsked {
  std::size_t existing = 0;            // number of existing stations
  std::size_t fewest = 1, most = 1;    // further stations
  bool captured = false;               // coverage is the share of what is attainable; else equation 8
  double whole = 1;                    // coverage by equation 8 that a `coverage` of 1 stands for, at least
  double coverage = 0;                 // lower limit; 1 if the most coverage is asked for
  bool most_coverage = false;          // asked for, of a fixed number of stations
  double link = 0, apart_m = 0;        // lower limits; 0: none
  std::optional<double> minutes = {};  // on site, upper limit
  double least_help = kLeastHelp;      // as `CoverProblem::least_help`

  // Name of the measure that `coverage` limits.
  const char* measure() const { return captured ? "capture" : "coverage"; }
  // Factor from values of an objective on coverage to those of `coverage`.
  double of_one(const Objective& objective) const { return objective.coverage_of_one / whole; }
};
FewestAsked fewest_asked(const SurveyProblem& problem);

// A lower limit on the share of some meshes' attainable coverage.
struct AskedOfMeshes {
  std::string measure;              // its name
  double share = 0;                 // lower limit
  double margin = 0;                // added to it, as `Margins` are to other limits
  std::vector<double> weight = {};  // of each element, 0 for those of other meshes
};
std::vector<AskedOfMeshes> asked_of_meshes(const SurveyProblem& problem, const AttainableCounts& attainable,
                                           std::span<const std::uint32_t> weights);

// Margins added to limits, since a sample overestimates the network that was chosen on it. The choice and the search
// apply `coverage`; the search alone applies `link`.
struct Margins {
  double coverage = 0, link = 0;
};

// Largest number of standard errors that is subtracted from a sampled overlap.
inline constexpr double kMostLinkErrors = 2;

// The network chosen from a table, and the inputs of the next stages.
struct FewestChoice {
  FewestAsked asked;
  CandidateTable table;  // existing stations first
  Margins margins = {};
  double link_errors = 0;  // standard errors that the choice subtracts from sampled overlaps
  CoverSolution network = {};
  std::optional<CoverSolution> one_fewer = {};  // the best network of one station fewer, which is not feasible
  const UnitsToVisit* to_visit = nullptr;       // borrowed
  std::vector<std::size_t> visiting = {};       // added for empty units, or for meshes; they stay, as existing ones
                                                // do
  std::vector<AskedOfMeshes> of_meshes = {};
  std::vector<double> attainable = {};  // attainable points of each element, for `of_meshes`
  PastStairs past_stairs = {};          // empty: all links are alike
  WayBetween way = {};                  // empty: unknown
  // Known once the choice leaves out links past the stair.
  struct AlongStairs {
    CoverSolution before = {};    // the network that has such ties
    std::size_t unavoidable = 0;  // ties that no others replace
  };
  std::optional<AlongStairs> along_stairs = {};

  // Returns all stations of a network, or all but the existing ones.
  std::vector<PlacedStation> stations_of(const CoverSolution& solution) const;
  std::vector<PlacedStation> placed_of(const CoverSolution& solution) const;
  std::size_t placed() const { return network.chosen.size() - asked.existing; }
};

// Borrows the table.
CoverProblem cover_problem(const FewestChoice& choice);

// Traces existing stations into the table, then candidates with known columns. A stop of `progress` ends it after some
// candidates, `abort` at once.
void look(CandidateTable& table, std::span<const PlacedStation> existing, std::span<const PlacedStation> candidates,
          const CoverageMatrix& known, const Progress& progress, const std::stop_token& abort);

// Time of a survey.
struct VisitTime {
  double each_min = 0;                                                 // a station, without paths
  std::function<double(std::span<const PlacedStation>)> minutes = {};  // the round over the placed ones
};

// True if no network of the candidates is known to meet the requirements.
bool out_of_reach(const FewestChoice& choice);
// Sets `asked.least_help`, and chooses again without the present network as a start.
void choose_anew(FewestChoice& choice, double least_help, const std::stop_token& stop);
// Swaps stations until the weakest link exceeds its limit by its error. Links beyond that are not strengthened.
void strengthen(FewestChoice& choice, const std::stop_token& stop);
// Chooses the fewest stations, and strengthens their links. If their round is longer than
// `asked.minutes`, chooses as many as fit, and lowers `asked.most` to that number.
void choose(FewestChoice& choice, const VisitTime& visit, std::stop_token stop);
// Starts from a network of the table, or from none.
void choose_from(FewestChoice& choice, std::optional<CoverSolution> start, std::stop_token stop);

// If a linked network misses its coverage, adds stations with swaps even if the first alone gains nothing, as one of
// two that link a room. Returns true if the network then has the coverage.
bool grow_into_reach(FewestChoice& choice, const std::stop_token& stop);

// If the requirements are out of reach, adds candidates along paths to places that no link reaches, such as rooms
// behind doorways. Chooses again, and returns true if the violation has decreased.
bool look_along_ways(FewestChoice& choice, const PlacementOracle& oracle, const std::stop_token& stop);

// Adds a station to each unit of floor that has none and is worth one, and chooses again with these. Returns true if it
// added any. Does nothing if the time on site is limited.
bool visit_units(FewestChoice& choice, const std::stop_token& stop);
// Adds stations until the network meets the limits of `of_meshes`, and chooses again with these. Returns true if it
// added any.
bool capture_meshes(FewestChoice& choice, const std::stop_token& stop);
// Replaces each station that bars a door or a stair by the best one nearby that does not, unless the violation grows.
// Returns true if it replaced any. Does nothing if stations are chosen for the most coverage.
bool stand_aside(FewestChoice& choice, const PlacementOracle& oracle, const std::stop_token& stop);
// Returns true if `after` has no station in some unit where `before` has one.
bool leaves_units(const FewestChoice& choice, std::span<const PlacedStation> before,
                  std::span<const PlacedStation> after);

// Number of links past the stair that alone connect storeys. `linked(a, b)`: true if stations a and b are.
std::size_t ties_past_stairs(std::span<const PlacedStation> stations, const PastStairs& past_stairs,
                             const std::function<bool(std::size_t, std::size_t)>& linked);
// Chooses again without links past the stair (candidate_table.hpp) if they alone connect storeys of the network.
// Returns true if it found a network of hardly more stations. Otherwise the choice is as before, and all links count
// from now on.
bool keep_to_stairs(FewestChoice& choice, const std::stop_token& stop);
// Lets all links count again, since the network along stairs does not hold, and goes on from the one before
// `keep_to_stairs`.
void leave_stairs(FewestChoice& choice, const std::stop_token& stop);

// Adds allowed positions within `radius_m` of the chosen stations, and of the best network of one fewer, to the table,
// and chooses again from the present network.
void refine_around(FewestChoice& choice, const PlacementOracle& oracle, double radius_m, const Progress& progress);

}  // namespace vantage
