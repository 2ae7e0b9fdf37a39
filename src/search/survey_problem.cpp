// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "core/closest_name.hpp"
#include "vantage/error.hpp"
#include "vantage/problem.hpp"

namespace vantage {
namespace {

using Names = std::vector<std::string>;

// Table 2, and the scalarised fitness.
struct Named {
  std::string name;
  Names objectives;
  bool searches_number;
};
const std::array<Named, 5>& named_problems() {
  static const std::array<Named, 5> all{{{"coverage-fix", {"coverage"}, false},
                                         {"coverage-overlap-fix", {"coverage", "overlap"}, false},
                                         {"coverage-min", {"coverage", "stations"}, true},
                                         {"coverage-overlap-min", {"coverage", "overlap", "stations"}, true},
                                         {"fitness-min", {"fitness"}, true}}};
  return all;
}

}  // namespace

ObjectiveSettings SurveyProblem::settings() const {
  return {.stations_min = stations_min,
          .stations_max = stations_max,
          .link_overlap = link_overlap,
          .registration = registration,
          .attainable = attainable.value_or(1)};
}

SurveyProblem survey_problem(std::span<const std::string> objectives, std::size_t stations_min,
                             std::size_t stations_max, double link_overlap) {
  SurveyProblem problem{.stations_min = stations_min, .stations_max = stations_max, .link_overlap = link_overlap};
  for (const std::string& name : objectives) problem.objectives.push_back(make_objective(name, problem.settings()));
  return problem;
}

SurveyProblem survey_problem(std::string_view name, std::size_t stations_min, std::size_t stations_max) {
  std::string known;
  for (const Named& one : named_problems()) {
    known += (known.empty() ? "" : ", ") + one.name;
    if (one.name != name) continue;
    if (!one.searches_number && stations_min != stations_max)
      throw Error(Errc::invalid_argument, one.name + " takes one number of stations, not " +
                                              std::to_string(stations_min) + " to " + std::to_string(stations_max) +
                                              "; a -min problem searches the number");
    if (one.searches_number && stations_min == stations_max)
      throw Error(Errc::invalid_argument, one.name + " searches the number of stations, so it takes a range, not " +
                                              std::to_string(stations_min) + " alone");
    SurveyProblem problem = survey_problem(one.objectives, stations_min, stations_max);
    problem.name = one.name;
    return problem;
  }
  throw Error(Errc::invalid_argument,
              "unknown problem \"" + std::string(name) + "\"; known: " + known + did_you_mean(name, problem_names()));
}

std::span<const std::string> problem_names() {
  static const Names names = [] {
    Names all;
    for (const Named& one : named_problems()) all.push_back(one.name);
    return all;
  }();
  return names;
}

SurveyProblem coverage_fix(std::size_t stations) { return survey_problem("coverage-fix", stations, stations); }
SurveyProblem coverage_overlap_fix(std::size_t stations) {
  return survey_problem("coverage-overlap-fix", stations, stations);
}
SurveyProblem coverage_min(std::size_t stations_min, std::size_t stations_max) {
  return survey_problem("coverage-min", stations_min, stations_max);
}
SurveyProblem coverage_overlap_min(std::size_t stations_min, std::size_t stations_max) {
  return survey_problem("coverage-overlap-min", stations_min, stations_max);
}
SurveyProblem fitness_min(std::size_t stations_min, std::size_t stations_max, const FitnessWeights& weights) {
  SurveyProblem problem = survey_problem("fitness-min", stations_min, stations_max);
  ObjectiveSettings settings = problem.settings();
  settings.fitness = weights;
  problem.objectives = {make_objective("fitness", settings)};
  return problem;
}

std::vector<std::uint32_t> equip(Site& site, const SurveyProblem& problem) {
  if (problem.every_echo) site.detect_every_echo();
  std::vector<std::uint32_t> places;
  for (const Scanner& scanner : problem.scanners) places.push_back(site.place_of(scanner));
  return places;
}

}  // namespace vantage
