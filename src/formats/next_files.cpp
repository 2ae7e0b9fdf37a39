// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "core/json_text.hpp"
#include "core/options_json.hpp"
#include "core/text.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"
#include "vantage/next.hpp"
#include "vantage/version.hpp"

namespace vantage {
namespace {

using nlohmann::json;

json point_json(const Vec3& p) { return {p.x, p.y, p.z}; }
json box_json(const Box& box) { return {{"low", point_json(box.min)}, {"high", point_json(box.max)}}; }

json taken_json(const Day& day, const std::vector<std::string>& names) {
  json taken = json::array();
  for (std::size_t s = 0; s < day.scans.size(); ++s) {
    const TakenScan& scan = day.scans[s];
    taken.push_back({{"name", names[s]},
                     {"scan", scan.name},
                     {"sensor", scan.sensor},
                     {"position", point_json(scan.head)},
                     {"points", scan.points},
                     {"captured_alone", day.answer.captured_by[s]},
                     {"fitted", scan.fit.fitted},
                     {"shift", scan.fit.shift_m},
                     {"turn", scan.fit.turn.in_degrees()},
                     {"residual", scan.fit.residual_m},
                     {"near_model", scan.fit.near_share}});
    if (!scan.fit.fitted) taken.back()["why_not_fitted"] = scan.fit.why;
  }
  return taken;
}

json things_json(const Day& day) {
  json things = json::array();
  for (std::size_t k = 0; k < day.changes.things.size(); ++k) {
    const FoundThing& thing = day.changes.things[k];
    things.push_back({{"box", box_json(thing.box)},
                      {"points", thing.points},
                      {"scans", thing.scans},
                      {"hides", day.answer.hidden_by[k]}});
  }
  return things;
}

json passing_json(const SiteChanges& changes) {
  json passing = json::array();
  for (const FoundThing& thing : changes.passing)
    passing.push_back({{"box", box_json(thing.box)}, {"points", thing.points}});
  return passing;
}

json seen_through_json(const SiteChanges& changes) {
  json open = json::array();
  for (const SeenThrough& one : changes.seen_through)
    open.push_back(
        {{"node", one.mesh}, {"box", box_json(one.box)}, {"area", one.area_m2}, {"counts_as_open", one.removed}});
  return open;
}

json planned_json(const Day& day, const std::vector<std::string>& names) {
  json planned = json::array();
  for (std::size_t k = 0; k < day.planned.size(); ++k) {
    const PlannedStation& one = day.answer.planned[k];
    planned.push_back({{"name", day.planned_names[k]},
                       {"status", to_string(one.status)},
                       {"taken", one.taken_as ? json(names[*one.taken_as]) : json()},
                       {"adds", one.gain},
                       {"next", one.chosen}});
  }
  return planned;
}

json stations_json(const Day& day, const std::vector<std::string>& names) {
  json next = json::array();
  for (std::size_t k = 0; k < day.answer.next.size(); ++k) {
    const NextStation& one = day.answer.next[k];
    next.push_back({{"name", names[day.scans.size() + k]},
                    {"position", point_json(one.station.position)},
                    {"ground", point_json(one.station.ground)},
                    {"planned", one.planned.has_value()},
                    {"adds", one.gain},
                    {"captured_then", one.captured},
                    {"linked_to", one.linked_to ? json(names[*one.linked_to]) : json()},
                    {"ties", one.ties ? json(names[*one.ties]) : json()},
                    {"overlap", one.overlap}});
  }
  return next;
}

}  // namespace

std::string next_json(const Day& day, const Site& found) {
  const NextAnswer& answer = day.answer;
  const std::vector<std::string> names = day.names();
  Settings all = found.settings();
  const Settings own = settings(day.config);
  all.insert(all.end(), own.begin(), own.end());
  const json text{{"captured", answer.captured.value},
                  {"captured_se", answer.captured.standard_error},
                  {"attainable", answer.attainable.value},
                  {"attainable_se", answer.attainable.standard_error},
                  {"not_seen", answer.not_seen},
                  {"unknown", answer.unknown},
                  {"captured_then", answer.captured_then},
                  {"enough", answer.enough},
                  {"linked", answer.linked},
                  {"minutes_on_site", answer.next.empty() ? 0 : answer.visit.minutes},
                  {"candidates", answer.candidates},
                  {"taken", taken_json(day, names)},
                  {"not_in_model", things_json(day)},
                  {"passing", passing_json(day.changes)},
                  {"seen_through", seen_through_json(day.changes)},
                  {"planned", planned_json(day, names)},
                  {"next", stations_json(day, names)},
                  {"seed", found.simulator_config().seed},
                  {"options", options_json(all)},
                  {"version", version()}};
  return json_text(text, 2) + "\n";
}

void write_next(const std::filesystem::path& folder, const Day& day, Site& found) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) throw Error(Errc::io, folder.string() + ": the folder cannot be made: " + failure.message());
  write_text(folder / "next.json", next_json(day, found));
  const std::vector<PlacedStation> all = day.stations();
  const std::vector<std::string> names = day.names();
  const auto next = std::span(all).subspan(day.scans.size());
  const auto next_names = std::span(names).subspan(day.scans.size());
  write_stations_csv(folder / "stations.csv", next, found.scanners(), next_names);
  if (!next.empty()) write_stations(folder / "stations.dxf", next, next_names, {}, found);
  draw_plan_view(
      folder / "plan.png", found, all, {},
      "Captured " + percent(day.answer.captured.value) + "; next: " + (next.empty() ? "nothing" : next_names.front()),
      names);
}

}  // namespace vantage
