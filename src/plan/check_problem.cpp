// SPDX-License-Identifier: Apache-2.0
#include "plan/check_problem.hpp"

#include <algorithm>

#include "core/parse.hpp"
#include "core/site_reach.hpp"
#include "evaluate/check_day.hpp"
#include "evaluate/sight_targets.hpp"
#include "objective/meshes_named.hpp"
#include "plan/limits.hpp"
#include "scene/scene_data.hpp"
#include "search/measures.hpp"
#include "site/room_windows.hpp"
#include "vantage/error.hpp"
#include "vantage/question.hpp"

namespace vantage {

void check_problem(const Site& site, const SurveyProblem& problem) {
  const Vec3 origin = site.scene().data().origin;
  check_settings(on_site_settings(), problem.on_site);
  check_day(problem.on_site, site.scanners());
  check_rooms(problem.on_site.windows, site.scene().rooms());
  check_settings(registration_settings(), problem.registration);
  check_settings(target_settings(), problem.target);
  check_number(problem.link_overlap, "link-overlap", kAnyShare);
  if (problem.pays_m2) {
    check_number(*problem.pays_m2, "pays", kPositive);
    check_number(problem.pays_share, "pays_share", kAnyShare);
    if (!problem.fewest || std::ranges::none_of(problem.requirements, requires_capture))
      throw Error(Errc::invalid_argument,
                  "pays: decides what the fewest stations have to capture; require some capture");
  }
  if (problem.attainable) check_number(*problem.attainable, "attainable", {.low = 0, .high = 1, .low_included = false});
  if (problem.heights_m)
    for (const double height : *problem.heights_m)
      check_number(height, "heights", {.low = 0, .high = kSiteReach_m, .low_included = false});
  for (const std::string& meshes : meshes_asked_for(problem)) meshes_named(site.scene(), meshes);
  for (const Requirement& requirement : problem.requirements)
    check_number(requirement.limit, "the limit of " + requirement.objective.name);
  for (std::size_t k = 0; k < problem.existing.size(); ++k)
    require_in_reach(problem.existing[k], origin, "existing station " + std::to_string(k + 1) + " stands");
  for (const Target& target : problem.existing_targets) check(target, origin);
  if (problem.on_site.entrance) require_in_reach(*problem.on_site.entrance, origin, "the entrance is");
}

void check_search(const Site& site, const PlanConfig& config) {
  check_settings(plan_settings(), config);
  for (const Vec3& head : config.start) require_in_reach(head, site.scene().data().origin, "start: a head is");
}

}  // namespace vantage
