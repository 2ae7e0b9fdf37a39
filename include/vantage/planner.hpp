// SPDX-License-Identifier: Apache-2.0
/// Searches for networks of stations. The one header where optimiser and simulator meet.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/candidates.hpp"
#include "vantage/evaluation.hpp"
#include "vantage/objective.hpp"
#include "vantage/on_site.hpp"
#include "vantage/optimiser.hpp"
#include "vantage/placement.hpp"
#include "vantage/progress.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

/// What is asked: how many stations, where they may be, what a network is searched for and what it has to keep.
struct SurveyProblem {
  std::string name = "custom";  ///< For tables and pictures; "coverage-fix" and such for the method's own.
  /// How many stations to place. Where the two differ, the number is searched too, by the decision variable α of
  /// equation 7.
  std::size_t stations_min = 4, stations_max = 4;
  std::vector<Vec3> kept = {};  ///< Heads of stations that are there already: the first of every network, on top.
  /// How they are set up, one each; empty: upright, with the first scanner.
  std::vector<StationSetup> kept_setups = {};
  /// Indices into `Simulator::scanners()` that each station chooses from, in the order in which they are tried: one
  /// model with finer and finer steps, say. Empty: the first scanner.
  std::vector<std::uint32_t> scanners = {};
  /// Lowest and highest height of the head above the search area, searched per station; empty: the scanner's height.
  std::optional<std::array<double, 2>> heights_m = std::nullopt;
  std::vector<Objective> objectives = {};      ///< At least one. One: the best network is searched; several: a front.
  std::vector<Requirement> requirements = {};  ///< Networks that break one rank behind all that do not, by how much.
  /// Pairs of less overlap count as not linked in reports and pictures.
  double link_overlap = default_link_overlap;
  RegistrationOptions registration = {};  ///< What scans register from, and how well they have surfaces.
  /// In two steps: first the fewest stations, of `stations_min` to `stations_max`, that keep the requirements on
  /// `coverage`, `capture`, `link` and `apart`; then, at that number, the best by the objectives under all
  /// requirements.
  bool fewest = false;
  /// What can be seen: the coverage (equation 8) that `capture` is a share of. Empty: found by `find_candidates()`
  /// where `capture` is asked for.
  std::optional<double> visible = std::nullopt;
  OnSiteOptions on_site = {};  ///< For the objective `time`, and the time on site that every plan tells.

  /// What the built-in objectives have to be told of this problem.
  ObjectiveSettings settings() const;
};

Settings settings(const SurveyProblem& problem);

/// The problems of Table 2 of the method, by objectives: coverage; coverage and overlap; coverage and number of
/// stations; all three. And the scalarised fitness of equation 1, a baseline.
SurveyProblem coverage_fix(std::size_t stations);
SurveyProblem coverage_overlap_fix(std::size_t stations);
SurveyProblem coverage_min(std::size_t stations_min, std::size_t stations_max);
SurveyProblem coverage_overlap_min(std::size_t stations_min, std::size_t stations_max);
SurveyProblem fitness_min(std::size_t stations_min, std::size_t stations_max, const FitnessWeights& weights = {});
/// The surveyor's question: the fewest stations that capture so much of what can be seen, all linked along some
/// spanning tree by scan overlaps of at least `link`, `apart_m` or more from each other; then, at that number, the
/// least registration error.
SurveyProblem fewest_stations(double capture = 0.9, double link = 0.3, std::size_t stations_min = 1,
                              std::size_t stations_max = max_stations, double apart_m = 1);
/// One of `problem_names()`: "coverage-fix", "coverage-overlap-fix", "coverage-min", "coverage-overlap-min",
/// "fitness-min". Throws Error invalid_argument and lists the names, or where a -fix problem is given a range or a -min
/// problem none.
SurveyProblem survey_problem(std::string_view name, std::size_t stations_min, std::size_t stations_max);
std::span<const std::string> problem_names();
/// A problem of built-in objectives.
SurveyProblem survey_problem(std::span<const std::string> objectives, std::size_t stations_min,
                             std::size_t stations_max, double link_overlap = default_link_overlap);

