// SPDX-License-Identifier: Apache-2.0
#include "report/report.hpp"

#include "export/front_view.hpp"
#include "vantage/export.hpp"

namespace vantage {
namespace {

ReportOptions titled(ReportOptions options, const Site& site) {
  if (options.title.empty()) options.title = site.name();
  return options;
}

}  // namespace

Report report_of(const PlanResult& result, Site& site, const ReportOptions& options) {
  Report report{.options = titled(options, site),
                .crs = site.crs(),
                .question = problem_line(result.problem),
                .answer = answer(result),
                .requirements = result.problem.requirements,
                .measures = result.measures,
                .trade_off = result.trade_off,
                .parameters = run_parameters_json(site.simulator(), &result)};
  if (result.problem.objectives.size() > 1) {
    const FrontView view(result);
    report.front_axes = {view.x(), view.y()};
    if (view.third()) report.front_axes.push_back(*view.third());
  }
  for (const PlanEntry& entry : result.front) report.networks.push_back({entry, entry.dominated});
  report.facts = report_facts(report, site.simulator());
  report.accuracy = accuracy_of(report.shown(), report.options.field, site.simulator());
  return report;
}

Report report_of(const Evaluation& evaluation, Site& site, const ReportOptions& options) {
  const std::size_t stations = evaluation.stations.size();
  Report report{.options = titled(options, site),
                .crs = site.crs(),
                .question = std::to_string(stations) + (stations == 1 ? " station" : " stations") + ", as given",
                .networks = {{evaluation}},
                .parameters = run_parameters_json(site.simulator())};
  for (const std::string& name : objective_names())
    if (evaluation.values.contains(name)) report.measures.push_back(make_objective(name));
  if (!report.options.field && !evaluation.field.count.empty()) report.options.field = &evaluation.field;
  report.facts = report_facts(report, site.simulator());
  report.accuracy = accuracy_of(report.shown(), report.options.field, site.simulator());
  return report;
}

}  // namespace vantage
