// SPDX-License-Identifier: Apache-2.0
/// What a surveyor asks of a site, setting by setting, and the problem and plan that come of it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "vantage/planner.hpp"
#include "vantage/settings.hpp"
#include "vantage/site.hpp"

namespace vantage {

/// Least coverage of what is attainable, and least distance between two stations, where nothing else is asked for.
inline constexpr double default_capture = 0.9, default_apart_m = 1;

/// A question. With nothing given it asks for the fewest stations that capture and link enough.
struct SurveyQuestion {
  std::optional<std::string> problem = {};     ///< "survey", or one of `problem_names()`.
  std::optional<double> capture = {};          ///< Share of the attainable coverage.
  std::optional<double> link = {};             ///< Least scan overlap along some spanning tree.
  std::optional<double> apart_m = {};          ///< Least distance between two stations.
  std::optional<double> minutes_on_site = {};  ///< At most.
  OnSiteOptions on_site = {};
  std::vector<std::string> objectives = {};                 ///< Names, in place of the problem's own.
  std::vector<std::string> requirements = {};               ///< As `make_requirement()` takes them.
  std::optional<std::array<std::size_t, 2>> stations = {};  ///< Fewest and most; one number twice.
  std::vector<Vec3> kept = {};                              ///< As `SurveyProblem::kept`.
  std::vector<StationSetup> kept_setups = {};               ///< One each, or none.
  /// Steps that each station chooses from: degrees ("0.1"), or settings of the site's preset ("6mm").
  std::vector<std::string> search_steps = {};
  std::optional<std::array<double, 2>> heights_m = {};  ///< Searched per station.
  std::optional<double> link_overlap = {};              ///< Overlap (equation 11) from which on stations are linked.
  std::optional<double> min_overlap = {};               ///< Wanted of every link, with all stations linked.
  std::optional<FitnessWeights> fitness = {};           ///< Of the scalarised fitness.
  RegistrationOptions registration = {};

  /// Whether it asks for the fewest stations.
  bool asks_for_fewest() const;
};

/// One row a setting. Existing stations (`kept`) have none: they are typed in several ways.
const SettingTable<SurveyQuestion>& question_settings();
const SettingTable<RegistrationOptions>& registration_settings();
const SettingTable<OnSiteOptions>& on_site_settings();
/// Those of a search. `start` and `checkpoint` have none.
const SettingTable<PlanConfig>& plan_settings();

/// The problem that a question comes to on a site. The scanners of `search_steps` join those of the site; rounds begin
/// and end where one enters it. Throws Error invalid_argument.
SurveyProblem survey_problem(Site& site, const SurveyQuestion& question = {});

/// Plans a survey of a site. What `config` leaves open is chosen by the problem: sample, iterations, seed. Same site,
/// problem and configuration: same result but for seconds. Throws Error: invalid_argument (no objective, more than
/// `max_stations` stations, min above max, a checkpoint of another run, …), malformed_file (a damaged checkpoint) and
/// what the simulator and the objectives throw; the checkpoint is written before an exception leaves.
PlanResult plan(Site& site, const SurveyProblem& problem, const PlanConfig& config = {}, const PlanWatch& watch = {});
PlanResult plan(Site& site, const SurveyQuestion& question = {}, const PlanConfig& config = {},
                const PlanWatch& watch = {});

/// `config` with everything chosen that it leaves open, for a site of so many surveyed voxels.
PlanConfig settled(const PlanConfig& config, const SurveyProblem& problem, std::uint64_t voxels, std::uint64_t seed);

}  // namespace vantage