/// How to search.
struct PlanConfig {
  std::size_t population = 0;  ///< 0: with one objective 10, or 20 where the number is searched; else 100.
  /// Of `population` evaluations each. 0: 100; where the fewest stations are asked for, by the site, so that the search
  /// traces about twice as many stations as looking at what can be seen did.
  std::size_t iterations = 0;
  double sigma0 = 0.2;
  /// Makes the optimiser of problems with several objectives; empty: MO-CMA-ES. A checkpoint is resumed only with the
  /// same.
  OptimiserMaker optimiser = {};
  MoCmaEsConfig::Scheme scheme = MoCmaEsConfig::Scheme::steady_state;
  std::size_t batch = 0;  ///< Offspring at once in the steady state; 0: chosen by the engine.
  bool exact = false;     ///< Search with every ray, the dearest way; `sample_voxels` is then 0.
  /// Search with so many of the surveyed voxels; 0: chosen by the problem and the site.
  std::uint64_t sample_voxels = 0;
  std::optional<double> sample_share = {};  ///< The same as a share of the surveyed voxels, above 0 and at most 1.
  /// Redraw the voxel sample every so many iterations and re-evaluate the archive on it; at the end once more, on
  /// voxels that nothing was chosen by. Every ray then chooses the front from the whole archive, but for networks that
  /// cannot be on it. 0: one sample for the whole search, and the front that it shows (docs/method.md). Empty: 20 for a
  /// front without a sample asked for, else 0.
  std::optional<std::size_t> renew_iterations = {};
  /// Head positions of an initial network: the first mean of CMA-ES, a first member of MO-CMA-ES; empty: random. Where
  /// the number of stations is searched, the first N of them are a first member for each N that they suffice for.
  std::vector<Vec3> start = {};
  std::size_t redraws = 8;  ///< How often a candidate's stations in holes or clashes are drawn again.
  /// Time limit of the whole call, in seconds; 0: none. After eight tenths of it looking, choosing and searching end,
  /// and what was found is traced with every ray; entries that this does not reach in time have `confirmed` false.
  double max_seconds = 0;
  std::optional<double> target_hypervolume = std::nullopt;
  std::size_t stagnation_iterations = 0;
  std::optional<std::uint64_t> seed = {};  ///< Empty: the site's.
  std::filesystem::path checkpoint = {};   ///< File to write; the one before stays as FILE.before. Empty: none.
  double checkpoint_seconds = 60;          ///< How often.
  /// Go on from the checkpoint, or the one before; where there is none begin. Limits (iterations, seconds, hypervolume,
  /// stagnation) may differ from the run that wrote it, nothing else.
  bool resume = false;
};

/// All but an optimiser of the caller's own, and where the checkpoint is and how it is used, which no result depends
/// on.
Settings settings(const PlanConfig& config);

/// One network of the front: its evaluation, and how it came there. `exact` once it is confirmed by every ray; until
/// then its values are those of `searched`.
struct PlanEntry : Evaluation {
  /// Decision vector: u1, v1, …, uN, vN [, h1, …, hN] [, s1, …, sN] [, α]; s in [0, 1) chooses among
  /// `SurveyProblem::scanners`, each as often as any other.
  std::vector<double> x;
  /// The figures as the search saw them, by measure's name, of `PlanResult::measures`; NaN where it kept none.
  std::map<std::string, Estimate> searched;
  /// Judged by every ray, another confirmed entry is as good in all objectives and better in one.
  bool dominated = false;
};

/// One line of the history, an iteration each.
struct PlanIteration {
  std::size_t iteration = 0, evaluations = 0;
  double hypervolume = 0;
  /// What the optimiser minimised: `scaled_objectives()` of each network of the front.
  std::vector<std::vector<double>> front;
  double seconds = 0;  ///< Since the start. Never part of what must be reproducible.
};

struct PlanResult {
  SurveyProblem problem;  ///< What was asked, and how it was searched.
  PlanConfig config;
  std::size_t population = 0, batch = 0;  ///< As chosen where the configuration left it open.
  WalkableOptions walkable;               ///< What the search area was built with.
  SecurityVolume security;                ///< What the clash checker was built with.
  std::vector<Scanner> scanners;          ///< What `StationSetup::scanner` counts.
  /// All that is told of a network: the objectives, then what requirements bound, then coverage and overlap.
  std::vector<Objective> measures;
  std::vector<PlanEntry> front;  ///< By the objectives in order, best first. One entry where there is one objective.
  /// What can be seen, and where from: where `capture` is asked for, or the number of stations is decided first.
  std::shared_ptr<const Candidates> candidates;
  std::vector<PlanIteration> history;
  /// Final, as the search saw it; reference point (1, …, 1) of scaled objectives. With one objective that is 1 less its
  /// scaled value.
  double hypervolume = 0;
  double exact_hypervolume = 0;  ///< The same by every ray; NaN where an abort left entries unconfirmed.
  /// Networks that were kept to the end and not confirmed: another was better by more than the standard errors allow.
  std::size_t spared = 0;
  std::uint64_t evaluations = 0;
  std::uint64_t redrawn = 0, drawn = 0;   ///< Stations drawn again out of a hole or a clash, and all drawn.
  std::uint64_t resumed_evaluations = 0;  ///< How many of the evaluations a checkpoint brought.
  StopReason stop_reason = StopReason::running;
  double seconds = 0, trace_seconds = 0;
};

/// A snapshot for whoever watches.
struct PlanProgress {
  std::size_t iteration = 0, iterations = 0;
  std::uint64_t evaluations = 0;
  double hypervolume = 0, evaluations_per_second = 0;
  double seconds_left = 0;  ///< Below 0: not known yet.
  std::string phase;        ///< "look" (at what can be seen), "choose", "search" or "confirm".
  /// The front as it is now, as the optimiser has it: decision vectors and `scaled_objectives()`, 1 and more where
  /// requirements are missed. Valid for the call.
  std::span<const ParetoPoint> front = {};
  /// Told once, when it is known: the coverage that a head on every one of `evaluations` places all over the ground
  /// would reach together.
  std::optional<double> visible = std::nullopt;
  /// Told once where the fewest stations are asked for, when their number is about known: what all the rest will take,
  /// from what these parts of it took so far.
  std::optional<double> whole_seconds_left = std::nullopt;
};

