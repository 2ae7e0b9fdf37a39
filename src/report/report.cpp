// SPDX-License-Identifier: Apache-2.0
#include "report/report.hpp"

#include "map/front_view.hpp"
#include "plan/answer.hpp"
#include "vantage/export.hpp"

namespace vantage {
namespace {

ReportOptions titled(ReportOptions options, const Site& site) {
  if (options.title.empty()) options.title = site.name();
  return options;
}

std::vector<RoomFacts> rooms_of(const Report& report, const Scene& scene) {
  std::vector<RoomFacts> facts;
  const std::span<const Room> rooms = scene.rooms();
  if (!report.options.missed || report.options.missed->rooms.size() != rooms.size()) return facts;
  const Evaluation& network = report.shown();
  const std::vector<std::string> names = station_names(network.stations, network.names);
  const std::vector<std::vector<std::size_t>> in = stations_in_rooms(rooms, network.stations);
  for (std::size_t k = 0; k < rooms.size(); ++k) {
    const RoomShare& share = report.options.missed->rooms[k];
    RoomFacts& room = facts.emplace_back(RoomFacts{rooms[k].storey, rooms[k].name, floor_area(rooms[k])});
    if (share.share.voxels > 0) room.captured = share.share.share(WhyMissed::captured);
    for (const std::size_t station : in[k]) room.stations += (room.stations.empty() ? "" : ", ") + names[station];
    if (in[k].empty()) room.why = why_no_station(share);
  }
  return facts;
}

}  // namespace

Report report_of(const PlanResult& result, Site& site, const ReportOptions& options) {
  Report report{.options = titled(options, site),
                .crs = site.crs(),
                .question = problem_line(result.problem),
                .answer = answer(result),
                .requirements = advised_requirements(result),
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
  if (std::string planned = planned_text(result); !planned.empty())
    report.facts.insert(report.facts.begin(), {"planned", std::move(planned)});
  report.accuracy = accuracy_of(report.shown(), report.options.field, site.simulator());
  report.rooms = rooms_of(report, site.scene());
  report.ground = ground_lines(site.scene(), site.area(), report.shown().stations);
  report.again = again_lines(site.scene(), report.shown());
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
  report.rooms = rooms_of(report, site.scene());
  report.ground = ground_lines(site.scene(), site.area(), report.shown().stations);
  report.again = again_lines(site.scene(), report.shown());
  return report;
}

}  // namespace vantage
