// SPDX-License-Identifier: Apache-2.0
#include "plan/answer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <tuple>

#include "core/text.hpp"
#include "plan/limits.hpp"
#include "vantage/candidates.hpp"
#include "vantage/error.hpp"
#include "vantage/planner.hpp"

namespace vantage {
namespace {

bool looks_at_pairs(const SurveyProblem& problem) {
  return std::ranges::any_of(problem.objectives, [](const Objective& objective) { return objective.needs.pairs; });
}

bool hangs_together(const PlanEntry& entry, const SurveyProblem& problem) {
  return entry.exact && connectivity(entry.overlap_matrix, problem.link_overlap).parts == 1;
}

// True if the count of what is attainable was cut short, though a requirement is a share of it.
bool look_cut_short(const PlanResult& result) {
  return result.candidates && result.candidates->ended() == "cancelled" &&
         std::ranges::any_of(result.problem.requirements,
                             [](const Requirement& r) { return r.objective.needs.attainable; });
}

// Distance of the scaled objectives from the best values. Unknown ones count as the worst.
double distance(const PlanEntry& entry, const SurveyProblem& problem) {
  std::vector<double> values;
  for (const Objective& objective : problem.objectives) values.push_back(entry.value(objective.name));
  double sum = 0;
  for (const double f : scaled_objectives(problem, entry.x, values)) sum += std::isnan(f) ? 1 : f * f;
  return std::sqrt(sum);
}

// True if sessions keep all access windows, as far as rounds are known.
bool keeps_windows(const PlanEntry& entry) { return closed_stations(entry) == 0; }

bool all_placed(const PlanResult& result) {
  const std::size_t placed = result.front[answer(result)].stations.size() - result.problem.existing.size();
  return placed >= result.problem.stations_max;
}

}  // namespace

std::vector<Requirement> advised_requirements(const PlanResult& result) {
  std::vector<Requirement> requirements = result.problem.requirements;
  if (result.front.empty() || (all_placed(result) && result.problem.stations_max < max_stations)) return requirements;
  constexpr std::string_view kMore = "allow more stations, or ";
  for (Requirement& requirement : requirements)
    if (std::string& advice = requirement.objective.advice; advice.starts_with(kMore)) advice.erase(0, kMore.size());
  return requirements;
}

std::size_t answer(std::span<const PlanEntry> front, const SurveyProblem& problem) {
  const bool required = !problem.requirements.empty();
  const bool links = !required && looks_at_pairs(problem);
  const auto rank = [&](const PlanEntry& entry) {
    const std::size_t stations = problem.fewest && entry.violation == 0 ? entry.stations.size() : 0;
    return std::tuple{entry.violation, stations, links && !hangs_together(entry, problem), distance(entry, problem)};
  };
  return static_cast<std::size_t>(std::ranges::min_element(front, {}, rank) - front.begin());
}

std::size_t answer(const PlanResult& result) {
  if (result.front.empty()) throw Error(Errc::invalid_argument, "answer: the front is empty");
  return answer(result.front, result.problem);
}

bool requires_what_pays(const PlanResult& result, const Requirement& requirement) {
  return result.pays && requires_capture(requirement) && requirement.limit == result.pays->capture;
}

bool met(const PlanResult& result) {
  if (result.front.empty()) return false;
  const PlanEntry& entry = result.front[answer(result)];
  return entry.violation == 0 && (result.problem.requirements.empty() || entry.exact) && !look_cut_short(result) &&
         keeps_windows(entry);
}

std::vector<std::string> what_would_help(const PlanResult& result) {
  std::vector<std::string> help;
  if (result.front.empty() || met(result)) return help;
  const PlanEntry& entry = result.front[answer(result)];
  const SurveyProblem& problem = result.problem;
  if (look_cut_short(result))
    help.push_back("more time: the look at attainable coverage was cut short, so capture is a share of too little");
  if (!keeps_windows(entry))
    help.push_back("other access windows, or another day: " + std::to_string(entry.visit->closed.size()) + " of " +
                   std::to_string(entry.visit->bound) + " stations that they are for are in no session");
  if (entry.violation == 0) {
    if (!entry.exact && !problem.requirements.empty())
      help.push_back("more time: no network was traced with every ray, so the figures are estimates");
    return help;
  }
  const auto minutes = limit_of(problem, Objective::Kind::time, Requirement::Bound::at_most);
  for (const Requirement& requirement : advised_requirements(result)) {
    const Objective& objective = requirement.objective;
    const double value = entry.value(objective.name);
    if (requirement.missed_by(entry.estimate(objective.name)) == 0) continue;
    const bool ended_early = result.stop_reason == StopReason::max_time || result.stop_reason == StopReason::cancelled;
    if (requires_what_pays(result, requirement) && !ended_early) {
      help.push_back("not met: what pays is " + percent(requirement.limit) +
                     " of what is attainable, and stations with such links capture " + percent(value) +
                     "; allow weaker links, or tie the rest by targets");
      continue;
    }
    help.push_back(advice(requirement, value, ended_early));
    if (objective.kind != Objective::Kind::coverage || ended_early) continue;
    if (all_placed(result))
      help.back() += "; it takes more stations than " + std::to_string(problem.stations_max);
    else if (minutes)
      help.back() += "; it takes more time than " + number(*minutes) + " min on site";
    else if (problem.attainable && requirement.limit * objective.coverage_of_one > *problem.attainable)
      help.back() += "; no more than " + fixed(*problem.attainable, 3) + " is attainable from one station at a time";
  }
  return help;
}

}  // namespace vantage
