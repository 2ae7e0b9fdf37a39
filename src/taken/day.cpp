// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/part_of.hpp"
#include "vantage/evaluation.hpp"
#include "vantage/taken_scans.hpp"

namespace vantage {

std::vector<std::string> Day::names() const {
  std::vector<std::string> given;
  for (std::size_t s = 0; s < scans.size(); ++s) {
    const auto plan = std::ranges::find(answer.planned, std::optional(s), &PlannedStation::taken_as);
    if (plan != answer.planned.end()) {
      given.push_back(planned_names[static_cast<std::size_t>(plan - answer.planned.begin())]);
      continue;
    }
    given.push_back(scans[s].name);
    if (std::ranges::find(planned_names, scans[s].name) != planned_names.end()) given.back() += ", taken";
  }
  std::size_t fresh = 0;
  for (const NextStation& next : answer.next)
    given.push_back(next.planned ? planned_names[*next.planned] : "N" + std::to_string(++fresh));
  return station_names(stations(), given);
}

std::vector<PlacedStation> Day::stations() const {
  std::vector<PlacedStation> all = answer.taken;
  for (const NextStation& one : answer.next) all.push_back(one.station);
  return all;
}

bool find_changes(Site& site, Day& day, const Progress& progress) {
  if (day.config.unknown) {
    for (TakenScan& scan : day.scans) scan.fit.why = "is the site itself, and keeps its pose";
    day.changes.unknown = unknown_space(site, day.scans);
    return !progress.stopped();
  }
  if (!fit_to_model(site, day.scans, day.config.tolerance_m, between(progress, 0, 0.4))) return false;
  day.changes = changes_of(site, day.scans, day.config.tolerance_m, between(progress, 0.4, 1));
  return !progress.stopped();
}

}  // namespace vantage
