// SPDX-License-Identifier: Apache-2.0
/// Plans surveys: a problem in, networks of stations out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "vantage/evaluation.hpp"
#include "vantage/objective.hpp"
#include "vantage/placement.hpp"
#include "vantage/problem.hpp"
#include "vantage/progress.hpp"
#include "vantage/search_types.hpp"
#include "vantage/simulator.hpp"
#include "vantage/site.hpp"

namespace vantage {

class Candidates;  // vantage/candidates.hpp

/// One network of the front: its evaluation and its origin. `exact` once confirmed by every ray; until then its values
/// are those of `searched`.
struct PlanEntry : Evaluation {
  /// Decision vector: u1, v1, …, uN, vN [, h1, …, hN] [, s1, …, sN] [, α]. s in [0, 1) chooses among
  /// `SurveyProblem::scanners`, each with the same share of the range.
  std::vector<double> x;
  /// Figures of the search, by measure's name, of `PlanResult::measures`; NaN if it kept none.
  std::map<std::string, Estimate> searched;
  /// Another confirmed entry is, by every ray, as good in all objectives and better in one.
  bool dominated = false;
};

/// A point of the trade-off: the best network found of so many stations.
struct TradeOffPoint {
  std::vector<PlacedStation> stations = {};     ///< Existing ones first.
  std::map<std::string, Estimate> values = {};  ///< Keyed by the names of their measures, as an entry's.
  std::optional<double> minutes_on_site = {};   ///< Without existing stations.
  bool answer = false;                          ///< The plan's answer.
  bool knee = false;                            ///< The point farthest above the line from the first to the last.
};

/// `SurveyProblem::pays_share` divides what is captured among this many stations at least: each of fewer captures much,
/// and a share of that would be much.
inline constexpr std::size_t few_for_average = 10;

/// Number of stations that pay (`SurveyProblem::pays_m2`), by a greedy choice among the candidates.
struct StationsThatPay {
  double least_m2 = 0;       ///< Least surface that a further one must capture besides the others.
  std::size_t stations = 0;  ///< Further stations that capture as much, and those in `parts`.
  std::size_t parts = 0;     ///< Rooms and other parts of the floor that have one of their own besides.
  double capture = 0;        ///< Share of what is attainable that so many can have, which the plan then requires.
  double next_m2 = 0;        ///< Surface that a further one would capture.
};

/// Surface and time that a further station would add to a plan's answer: the mean of a fifth more of them, chosen one
/// after the other among the candidates.
struct FurtherStation {
  double m2 = 0;       ///< Surface that the answer does not capture.
  double minutes = 0;  ///< On site, walking included.
};

/// Result of `plan()`, with the settings in force.
struct PlanResult {
  SurveyProblem problem;                  ///< The problem, and the settings of its search.
  PlanConfig config;                      ///< The configuration, as it was given.
  std::size_t population = 0, batch = 0;  ///< In force, also if the configuration left them open.
  WalkableOptions walkable;               ///< Settings of the search area.
  std::optional<Scene> scene = {};        ///< Scene of the site.
  std::optional<SearchArea> area = {};    ///< Search area.
  SecurityVolume security;                ///< Setting of the clash checker.
  std::vector<Scanner> scanners;          ///< Indexed by `StationSetup::scanner`.
  /// Measures of every network: the objectives, then those of requirements, then coverage and overlap.
  std::vector<Objective> measures;
  /// Sorted by the objectives in order, best first. One entry if there is one objective.
  std::vector<PlanEntry> front;
  /// Candidates, if `capture` is used or the number of stations is decided first.
  std::shared_ptr<const Candidates> candidates;
  /// Attainable coverage of the candidates and the stations of the front, the denominator of `capture`. Measured on
  /// voxels by which nothing was chosen, unless the site has few. Empty if `capture` is not used.
  std::optional<Estimate> attainable = std::nullopt;
  std::optional<StationsThatPay> pays = {};    ///< Set if `SurveyProblem::pays_m2` decides the number.
  std::optional<FurtherStation> further = {};  ///< Set for the fewest stations if `capture` is used.
  /// Numbers of stations and their capture, from one to a few beyond the answer, if `capture` decides the number.
  /// Estimated on the voxels of `attainable`, except for the answer.
  std::vector<TradeOffPoint> trade_off;
  std::vector<PlanIteration> history;  ///< One for each iteration.
  /// Final hypervolume of the search; reference point (1, …, 1) of scaled objectives. With one objective it is 1 less
  /// its scaled value.
  double hypervolume = 0;
  double exact_hypervolume = 0;  ///< The same by every ray; NaN if an abort left entries unconfirmed.
  /// Networks in the final archive that were not confirmed: another was better by more than the standard errors allow.
  std::size_t spared = 0;
  std::uint64_t evaluations = 0;                 ///< Networks evaluated by the search.
  std::uint64_t redrawn = 0, drawn = 0;          ///< Stations redrawn out of holes or clashes, and all drawn.
  std::uint64_t resumed_evaluations = 0;         ///< Number of evaluations taken from a checkpoint.
  StopReason stop_reason = StopReason::running;  ///< Reason for which the search ended.
  double seconds = 0, trace_seconds = 0;         ///< Time of the call, and of its tracing; not reproducible.
  Work work = {};                                ///< Work of this plan, without building the site's simulators.
};

/// As `Progress`, for a search.
struct PlanWatch {
  std::function<void(const PlanProgress&)> report = {};  ///< Called between evaluations, on the calling thread.
  std::stop_token stop = {};                             ///< Ends the search; its results are still confirmed.
  std::stop_token abort = {};  ///< Ends the confirmation too: entries not reached have `exact` false.
  /// Tells how many seconds of `PlanConfig::max_seconds` to leave for what the caller does with the result, such as
  /// `write_plan()`. Asked at the beginning, with zeros, and again whenever it is measured how long a station takes
  /// with every ray, with the number of stations of the network at hand. Empty: none.
  std::function<double(std::size_t stations, double seconds_a_station)> seconds_after = {};
};

/// Plans a survey of a site. The problem decides what `config` leaves open: sample, iterations, seed. The same site,
/// problem and configuration give the same result except for seconds. Throws Error: invalid_argument (no objective,
/// more than `max_stations` stations, min above max, a checkpoint of another run, …), malformed_file (a damaged
/// checkpoint), and as the simulator and the objectives do. The checkpoint is written before an exception leaves.
PlanResult plan(Site& site, const SurveyProblem& problem, const PlanConfig& config = {}, const PlanWatch& watch = {});

/// `config` with all open settings decided, for a site of `voxels` surveyed voxels.
PlanConfig settled(const PlanConfig& config, const SurveyProblem& problem, std::uint64_t voxels, std::uint64_t seed);

/// Index of the network that is the answer. The criteria apply in this order:
/// - the least violation of requirements;
/// - the fewest stations, if the question asks for few and no requirement is violated;
/// - a connected network by the problem's `link_overlap`, confirmed, if an objective uses pairs and nothing is
/// required: components cannot be registered with each other, however well each overlaps in itself;
/// - the least Euclidean distance of the scaled objectives to the best values (the utopia point: Zeleny, Compromise
/// Programming, 1973).
///
/// Throws Error invalid_argument if the front is empty.
std::size_t answer(const PlanResult& result);
/// True if the answer meets all requirements. False if this is not certain: the answer was not confirmed, or `capture`
/// is required and the look at attainable coverage was cut short.
bool met(const PlanResult& result);
/// Advice if the answer does not meet the requirements, a sentence each.
std::vector<std::string> what_would_help(const PlanResult& result);

}  // namespace vantage
