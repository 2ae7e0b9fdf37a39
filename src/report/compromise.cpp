// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <tuple>

#include "report/linked.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"

namespace vantage {

std::size_t compromise(const PlanResult& result) {
  if (result.front.empty()) throw Error(Errc::invalid_argument, "compromise: the front is empty");
  const auto gain = [&](const PlanEntry& entry) {
    std::vector<double> values;
    for (const Objective& objective : result.problem.objectives) values.push_back(entry.value(objective.name));
    double product = 1;
    for (const double f : scaled_objectives(result.problem, entry.x, values)) product *= std::max(0.0, 1 - f);
    return product;
  };
  const bool links = links_matter(result);
  const auto rank = [&](const PlanEntry& entry) {
    return std::tuple{-entry.missed, links && linked(entry, result), gain(entry)};
  };
  return static_cast<std::size_t>(std::ranges::max_element(result.front, {}, rank) - result.front.begin());
}

}  // namespace vantage
