// SPDX-License-Identifier: Apache-2.0
/// Planning problems, the settings of a search for their networks, and its progress.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/objective.hpp"
#include "vantage/on_site.hpp"
#include "vantage/scanner.hpp"
#include "vantage/search_types.hpp"
#include "vantage/settings.hpp"
#include "vantage/site.hpp"
#include "vantage/targets.hpp"

namespace vantage {

/// A planning problem: number of stations, allowed heights, objectives and requirements.
struct SurveyProblem {
  std::string name = "custom";  ///< For tables and pictures; e.g. "coverage-fix" for the method's own.
  /// Number of stations to place. If the two differ, the number is searched too, by the decision variable α of equation
  /// 7.
  std::size_t stations_min = 4, stations_max = 4;
  std::vector<Vec3> existing = {};  ///< Heads of existing stations: the first of every network, not counted above.
  /// Their setups, one each; empty: upright, with the first scanner.
  std::vector<StationSetup> existing_setups = {};
  std::vector<std::string> existing_names = {};  ///< The user's names of them, one each, or none.
  /// Scanners that each station chooses from, in their order, e.g. one model with finer and finer steps. Empty: the
  /// site's first.
  std::vector<Scanner> scanners = {};
  /// True: it is posed for scanners that detect every echo, as the method's are. The site's then do, unless its
  /// options say what they detect.
  bool every_echo = false;
  /// Lowest and highest height of the head above the search area, searched per station; empty: the scanner's height.
  std::optional<std::array<double, 2>> heights_m = std::nullopt;
  std::vector<Objective> objectives = {};  ///< At least one. One: the best network is searched; several: a front.
  /// Networks that violate one rank behind all that do not, by their violation.
  std::vector<Requirement> requirements = {};
  /// Least overlap of a link in reports and pictures.
  double link_overlap = default_link_overlap;
  RegistrationOptions registration = {};  ///< Surfaces that scans register on, and their accuracy.
  /// Searches in two steps. The first finds the fewest stations, of `stations_min` to `stations_max`, that meet the
  /// requirements on `coverage`, `capture`, `link` and `apart`. The second finds the best network of that number by the
  /// objectives under all requirements.
  bool fewest = false;
  /// Each station has to capture so much surface that the others do not, in m². A plan finds the number after which a
  /// further one would not. It adds one for each room and part of the floor that has none and where one adds a fifth of
  /// that at least. It requires what so many can `capture`, or a requirement's limit if that is more. Further stations
  /// that links need stay as long as they pay. If `stations_max` or a limit on the time on site ends it before, it
  /// requires only what its answer has.
  std::optional<double> pays_m2 = {};
  /// The same as a share of what the stations before it capture on average, of few as if they were
  /// `few_for_average`; the larger of both counts.
  double pays_share = 0;
  /// Attainable coverage (vantage/attainable.hpp), which `capture` is a share of: told by a plan's result where
  /// `capture` is asked for. A plan finds it anew, whatever is given.
  std::optional<double> attainable = std::nullopt;
  OnSiteOptions on_site = {};  ///< For the objective `time`, and the time on site that every plan tells.
  /// Number of targets to propose for the answer. Empty: as few as the predicted registration takes to meet its
  /// requirement and the class of accuracy, if `fewest` and the registration is a measure. 0: none.
  std::optional<std::size_t> targets = {};
  std::vector<Target> existing_targets = {};  ///< Targets and control points that are there.
  TargetOptions target = {};                  ///< Needs of a scan that measures a target, and places for new ones.

