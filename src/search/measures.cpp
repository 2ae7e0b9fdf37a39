// SPDX-License-Identifier: Apache-2.0
#include "search/measures.hpp"

#include <algorithm>
#include <string>

#include "search/refuse.hpp"

namespace vantage {
namespace {

void check(const Objective& objective) {
  const auto plain = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  const std::string name =
      objective.meshes.empty() ? objective.name : objective.name.substr(0, objective.name.find('('));
  if (name.empty() || !std::ranges::all_of(name, plain))
    refuse("an objective is named by lower-case letters, digits and _, not \"" + objective.name + "\"");
  if (!objective.value) refuse("the objective " + objective.name + " has no value");
  if (!objective.scale.given())
    refuse("the objective " + objective.name + " has no scale; give it minimise(best, worst) or maximise(best, worst)");
}

// Its index; appends it if it is new.
std::size_t place_of(std::vector<Objective>& all, const Objective& objective) {
  check(objective);
  const auto found = std::find_if(all.begin(), all.end(), [&](const Objective& o) { return o.name == objective.name; });
  if (found != all.end()) return static_cast<std::size_t>(found - all.begin());
  all.push_back(objective);
  return all.size() - 1;
}

}  // namespace

RequiredInputs Measures::searched_needs() const { return required_inputs_of(std::span(all).first(searched)); }
RequiredInputs Measures::all_needs() const { return required_inputs_of(all); }

Measures measures_of(const SurveyProblem& problem) {
  if (problem.objectives.empty()) refuse("at least one objective is needed");
  Measures measures;
  for (std::size_t k = 0; k < problem.objectives.size(); ++k) {
    const std::string& name = problem.objectives[k].name;
    if (place_of(measures.all, problem.objectives[k]) != k) refuse("two objectives are named " + name);
  }
  for (const Requirement& requirement : problem.requirements)
    measures.required.push_back(place_of(measures.all, requirement.objective));
  measures.searched = measures.all.size();
  for (const char* told : {"coverage", "overlap"}) place_of(measures.all, make_objective(told, problem.settings()));
  if (problem.fewest) place_of(measures.all, make_objective("registration", problem.settings()));
  return measures;
}

double missed_by(const SurveyProblem& problem, const Measures& measures, std::span<const double> values) {
  double missed = 0;
  for (std::size_t k = 0; k < problem.requirements.size(); ++k)
    missed += problem.requirements[k].missed_by(values[measures.required[k]]);
  return missed;
}

bool asks_for(const SurveyProblem& problem, bool RequiredInputs::*input) {
  const auto needs = [&](const Objective& objective) { return objective.needs.*input; };
  return std::ranges::any_of(problem.objectives, needs) ||
         std::ranges::any_of(problem.requirements, needs, &Requirement::objective);
}

bool needs_attainable(const SurveyProblem& problem) { return asks_for(problem, &RequiredInputs::attainable); }

std::vector<std::string> meshes_asked_for(const SurveyProblem& problem) {
  std::vector<std::string> patterns;
  const auto add = [&](const Objective& objective) {
    if (!objective.meshes.empty()) patterns.push_back(objective.meshes);
  };
  std::ranges::for_each(problem.objectives, add);
  std::ranges::for_each(problem.requirements, add, &Requirement::objective);
  return patterns;
}

}  // namespace vantage
