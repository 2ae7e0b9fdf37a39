// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "core/text.hpp"
#include "plan/limits.hpp"
#include "vantage/error.hpp"
#include "vantage/planner.hpp"

namespace vantage {
namespace {

bool looks_at_pairs(const SurveyProblem& problem) {
  return std::ranges::any_of(problem.objectives, [](const Objective& objective) { return objective.needs.pairs; });
}

bool hangs_together(const PlanEntry& entry, const SurveyProblem& problem) {
  return entry.confirmed && connectivity(entry.exact_overlap_matrix, problem.link_overlap).parts == 1;
}

// Whether all that can be seen was never looked at, though a requirement is a share of it.
bool look_cut_short(const PlanResult& result) {
  return result.candidates && result.candidates->ended() == "cancelled" &&
         std::ranges::any_of(result.problem.requirements,
                             [](const Requirement& requirement) { return requirement.objective.name == "capture"; });
}

// Of the scaled objectives to the best values of all of them. Unknown ones are as bad as the worst.
double distance(const PlanEntry& entry, const SurveyProblem& problem) {
  std::vector<double> values;
  for (const Objective& objective : problem.objectives) values.push_back(entry.value(objective.name));
  double sum = 0;
  for (const double f : scaled_objectives(problem, entry.x, values)) sum += std::isnan(f) ? 1 : f * f;
  return std::sqrt(sum);
}

}  // namespace

std::size_t answer(const PlanResult& result) {
  if (result.front.empty()) throw Error(Errc::invalid_argument, "answer: the front is empty");
  const SurveyProblem& problem = result.problem;
  const bool required = !problem.requirements.empty();
  const bool links = !required && looks_at_pairs(problem);
  const auto rank = [&](const PlanEntry& entry) {
    const std::size_t stations = problem.fewest && entry.missed == 0 ? entry.stations.size() : 0;
    return std::tuple{entry.missed, stations, links && !hangs_together(entry, problem), distance(entry, problem)};
  };
  return static_cast<std::size_t>(std::ranges::min_element(result.front, {}, rank) - result.front.begin());
}

bool met(const PlanResult& result) {
  if (result.front.empty()) return false;
  const PlanEntry& entry = result.front[answer(result)];
  return entry.missed == 0 && (result.problem.requirements.empty() || entry.confirmed) && !look_cut_short(result);
}

std::vector<std::string> what_would_help(const PlanResult& result) {
  std::vector<std::string> help;
  if (result.front.empty() || met(result)) return help;
  const PlanEntry& entry = result.front[answer(result)];
  const SurveyProblem& problem = result.problem;
  if (look_cut_short(result))
    help.push_back(
        "more time: the look at what can be seen was cut short, so that capture is a share of less than that");
  if (entry.missed == 0) {
    if (!entry.confirmed)
      help.push_back("more time: no network was traced with every ray, so that what is told is an estimate");
    return help;
  }
  const std::size_t placed = entry.stations.size() - problem.kept.size();
  const bool more = placed < std::min(problem.stations_max, max_stations - problem.kept.size());
  for (const Requirement& requirement : problem.requirements) {
    const double value = entry.value(requirement.objective.name);
    if (requirement.missed_by(value) == 0) continue;
    const std::string& name = requirement.objective.name;
    const std::string reached = std::isnan(value) ? "unknown" : fixed(value, 3);
    if (name == "capture" || name == "coverage") {
      if (placed >= problem.stations_max)
        help.push_back("more stations than " + std::to_string(problem.stations_max) + " for " + to_string(requirement) +
                       "; these reach " + reached);
      else if (const auto most = limit_of(problem, "time", Requirement::Bound::at_most))
        help.push_back("more time than " + number(*most) + " min on site, or a lower " + name + " than " +
                       number(requirement.limit) + "; this reaches " + reached);
      else
        help.push_back("a lower " + name + " than " + number(requirement.limit) + "; this reaches " + reached +
                       (problem.visible && name == "coverage" && requirement.limit > *problem.visible
                            ? ", and all allowed positions together see no more than " + fixed(*problem.visible, 3)
                            : ""));
    } else if (name == "link") {
      help.push_back(value > 0
                         ? "a lower link than " + number(requirement.limit) + "; this reaches " + reached
                         : std::string("doors or passages that scans can share, or a survey in parts: the network "
                                       "falls into parts that share no surface"));
    } else if (name == "time") {
      help.push_back("more time than " + number(requirement.limit) +
                     " min on site, a faster setting of the scanner, or "
                     "a lower capture; this takes " +
                     fixed(value, 0) + " min");
    } else {
      help.push_back("another limit than " + to_string(requirement) + "; this reaches " + reached +
                     (more ? ", or more stations" : ""));
    }
  }
  return help;
}

}  // namespace vantage
