// SPDX-License-Identifier: Apache-2.0
#include "report/report.hpp"

#include "export/front_view.hpp"
#include "vantage/export.hpp"

namespace vantage {

Report report_of(const PlanResult& result, const Simulator& simulator, const ReportOptions& options) {
  Report report{.options = options,
                .question = problem_line(result.problem),
                .answer = answer(result),
                .requirements = result.problem.requirements,
                .measures = result.measures,
                .trade_off = result.trade_off,
                .parameters = run_parameters_json(simulator, &result)};
  if (result.problem.objectives.size() > 1) {
    const FrontView view(result);
    report.front_axes = {view.x(), view.y()};
    if (view.third()) report.front_axes.push_back(*view.third());
  }
  for (const PlanEntry& entry : result.front) report.networks.push_back({entry, entry.dominated});
  report.facts = report_facts(report, simulator);
  return report;
}

Report report_of(const Evaluation& evaluation, const Simulator& simulator, const ReportOptions& options) {
  const std::size_t stations = evaluation.stations.size();
  Report report{.options = options,
                .question = std::to_string(stations) + (stations == 1 ? " station" : " stations") + ", as given",
                .networks = {{evaluation}},
                .parameters = run_parameters_json(simulator)};
  for (const std::string& name : objective_names())
    if (evaluation.values.contains(name)) report.measures.push_back(make_objective(name));
  if (!report.options.field && !evaluation.field.count.empty()) report.options.field = &evaluation.field;
  report.facts = report_facts(report, simulator);
  return report;
}

}  // namespace vantage
