// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "report/linked.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"

namespace vantage {

std::size_t compromise(const PlanResult& result, const PlanConfig& config) {
  if (result.front.empty()) throw Error(Errc::invalid_argument, "compromise: the front is empty");
  const Problem problem = config.problem;
  const bool overlap = problem == Problem::coverage_overlap_fix || problem == Problem::coverage_overlap_min;
  const bool stations = problem == Problem::coverage_min || problem == Problem::coverage_overlap_min;
  const auto gain = [&](const PlanEntry& entry) {
    double product = entry.confirmed ? entry.exact_coverage : entry.coverage;
    if (overlap) product *= entry.confirmed ? entry.exact_overlap : entry.overlap;
    if (stations && !entry.x.empty()) product *= 1 - entry.x.back();
    return product;
  };
  const auto rank = [&](const PlanEntry& entry) { return std::pair{overlap && linked(entry, config), gain(entry)}; };
  return static_cast<std::size_t>(std::ranges::max_element(result.front, {}, rank) - result.front.begin());
}

}  // namespace vantage
