// SPDX-License-Identifier: Apache-2.0
#include "plan/drop_networks.hpp"

#include <algorithm>
#include <utility>

namespace vantage {
namespace {

// Keeps the entries for which the condition holds, unless it holds for none.
template <class Holds>
void prefer(std::vector<PlanEntry>& entries, const Holds& holds) {
  if (std::ranges::any_of(entries, holds))
    std::erase_if(entries, [&](const PlanEntry& entry) { return !holds(entry); });
}

}  // namespace

bool same_places(const PlanEntry& a, const PlanEntry& b) {
  return std::ranges::equal(a.stations, b.stations, {}, &PlacedStation::position, &PlacedStation::position);
}

void drop_unplaced(std::vector<PlanEntry>& entries, std::size_t kept) {
  prefer(entries, [&](const PlanEntry& entry) {
    const auto first = entry.stations.begin() + static_cast<std::ptrdiff_t>(std::min(kept, entry.stations.size()));
    return std::all_of(first, entry.stations.end(),
                       [](const PlacedStation& station) { return station.status == StationStatus::ok; });
  });
}

void drop_networks(std::vector<PlanEntry>& front, const SurveyProblem& problem) {
  if (std::ranges::count(problem_names(), problem.name) > 0) return;
  std::vector<PlanEntry> left;
  for (PlanEntry& entry : front)
    if (std::ranges::none_of(left, [&](const PlanEntry& other) { return same_places(entry, other); }))
      left.push_back(std::move(entry));
  drop_unplaced(left, problem.existing.size());
  for (const Requirement& requirement : problem.requirements)
    if (const Objective& objective = requirement.objective; objective.kind == Objective::Kind::distance)
      prefer(left, [&](const PlanEntry& entry) { return requirement.missed_by(entry.value(objective.name)) == 0; });
  front = std::move(left);
}

}  // namespace vantage
