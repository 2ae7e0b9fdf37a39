// SPDX-License-Identifier: Apache-2.0
#include "plan/answer_targets.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "plan/confirm.hpp"
#include "vantage/candidates.hpp"
#include "vantage/targets.hpp"

namespace vantage {
namespace {

constexpr double kMillimetresPerMetre = 1000;

// Options for targets by a problem's requirements, in addition to its accuracy class.
TargetOptions options_of(const SurveyProblem& problem) {
  TargetOptions options = problem.target;
  options.exact = true;
  for (const Requirement& requirement : problem.requirements) {
    if (requirement.objective.name != "registration" || requirement.bound != Requirement::Bound::at_most) continue;
    const double limit_m = requirement.limit / kMillimetresPerMetre;
    if (limit_m > 0) options.largest_rms_m = std::min(limit_m, options.largest_rms_m.value_or(limit_m));
  }
  if (problem.targets) options.least = options.most = *problem.targets;
  return options;
}

}  // namespace

void add_targets(PlanResult& result, Site& site, const Measures& measures, const Progress& progress) {
  const SurveyProblem& problem = result.problem;
  PlanEntry& entry = result.front[answer(result)];
  if (!entry.exact || std::ranges::count_if(entry.stations, active) < 2) return;
  const TargetOptions options = options_of(problem);
  const auto known = entry.values.find("registration");
  const bool predicted = known != entry.values.end() && std::isfinite(known->second.value);
  const bool missed = predicted && known->second.value > kMillimetresPerMetre * allowed_rms_m(options);
  const bool wanted = problem.targets ? *problem.targets > 0 : problem.fewest && missed;
  if (!wanted && (problem.existing_targets.empty() || !predicted)) return;

  std::optional<TargetProposal> proposal =
      propose_targets(site, entry.stations, problem.registration, options, problem.existing_targets, progress);
  if (!proposal) return;
  entry.without_targets_m = proposal->without.rms_m;
  if (proposal->targets.empty()) return;
  entry.targets = std::move(proposal->targets);
  entry.values["registration"] = {kMillimetresPerMetre * proposal->with.rms_m, 0};
  if (const auto worst = entry.values.find("registration_worst"); worst != entry.values.end())
    worst->second = {kMillimetresPerMetre * proposal->with.worst_m, 0};
  entry.registration = std::move(proposal->with);
  result.exact_hypervolume = judge_by_every_ray(result.front, problem, measures);
}

}  // namespace vantage
