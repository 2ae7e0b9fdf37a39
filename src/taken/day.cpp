// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "vantage/evaluation.hpp"
#include "vantage/taken_scans.hpp"

namespace vantage {

std::vector<std::string> Day::names() const {
  std::vector<std::string> given;
  for (std::size_t s = 0; s < scans.size(); ++s) {
    const auto plan = std::ranges::find(answer.planned, std::optional(s), &PlannedStation::taken_as);
    given.push_back(plan == answer.planned.end()
                        ? scans[s].name
                        : planned_names[static_cast<std::size_t>(plan - answer.planned.begin())]);
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

}  // namespace vantage