/// As `Progress`, for a search.
struct PlanWatch {
  std::function<void(const PlanProgress&)> report = {};  ///< Called between evaluations, on the calling thread.
  std::stop_token stop = {};                             ///< Ends the search; what was found so far is still confirmed.
  std::stop_token abort = {};  ///< Ends the confirmation too: entries that it did not reach have `exact` false.
};

/// Runs the search. Borrows simulator, area and clash for the call. Same inputs, same seed: same result but for
/// seconds. Throws Error: invalid_argument (no objective, more than `max_stations` stations, min above max, a
/// checkpoint of another run, …), malformed_file (a damaged checkpoint) and what the simulator and the objectives
/// throw; the checkpoint is written before an exception leaves.
PlanResult plan(Simulator& simulator, const SearchArea& area, const ClashChecker& clash, const SurveyProblem& problem,
                const PlanConfig& config = {}, const PlanWatch& watch = {});

/// The network that is the answer: of those that keep all requirements, with a question for few stations, those of
/// fewest stations first; then the one whose scaled objectives are nearest to the best values by Euclidean distance
/// (the utopia point of compromise programming: Zeleny, Compromise Programming, 1973). Where an objective looks at
/// pairs and nothing is required, of those whose stations all hang together by the problem's `link_overlap`, as far as
/// there are any confirmed: parts of a network cannot be registered with each other, however well each overlaps in
/// itself. Where none keeps the requirements, the one that misses least. Throws Error invalid_argument where the front
/// is empty.
std::size_t answer(const PlanResult& result);
/// Whether the answer keeps all requirements. False where that is not known for sure: it was not confirmed, or the look
/// at what can be seen was cut short where `capture` is required.
bool met(const PlanResult& result);
/// What would help where the answer does not keep the requirements, a sentence each.
std::vector<std::string> what_would_help(const PlanResult& result);

/// What the search minimises of a network, in the order of `problem.objectives`: their scaled values; α for the number
/// of stations where that is searched. `x`: its decision vector; `values`: of the objectives.
std::vector<double> scaled_objectives(const SurveyProblem& problem, std::span<const double> x,
                                      std::span<const double> values);

/// How a first network is chosen among candidates.
struct GreedyConfig {
  std::size_t stations = 4;              ///< How many to choose.
  std::size_t candidates = 300;          ///< Positions to choose from, spread evenly over the ground.
  std::uint64_t sample_voxels = 20'000;  ///< 0: every voxel.
  std::vector<Vec3> existing = {};       ///< Heads of stations that are there already; neither counted nor returned.
  std::vector<StationSetup> existing_setups = {};  ///< As `SurveyProblem::kept_setups`.
};

/// What `greedy_network` chose.
struct GreedyResult {
  std::vector<PlacedStation> stations;  ///< In the order of choosing: the first k are the choice for k.
  std::vector<double> coverage;         ///< After each, on the sample.
  bool cancelled = false;
};

/// A first network for `PlanConfig::start`, and a baseline: greedy() over candidates (vantage/cover.hpp). Once no
/// candidate adds anything, the rest are the most evenly spread ones. Throws Error invalid_argument for more stations
/// than candidates, and where no candidate can stand.
GreedyResult greedy_network(Simulator& simulator, const SearchArea& area, const ClashChecker& clash,
                            const GreedyConfig& config = {}, const Progress& progress = {});

/// How the best network among candidates is chosen.
struct ExactConfig {
  std::size_t stations = 4;              ///< How many to choose.
  std::size_t candidates = 256;          ///< Positions to choose from, spread evenly over the ground.
  std::uint64_t sample_voxels = 20'000;  ///< 0: every voxel.
  double link = 0;          ///< Least scan overlap of links by which the network is connected; 0: it need not be.
  double apart_m = 0;       ///< Least distance between heads.
  double max_seconds = 60;  ///< Of branch and bound. What is found when they are over depends on the machine.
  std::vector<Vec3> existing = {};  ///< Heads of stations that are there already; neither counted nor returned.
};

/// What `exact_network` chose.
struct ExactResult {
  std::vector<PlacedStation> stations;  ///< Empty where no connected network was found.
  CoverSolution choice;                 ///< The choice among candidates, and the most coverage that any has.
  bool cancelled = false;
};

/// The best network among candidates, by max_cover() with branch and bound. Without a gap it is the best there is among
/// them. A baseline, and a first network for `PlanConfig::start`. Throws Error invalid_argument where no candidate can
/// stand.
ExactResult exact_network(Simulator& simulator, const SearchArea& area, const ClashChecker& clash,
                          const ExactConfig& config = {}, const Progress& progress = {});

/// Decision vector to stations: locate, raise by `height_m`, check for clashes.
std::vector<PlacedStation> place_stations(const SearchArea& area, const ClashChecker& clash, double height_m,
                                          std::span<const double> uvs);

}  // namespace vantage
