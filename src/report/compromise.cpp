// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "vantage/error.hpp"
#include "vantage/export.hpp"

namespace vantage {

std::size_t compromise(const PlanResult& result, Problem problem) {
  if (result.front.empty()) throw Error(Errc::invalid_argument, "compromise: the front is empty");
  const bool overlap = problem == Problem::coverage_overlap_fix || problem == Problem::coverage_overlap_min;
  const bool stations = problem == Problem::coverage_min || problem == Problem::coverage_overlap_min;
  const auto gain = [&](const PlanEntry& entry) {
    double product = entry.confirmed ? entry.exact_coverage : entry.coverage;
    if (overlap) product *= entry.confirmed ? entry.exact_overlap : entry.overlap;
    if (stations && !entry.x.empty()) product *= 1 - entry.x.back();
    return product;
  };
  std::size_t best = 0;
  for (std::size_t k = 1; k < result.front.size(); ++k)
    if (gain(result.front[k]) > gain(result.front[best])) best = k;
  return best;
}

}  // namespace vantage
