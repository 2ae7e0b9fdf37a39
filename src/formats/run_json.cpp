// SPDX-License-Identifier: Apache-2.0
#include "formats/run_json.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "core/json_text.hpp"
#include "core/options_json.hpp"
#include "formats/station_json.hpp"
#include "vantage/candidates.hpp"
#include "vantage/export.hpp"
#include "vantage/summary.hpp"
#include "vantage/version.hpp"
#include "words/station_cells.hpp"

namespace vantage {
namespace {

using nlohmann::ordered_json;

ordered_json to_json(const Vec3& v) { return {v.x, v.y, v.z}; }

ordered_json scene_json(const Scene& scene) {
  char fingerprint[17];
  std::snprintf(fingerprint, sizeof fingerprint, "%016llx", static_cast<unsigned long long>(scene.fingerprint()));
  std::size_t surveyed = 0;
  for (const MeshInfo& mesh : scene.meshes()) surveyed += mesh.role == Role::surveyed ? 1 : 0;
  const Box box = scene.bounds();
  return {{"fingerprint", fingerprint},
          {"triangles", scene.triangle_count()},
          {"meshes", scene.meshes().size()},
          {"surveyed_meshes", surveyed},
          {"bounds", {to_json(box.min), to_json(box.max)}},
          {"options", settings_json(settings(scene.options()))}};
}

ordered_json scanner_json(const Scanner& scanner) {
  ordered_json json = settings_json(settings(scanner));
  json["rays"] = scanner.rays();
  return json;
}

ordered_json plan_json(const PlanResult& result) {
  ordered_json json = settings_json(settings(result.problem));
  json.update(settings_json(settings(result.config)));
  json["population_used"] = result.population, json["batch_used"] = result.batch;
  return json;
}

// Returns the links that registration depends on. Stations are numbered from 1, as in the tables and pictures.
ordered_json links_json(const PairMatrix& overlap, double min_overlap) {
  const Connectivity graph = connectivity(overlap, min_overlap);
  ordered_json bridges = ordered_json::array();
  for (const auto& [i, j] : graph.bridges) bridges.push_back({i + 1, j + 1});
  ordered_json json = {
      {"min_overlap", min_overlap}, {"parts", graph.parts}, {"bridges", std::move(bridges)}, {"weakest", nullptr}};
  if (graph.parts == 1 && overlap.size() > 1)
    json["weakest"] = {{"stations", {graph.weakest_link.first + 1, graph.weakest_link.second + 1}},
                       {"overlap", graph.weakest_overlap}};
  return json;
}

// Pairs that glass alone keeps from linking two parts, and links between storeys that nobody walks along. Stations are
// numbered from 1.
void add_ties(ordered_json& json, const Evaluation& evaluation) {
  if (const auto links = evaluation.links())
    for (const StationLinks::Gap& gap : links->through_glass)
      json["through_glass"].push_back({{"stations", {gap.inside + 1, gap.outside + 1}},
                                       {"scan_overlap", evaluation.scan_overlap_matrix(gap.inside, gap.outside)},
                                       {"through_glass", gap.value}});
  for (const StoreyTie& tie : evaluation.storey_ties)
    json["storey_ties"].push_back(
        {{"stations", {tie.a + 1, tie.b + 1}}, {"overlap", tie.value}, {"apart_m", tie.apart_m}, {"way_m", tie.way_m}});
}

ordered_json batteries_json(const std::vector<BatteryUse>& uses) {
  ordered_json json = ordered_json::array();
  for (const BatteryUse& use : uses) {
    ordered_json one{{"instrument", use.instrument}};
    if (use.battery_min > 0) one["battery_min"] = use.battery_min;
    if (use.battery_scans > 0) one["battery_scans"] = use.battery_scans;
    one["on_min"] = use.on_min, one["scans"] = use.scans;
    one["batteries"] = use.batteries, one["in_a_day"] = use.in_a_day;
    json.push_back(std::move(one));
  }
  return json;
}

// Stations are numbered from 1, in the order of visiting.
ordered_json round_json(const Round& round, std::size_t kept) {
  ordered_json order = ordered_json::array();
  for (const std::size_t station : round.order) order.push_back(kept + station + 1);
  return {{"order", std::move(order)},      {"minutes", round.minutes},         {"scan_min", round.scan_min},
          {"set_up_min", round.set_up_min}, {"photos_min", round.photos_min},   {"walk_min", round.walk_min},
          {"walk_m", round.walk_m},         {"unconnected", round.unconnected}, {"unlinked", round.unlinked}};
}

ordered_json sessions_json(const std::vector<Session>& sessions, std::size_t kept) {
  ordered_json json = ordered_json::array();
  for (const Session& session : sessions) {
    ordered_json one = {{"day", session.day}, {"crew", session.crew}};
    one.update(round_json(session, kept));
    one["start"] = clock_text(session.start_min);
    one["arrive_min"] = session.arrive_min;
    one["wait_min"] = session.wait_min;
    one["parts"] = session.parts, one["linked"] = session.linked;
    if (!session.batteries.empty()) one["batteries"] = batteries_json(session.batteries);
    json.push_back(std::move(one));
  }
  return json;
}

// Stations that no session can scan within the access windows of their rooms.
ordered_json closed_json(const std::vector<ClosedStation>& closed, std::size_t kept) {
  ordered_json json = ordered_json::array();
  for (const ClosedStation& one : closed) json.push_back({{"station", kept + one.station + 1}, {"why", one.why}});
  return json;
}

ordered_json matrix_json(const PairMatrix& matrix) {
  ordered_json rows = ordered_json::array();
  for (std::size_t i = 0; i < matrix.size(); ++i) rows.push_back(matrix.row(i));
  return rows;
}

ordered_json data_json(const ScanData& data) {
  return {{"points", std::round(data.points)},
          {"e57_bytes", std::round(data.e57_bytes)},
          {"las_bytes", std::round(data.las_bytes)}};
}

ordered_json registration_json(const RegistrationError& error, const Estimate& whole_mm) {
  const auto mm = [](const Vec3& v) { return ordered_json{1e3 * v.x, 1e3 * v.y, 1e3 * v.z}; };
  ordered_json stations = ordered_json::array();
  for (const StationError& station : error.stations)
    stations.push_back({{"error_mm", 1e3 * station.rms_m},
                        {"head_axes_mm", {mm(station.axes[0]), mm(station.axes[1]), mm(station.axes[2])}}});
  return {{"error_mm", whole_mm.value},
          {"standard_error_mm", whole_mm.standard_error},
          {"random_mm", 1e3 * error.random_m},
          {"worst_mm", 1e3 * error.worst_m},
          {"worst_station", error.worst_station + 1},
          {"stations", std::move(stations)}};
}

// Stations are numbered from 1.
ordered_json targets_json(const std::vector<Target>& targets) {
  ordered_json json = ordered_json::array();
  for (const Target& target : targets) {
    ordered_json stations = ordered_json::array();
    for (const std::size_t station : target.stations) stations.push_back(station + 1);
    json.push_back({{"name", target.name},
                    {"position", to_json(target.centre)},
                    {"sigma_m", target.control_m > 0 ? ordered_json(target.control_m) : ordered_json()},
                    {"proposed", target.proposed},
                    {"stations", std::move(stations)}});
    if (target.check) json.back()["check"] = true;
  }
  return json;
}

ordered_json dropped_json(const std::vector<DroppedPoints>& dropped) {
  const DroppedPoints all = std::accumulate(dropped.begin(), dropped.end(), DroppedPoints{});
  return {{"points", all.points},
          {"incidence", all.incidence},
          {"footprint", all.footprint},
          {"noise", all.noise},
          {"echo", all.echo}};
}

ordered_json sum_json(const std::vector<MixedPoints>& mixed) {
  return mixed_json(std::accumulate(mixed.begin(), mixed.end(), MixedPoints{}));
}

// `number`: of the entry, from 1.
ordered_json entry_json(const PlanEntry& entry, std::size_t number, const PlanResult& result,
                        std::span<const Scanner> scanners) {
  ordered_json stations = ordered_json::array();
  const auto names = station_names(entry.stations, entry.names);
  const std::vector<KnownPoints> known_points = vantage::known_points(entry);
  const bool setups = tells_setups(entry.stations) || !result.problem.scanners.empty();
  for (std::size_t i = 0; i < entry.stations.size(); ++i) {
    ordered_json station = station_json<ordered_json>(entry.stations[i], names[i]);
    if (setups) add_setup(station, entry.stations[i].setup, scanners);
    if (entry.exact && i < entry.counts.points_on_surveyed.size())
      station["points_on_surveyed"] = entry.counts.points_on_surveyed[i];
    if (!known_points.empty()) add_set_up(station, known_points[i], entry);
    stations.push_back(std::move(station));
  }
  ordered_json json{{"entry", number}}, exact, values;
  for (const Objective& measure : result.measures) {
    const Estimate& searched = entry.searched.at(measure.name);
    values[measure.name] = {{"searched", known(searched.value)},
                            {"standard_error", searched.standard_error},
                            {"exact", entry.exact ? known(entry.value(measure.name)) : ordered_json()}};
    if (entry.exact && (measure.needs.attainable || measure.needs.registration))  // of a sample even then
      values[measure.name]["exact_standard_error"] = entry.values.at(measure.name).standard_error;
  }
  for (const char* always : {"coverage", "overlap"}) {
    const Estimate& searched = entry.searched.at(always);
    json[always] = known(searched.value);
    json[std::string(always) + "_se"] = searched.standard_error;
    exact[always] = known(entry.value(always));
  }
  exact["dominated"] = entry.dominated;
  json["station_count"] = entry.stations.size();
  json["values"] = std::move(values);
  json["missed"] = known(entry.violation);
  json["exact"] = entry.exact ? std::move(exact) : ordered_json();
  json["stations"] = std::move(stations);
  json["x"] = entry.x;
  if (entry.exact) json["links"] = links_json(entry.overlap_matrix, result.problem.link_overlap);
  if (entry.scan_overlap_matrix.size() > 0) json["scan_links"] = links_json(entry.scan_overlap_matrix, 0);
  add_ties(json, entry);
  if (!entry.targets.empty()) json["targets"] = targets_json(entry.targets);
  if (any_ties(entry.targets)) {
    json["registration_mm"] = {{"with_targets", entry.value("registration")},
                               {"without_targets", known(1e3 * entry.without_targets_m.value_or(std::nan("")))}};
    if (entry.registration && entry.registration->absolute_rms_m)
      json["registration_mm"]["in_site_frame"] = 1e3 * *entry.registration->absolute_rms_m;
  }
  if (entry.data) json["data"] = data_json(*entry.data);
  if (entry.visit) {
    const std::size_t kept = result.problem.existing.size();
    json["on_site"] = round_json(*entry.visit, kept);
    if (const auto uses = batteries_of(*entry.visit); !uses.empty())
      json["on_site"]["batteries"] = batteries_json(uses);
    if (!entry.visit->sessions.empty()) json["on_site"]["sessions"] = sessions_json(entry.visit->sessions, kept);
    if (!entry.visit->not_split.empty()) json["on_site"]["not_split"] = entry.visit->not_split;
    if (entry.visit->bound > 0) json["on_site"]["closed"] = closed_json(entry.visit->closed, kept);
  }
  return json;
}

ordered_json trade_off_json(const std::vector<TradeOffPoint>& points) {
  ordered_json json = ordered_json::array();
  for (const TradeOffPoint& point : points) {
    ordered_json positions = ordered_json::array(), one{{"stations", point.stations.size()}};
    for (const PlacedStation& station : point.stations) positions.push_back(to_json(station.position));
    for (const auto& [name, value] : point.values)
      one[name] = known(value.value), one[name + "_se"] = value.standard_error;
    one["minutes_on_site"] = point.minutes_on_site ? ordered_json(*point.minutes_on_site) : ordered_json();
    one["answer"] = point.answer, one["knee"] = point.knee;
    one["positions"] = std::move(positions);
    json.push_back(std::move(one));
  }
  return json;
}

}  // namespace

ordered_json to_json(const Work& work) {
  ordered_json json;
  Work::for_each([&](const char* name, auto member) { json[name] = work.*member; });
  return json;
}

ordered_json lines_json(std::span<const SummaryLine> lines) {
  ordered_json json = ordered_json::array();
  for (const auto& [heading, text] : lines) json.push_back({{"heading", heading}, {"text", text}});
  return json;
}

ordered_json mixed_json(const MixedPoints& mixed) {
  return {{"points", mixed.points}, {"counted", mixed.counted}, {"wrong_voxel", mixed.wrong_voxel}};
}

ordered_json run_parameters(const Simulator& simulator, const PlanResult* result) {
  ordered_json json = {{"version", version()},
                       {"engine", to_string(simulator.engine().engine)},
                       {"device", simulator.engine().device},
                       {"driver", simulator.engine().driver},
                       {"scene", scene_json(simulator.scene())},
                       {"scanner", scanner_json(simulator.scanner())},
                       {"simulation", settings_json(settings(simulator.config()))},
                       {"voxels", simulator.voxel_count()},
                       {"voxel_size_m", simulator.voxel_size_m()},
                       {"goal_density", simulator.goal_density()}};
  if (simulator.scanners().size() > 1)
    for (const Scanner& scanner : simulator.scanners()) json["scanners"].push_back(scanner_json(scanner));
  if (!result) return json;
  json["walkable"] = settings_json(settings(result->walkable));
  json["security"] = settings_json(settings(result->security));
  json["plan"] = plan_json(*result);
  return json;
}

std::string run_parameters_json(const Simulator& simulator, const PlanResult* result) {
  return json_text(run_parameters(simulator, result), 2);
}

ordered_json floor_json(const Scene& scene, const SearchArea& area, std::span<const PlacedStation> stations) {
  ordered_json parts = ordered_json::array(), closed = parts, entered = parts;
  for (const FloorPart& part : floor_parts(scene, area, stations))
    parts.push_back({{"kind", to_string(part.kind)},
                     {"name", part.name},
                     {"area_m2", part.area_m2},
                     {"place", to_json(part.place)},
                     {"stations", part.stations}});
  const auto closed_part = [](const ClosedPart& part) {
    return ordered_json{{"area_m2", part.area_m2},      {"share", part.share},        {"place", to_json(part.place)},
                        {"kind", to_string(part.kind)}, {"bar", to_string(part.bar)}, {"height_m", part.height_m},
                        {"doors", part.doors}};
  };
  for (const ClosedPart& part : area.not_entered()) closed.push_back(closed_part(part));
  for (const ClosedPart& part : area.entered()) entered.push_back(closed_part(part));
  return {{"on_plane", area.on_plane()},
          {"parts", std::move(parts)},
          {"closed", std::move(closed)},
          {"entered", std::move(entered)}};
}

std::string evaluation_json(const Evaluation& evaluation) {
  ordered_json json = {{"summary", lines_json(summary_lines(evaluation))},
                       {"coverage", evaluation.value("coverage")},
                       {"coverage_se", evaluation.values.at("coverage").standard_error},
                       {"overlap", nullptr},
                       {"overlap_se", nullptr},
                       {"overlap_matrix", nullptr},
                       {"scan_overlap_matrix", nullptr},
                       {"attainable", nullptr},
                       {"attainable_se", nullptr},
                       {"captured", nullptr},
                       {"captured_se", nullptr},
                       {"minutes_on_site", nullptr},
                       {"dropped", nullptr},
                       {"mixed", nullptr},
                       {"voxels", evaluation.voxels},
                       {"goal_density", evaluation.goal_density},
                       {"rays", evaluation.counts.rays},
                       {"work", to_json(evaluation.work)},
                       {"sample", nullptr}};
  if (const auto overlap = evaluation.values.find("overlap"); overlap != evaluation.values.end()) {
    json["overlap"] = overlap->second.value, json["overlap_se"] = overlap->second.standard_error;
    json["overlap_matrix"] = matrix_json(evaluation.overlap_matrix);
  }
  if (evaluation.scan_overlap_matrix.size() > 0)
    json["scan_overlap_matrix"] = matrix_json(evaluation.scan_overlap_matrix);
  add_ties(json, evaluation);
  if (evaluation.attainable)
    json["attainable"] = evaluation.attainable->value, json["attainable_se"] = evaluation.attainable->standard_error;
  if (const auto capture = evaluation.values.find("capture"); capture != evaluation.values.end())
    json["captured"] = capture->second.value, json["captured_se"] = capture->second.standard_error;
  if (evaluation.data) json["data"] = data_json(*evaluation.data);
  if (evaluation.visit) json["minutes_on_site"] = evaluation.visit->minutes;
  if (evaluation.visit)
    if (const auto uses = batteries_of(*evaluation.visit); !uses.empty()) json["batteries"] = batteries_json(uses);
  const std::size_t existing = existing_count(evaluation.stations);
  if (evaluation.visit && !evaluation.visit->sessions.empty())
    json["sessions"] = sessions_json(evaluation.visit->sessions, existing);
  if (evaluation.visit && evaluation.visit->bound > 0) json["closed"] = closed_json(evaluation.visit->closed, existing);
  if (evaluation.registration)
    json["registration"] = registration_json(*evaluation.registration, evaluation.values.at("registration"));
  if (!evaluation.targets.empty()) json["targets"] = targets_json(evaluation.targets);
  if (any_ties(evaluation.targets) && evaluation.without_targets_m && evaluation.registration)
    json["registration"]["without_targets_mm"] = 1e3 * *evaluation.without_targets_m;
  if (!evaluation.exact) json["sample"] = evaluation.counts.voxels;
  if (!evaluation.counts.dropped.empty()) json["dropped"] = dropped_json(evaluation.counts.dropped);
  if (!evaluation.counts.mixed.empty()) json["mixed"] = sum_json(evaluation.counts.mixed);
  return json_text(json);
}

std::string front_json(const PlanResult& result, const Simulator& simulator) {
  ordered_json front = ordered_json::array(), objectives = front;
  for (const PlanEntry& entry : result.front)
    front.push_back(entry_json(entry, front.size() + 1, result, simulator.scanners()));
  for (const Objective& objective : result.problem.objectives) objectives.push_back(objective.name);
  ordered_json json = {{"problem", result.problem.name},     {"objectives", std::move(objectives)},
                       {"hypervolume", result.hypervolume},  {"exact_hypervolume", known(result.exact_hypervolume)},
                       {"evaluations", result.evaluations},  {"stations_drawn", result.drawn},
                       {"stations_redrawn", result.redrawn}, {"stop_reason", to_string(result.stop_reason)}};
  if (!result.front.empty()) {
    const std::size_t chosen = answer(result);
    json["answer"] = chosen + 1;
    json["met"] = met(result);
    json["what_would_help"] = what_would_help(result);
    json["summary"] = lines_json(summary_lines(result));
    if (result.scene && result.area)
      json["floor"] = floor_json(*result.scene, *result.area, result.front[chosen].stations);
  }
  if (result.candidates) {
    const Estimate attainable = result.attainable.value_or(result.candidates->attainable());
    json["attainable"] = {{"coverage", attainable.value},
                          {"standard_error", attainable.standard_error},
                          {"last_doubling", result.candidates->change()},
                          {"candidates", result.candidates->stations().size()},
                          {"candidates_ended", result.candidates->ended()}};
  }
  if (result.pays)
    json["pays"] = {{"least_m2", result.pays->least_m2},
                    {"stations", result.pays->stations},
                    {"parts", result.pays->parts},
                    {"capture", result.pays->capture},
                    {"next_m2", result.pays->next_m2}};
  if (result.further) json["further"] = {{"m2", result.further->m2}, {"minutes", result.further->minutes}};
  if (!result.trade_off.empty()) json["trade_off"] = trade_off_json(result.trade_off);
  json["front"] = std::move(front);
  json["seconds"] = {{"total", result.seconds}, {"trace", result.trace_seconds}};
  json["work"] = to_json(result.work);
  json["engine"] = to_string(simulator.engine().engine);
  json["device"] = simulator.engine().device;
  json["seed"] = result.config.seed.value_or(1);
  json["version"] = version();
  json["parameters"] = run_parameters(simulator, &result);
  return json_text(json, 2) + "\n";
}

}  // namespace vantage