  /// Parameters of the built-in objectives for this problem.
  ObjectiveSettings settings() const;
};

/// The problem as named values: its settings, objectives, requirements and existing stations.
Settings settings(const SurveyProblem& problem);

/// The problems of table 2 of the method. This one has the objective coverage alone.
SurveyProblem coverage_fix(std::size_t stations);
/// Objectives coverage and overlap.
SurveyProblem coverage_overlap_fix(std::size_t stations);
/// Objectives coverage and number of stations.
SurveyProblem coverage_min(std::size_t stations_min, std::size_t stations_max);
/// Objectives coverage, overlap and number of stations.
SurveyProblem coverage_overlap_min(std::size_t stations_min, std::size_t stations_max);
/// The scalarised fitness of equation 1, a baseline.
SurveyProblem fitness_min(std::size_t stations_min, std::size_t stations_max, const FitnessWeights& weights = {});
/// A problem of `problem_names()`: "coverage-fix", "coverage-overlap-fix", "coverage-min", "coverage-overlap-min",
/// "fitness-min". Throws Error invalid_argument and lists the names; also if a -fix problem has a range or a -min
/// problem has none.
SurveyProblem survey_problem(std::string_view name, std::size_t stations_min, std::size_t stations_max);
std::span<const std::string> problem_names();  ///< Names that `survey_problem()` takes.
/// A problem of built-in objectives.
SurveyProblem survey_problem(std::span<const std::string> objectives, std::size_t stations_min,
                             std::size_t stations_max, double link_overlap = default_link_overlap);

/// Lets a site have the scanners that a problem is posed for, and returns the indices of those to choose from. `plan()`
/// calls it, too; called before the site's simulator is made, it spares setting that up twice. Throws Error as
/// `Site::place_of`.
std::vector<std::uint32_t> equip(Site& site, const SurveyProblem& problem);

/// Settings of a search.
struct PlanConfig {
  std::size_t population = 0;  ///< 0: with one objective 10, or 20 where the number is searched; else 100.
  /// Each has `population` evaluations. 0: 100; where the fewest stations are asked for, by the site, so that the
  /// search traces about twice as many stations as there are candidates.
  std::size_t iterations = 0;
  double sigma0 = 0.2;  ///< First step of the optimiser, as a share of the search area.
  /// Makes the optimiser of problems with several objectives; empty: MO-CMA-ES. A checkpoint is resumed only with the
  /// same one.
  OptimiserMaker optimiser = {};
  MoScheme scheme = MoScheme::steady_state;  ///< Scheme of MO-CMA-ES.
  std::size_t batch = 0;                     ///< Offspring at once in the steady state; 0: depends on the engine.
  bool exact = false;                        ///< Search with every ray, the slowest way; `sample_voxels` is then 0.
  /// Search with this many surveyed voxels; 0: depends on the problem and the site.
  std::uint64_t sample_voxels = 0;
  std::optional<double> sample_share = {};  ///< The same as a share of the surveyed voxels, above 0 and at most 1.
  /// Redraw the voxel sample every N iterations and re-evaluate the archive on it; at the end once more, on voxels that
  /// no choice depended on. Every ray then chooses the front from the archive, without networks that cannot be on it.
  /// 0: one sample for the whole search, whose values choose the front (docs/method.md). Empty: 20 for a front without
  /// a given sample, else 0.
  std::optional<std::size_t> renew_iterations = {};
  /// Head positions of an initial network: the first mean of CMA-ES, a first member of MO-CMA-ES; empty: random. If the
  /// number of stations is searched, the first N heads make a first member for each N up to their number.
  std::vector<Vec3> start = {};
  std::size_t redraws = 8;  ///< Attempts to redraw stations of a new network that are in holes or clashes.
  /// Time limit of the whole call, in seconds; 0: none. Looking, choosing and searching end early enough for tracing
  /// the results with every ray, the answer first: after eight tenths of it, or as it is measured. Entries not reached
  /// in time have `exact` false.
  double max_seconds = 0;
  /// Stops at this hypervolume, in [0, 1]. Empty: none.
  std::optional<double> target_hypervolume = std::nullopt;
  /// Stops when the hypervolume has not grown for this many iterations. 0: never.
  std::size_t stagnation_iterations = 0;
  std::optional<std::uint64_t> seed = {};  ///< Empty: that of the site.
  std::filesystem::path checkpoint = {};   ///< File to write; the one before stays as FILE.before. Empty: none.
  double checkpoint_seconds = 60;          ///< Interval between checkpoints.
  /// Continue from the checkpoint, or the one before; begin anew if there is none. Only limits (iterations, seconds,
  /// hypervolume, stagnation) may differ from the run that wrote it.
  bool resume = false;
};

/// All settings except a caller's own optimiser, and the checkpoint's, on which no result depends.
Settings settings(const PlanConfig& config);

/// One row for each setting of a search, except `start`, `seed`, `optimiser` and `checkpoint`.
const SettingTable<PlanConfig>& plan_settings();

/// One line of the history, an iteration each.
struct PlanIteration {
  std::size_t iteration = 0, evaluations = 0;  ///< Number of the iteration, from 1, and evaluations up to its end.
  double hypervolume = 0;                      ///< Hypervolume of the front, as `PlanResult::hypervolume`.
  /// Values that the optimiser minimised: `scaled_objectives()` of each network of the front.
  std::vector<std::vector<double>> front;
  double seconds = 0;  ///< Since the start; not reproducible.
};

/// Snapshot of a running plan.
struct PlanProgress {
  std::size_t iteration = 0, iterations = 0;  ///< Done and planned: iterations of a search, networks of a confirmation.
  std::uint64_t evaluations = 0;              ///< Networks evaluated so far.
  double hypervolume = 0, evaluations_per_second = 0;  ///< Figures of the search until now.
  double seconds_left = 0;                             ///< Below 0: not known yet.
  std::string phase;  ///< "look" (at attainable coverage), "choose", "search" or "confirm".
  /// The present front of the optimiser: decision vectors and `scaled_objectives()`, 1 and more if requirements are
  /// violated. Valid during the call.
  std::span<const ParetoPoint> front = {};
  /// Given once: attainable coverage, from `evaluations` places all over the ground.
  std::optional<double> attainable = std::nullopt;
  /// Given once for the fewest stations, when their number is about known: estimated time of all the rest, from the
  /// parts done so far.
  std::optional<double> whole_seconds_left = std::nullopt;
  /// Share of the phase that is done, where it is known better than by `iteration`: a network is confirmed ray by ray.
  std::optional<double> done = std::nullopt;
};

/// Values that the search minimises, in the order of `problem.objectives`: scaled values; α for the number of stations
/// if that is searched. `x`: decision vector; `values`: of the objectives.
std::vector<double> scaled_objectives(const SurveyProblem& problem, std::span<const double> x,
                                      std::span<const double> values);

}  // namespace vantage
