// SPDX-License-Identifier: Apache-2.0
/// A surveyor's question, setting by setting, and the problem and plan made from it.
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

/// Defaults: new surface that a further station has to capture, in m² and as a share of the average of those before it,
/// and least distance between two stations. Lengths are of sites of usual size (`Site::length_scale()`).
inline constexpr double default_pays_m2 = 25, default_pays_share = 0.1, default_apart_m = 1;

/// A question. The default asks for the connected stations that pay: as many as capture `default_pays_m2` and
/// `default_pays_share` each.
struct SurveyQuestion {
  std::optional<std::string> problem = {};     ///< "survey", or one of `problem_names()`.
  std::optional<double> capture = {};          ///< Least share of attainable coverage, whatever it takes.
  std::optional<double> pays_m2 = {};          ///< Instead: as `SurveyProblem::pays_m2` alone.
  std::optional<double> link = {};             ///< Least scan overlap of the links that connect all stations.
  std::optional<double> apart_m = {};          ///< Least distance between two stations.
  std::optional<double> minutes_on_site = {};  ///< Upper limit.
  OnSiteOptions on_site = {};                  ///< As `SurveyProblem::on_site`.
  std::vector<std::string> objectives = {};    ///< Names; replace the problem's own.
  std::vector<std::string> requirements = {};  ///< In the form of `make_requirement()`.
  std::optional<std::array<std::size_t, 2>> stations = {};  ///< Least and largest number; one number twice.
  std::vector<Vec3> existing = {};                          ///< As `SurveyProblem::existing`.
  std::vector<StationSetup> existing_setups = {};           ///< One each, or none.
  std::vector<std::string> existing_names = {};             ///< One each, or none.
  /// Steps that each station chooses from: degrees ("0.1"), or settings of the site's preset ("6mm").
  std::vector<std::string> search_steps = {};
  std::optional<std::array<double, 2>> heights_m = {};  ///< Searched per station.
  std::optional<double> link_overlap = {};              ///< Least overlap (equation 11) of a link.
  std::optional<double> min_overlap = {};               ///< Required overlap of the links that connect all stations.
  std::optional<FitnessWeights> fitness = {};           ///< Weights of the scalarised fitness.
  RegistrationOptions registration = {};                ///< As `SurveyProblem::registration`.
  std::optional<std::size_t> targets = {};              ///< As `SurveyProblem::targets`.
  std::vector<Target> existing_targets = {};            ///< As `SurveyProblem::existing_targets`.
  TargetOptions target = {};                            ///< As `SurveyProblem::target`.

  /// True if it asks for the fewest stations.
  bool asks_for_fewest() const;
};

/// One row for each setting. `existing` and `existing_targets` have none: users give them in several ways.
const SettingTable<SurveyQuestion>& question_settings();

/// Makes the problem of a question on a site; rounds begin and end at the site's entrance. Throws Error
/// invalid_argument.
SurveyProblem survey_problem(const Site& site, const SurveyQuestion& question = {});

/// The surveyor's question: the fewest stations that capture so much of what is attainable, all linked along some
/// spanning tree by scan overlaps of at least `link`, `apart_m` or more from each other; then, at that number, the
/// least registration error.
SurveyProblem fewest_stations(double capture = 0.9, double link = 0.3, std::size_t stations_min = 1,
                              std::size_t stations_max = max_stations, double apart_m = 1);

/// Plans a survey of a site: `plan()` of the question's problem. Throws as that does.
PlanResult plan(Site& site, const SurveyQuestion& question = {}, const PlanConfig& config = {},
                const PlanWatch& watch = {});

}  // namespace vantage
