// SPDX-License-Identifier: Apache-2.0
#include "page/report.hpp"

#include "report/front_view.hpp"
#include "vantage/export.hpp"

namespace vantage {

Report report_of(const PlanResult& result, const Simulator& simulator) {
  Report report{.question = problem_line(result.problem),
                .answer = answer(result),
                .measures = result.measures,
                .parameters = run_parameters_json(simulator, &result)};
  if (result.problem.objectives.size() > 1) {
    const FrontView view(result);
    report.front_axes = {view.x(), view.y()};
    if (view.third()) report.front_axes.push_back(*view.third());
  }
  for (const PlanEntry& entry : result.front) {
    ReportNetwork network{.entry = entry, .names = station_names(entry.stations), .summary = summary_of(entry, result)};
    if (entry.confirmed)
      network.links =
          entry.exact_scan_overlap_matrix.size() > 0 ? entry.exact_scan_overlap_matrix : entry.exact_overlap_matrix;
    report.networks.push_back(std::move(network));
  }
  return report;
}

}  // namespace vantage
