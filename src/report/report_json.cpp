// SPDX-License-Identifier: Apache-2.0
#include "report/report_json.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/read_file.hpp"
#include "core/text.hpp"
#include "formats/run_json.hpp"
#include "formats/station_json.hpp"
#include "map/missed_colours.hpp"
#include "map/shown_links.hpp"
#include "report/packed.hpp"
#include "report/station_facts.hpp"
#include "vantage/image.hpp"
#include "vantage/summary.hpp"
#include "vantage/version.hpp"

namespace vantage {
namespace {

using nlohmann::ordered_json;

ordered_json measure_json(const Objective& measure) {
  return {{"name", measure.name},
          {"label", measure.label},
          {"unit", measure.unit},
          {"best", known(measure.scale.best)},
          {"worst", known(measure.scale.worst)},
          {"count", measure.by_alpha}};
}

ordered_json stations_json(const Evaluation& network) {
  ordered_json stations = ordered_json::array();
  const std::vector<std::string> names = station_names(network.stations, network.names);
  const std::vector<std::uint64_t>& points = network.counts.points_on_surveyed;
  const std::vector<KnownPoints> known_points = vantage::known_points(network);
  for (std::size_t k = 0; k < network.stations.size(); ++k) {
    const PlacedStation& s = network.stations[k];
    ordered_json station = station_json<ordered_json>(s, names[k]);
    station["fault"] = explain(s.status);
    station["active"] = active(s);
    station["points_on_surveyed"] = network.exact && k < points.size() ? ordered_json(points[k]) : ordered_json();
    if (!known_points.empty()) add_set_up(station, known_points[k], network);
    stations.push_back(std::move(station));
  }
  return stations;
}

// Links per station up to which a page has all. With more it has the strongest of each station, tree and bridges.
constexpr std::size_t kLinksOfEach = 8;

std::vector<ShownLink> told_links(const StationLinks& network) {
  std::vector<ShownLink> links = links_of(network);
  const std::size_t stations = network.values.size();
  if (links.size() <= kLinksOfEach * stations) return links;
  std::ranges::stable_sort(links, std::ranges::greater{}, &ShownLink::overlap);
  std::vector<std::size_t> told(stations, 0);
  std::erase_if(links, [&](const ShownLink& link) {
    const bool strong = told[link.a] < kLinksOfEach / 2 || told[link.b] < kLinksOfEach / 2;
    if (strong) ++told[link.a], ++told[link.b];
    return !strong && !link.tree && !link.bridge;
  });
  return links;
}

ordered_json links_json(const StationLinks& network) {
  ordered_json json = ordered_json::array();
  for (const ShownLink& link : told_links(network))
    json.push_back({{"a", link.a},
                    {"b", link.b},
                    {"value", link.overlap},
                    {"bridge", link.bridge},
                    {"tree", link.tree},
                    {"weakest", network.weakest == std::pair(link.a, link.b)}});
  return json;
}

// Number of other stations that each station is linked to.
std::vector<std::size_t> link_counts(const StationLinks& network) {
  std::vector<std::size_t> counts(network.values.size(), 0);
  for (const ShownLink& link : links_of(network)) ++counts[link.a], ++counts[link.b];
  return counts;
}

// A round with its stations' indices in the network, and its paths over the ground, to the centimetre.
ordered_json round_json(const Round& round, std::size_t kept) {
  ordered_json order = ordered_json::array(), ways = order;
  for (const std::size_t station : round.order) order.push_back(kept + station);
  for (const std::vector<Vec3>& path : round.paths) {
    ordered_json way = ordered_json::array();
    for (const Vec3& p : path)
      for (const double v : {p.x, p.y, p.z}) way.push_back(std::round(100 * v) / 100);
    ways.push_back(std::move(way));
  }
  return {{"order", std::move(order)},  {"legs_m", round.legs_m},         {"walk_m", round.walk_m},
          {"scan_min", round.scan_min}, {"set_up_min", round.set_up_min}, {"photos_min", round.photos_min},
          {"walk_min", round.walk_min}, {"minutes", round.minutes},       {"ways", std::move(ways)}};
}

ordered_json visit_json(const Evaluation& network, std::size_t kept) {
  const Visit& visit = *network.visit;
  ordered_json json = round_json(visit, kept);
  if (visit.sessions.empty()) return json;
  // No crew walks the whole round.
  json["ways"] = ordered_json::array();
  for (const Session& session : visit.sessions) {
    ordered_json one = {{"day", session.day}, {"crew", session.crew}, {"links", session_links(session, network)}};
    one.update(round_json(session, kept));
    one["clock"] = clock_text(session.start_min) + "–" + clock_text(session.start_min + session.minutes);
    one["batteries"] = batteries_text(session);
    one["waiting_min"] = session.waiting_min, one["begin"] = ordered_json::array();
    for (const double arrive : session.arrive_min) one["begin"].push_back(clock_text(session.start_min + arrive));
    json["sessions"].push_back(std::move(one));
  }
  return json;
}

// Targets, with the indices of stations in the network.
ordered_json targets_json(const std::vector<Target>& targets) {
  ordered_json json = ordered_json::array();
  for (const Target& target : targets)
    json.push_back({{"name", target.name},
                    {"position", point_json(target.centre)},
                    {"sigma_m", target.control_m > 0 ? ordered_json(target.control_m) : ordered_json()},
                    {"proposed", target.proposed},
                    {"check", target.check},
                    {"stations", target.stations}});
  return json;
}

}  // namespace

ordered_json network_json(const Evaluation& network, std::span<const Requirement> requirements) {
  ordered_json values;
  for (const auto& [name, value] : network.values)
    values[name] = {{"value", known(value.value)}, {"standard_error", value.standard_error}};
  ordered_json json = {{"confirmed", network.exact},
                       {"missed", known(network.violation)},
                       {"values", std::move(values)},
                       {"coverage", network.value("coverage")},
                       {"captured", nullptr},
                       {"random_mm", nullptr},
                       {"minutes_on_site", nullptr},
                       {"summary", lines_json(summary_lines(network, requirements))},
                       {"stations", stations_json(network)},
                       {"visit", nullptr},
                       {"parts", nullptr}};
  if (network.visit && !network.visit->order.empty())
    json["visit"] = visit_json(network, existing_count(network.stations));
  json["targets"] = targets_json(network.targets);
  if (network.values.contains("capture")) json["captured"] = known(network.value("capture"));
  if (network.registration) json["random_mm"] = 1e3 * network.registration->random_m;
  if (network.visit) json["minutes_on_site"] = network.visit->minutes;
  if (const auto links = network.links()) {
    json["parts"] = links->parts.size();
    json["link_measure"] = to_string(links->measure);
    json["least_link"] = links->least;
    json["links"] = links_json(*links);
    const std::vector<std::size_t> counts = link_counts(*links);
    for (std::size_t k = 0; k < counts.size(); ++k) json["stations"][k]["linked"] = counts[k];
    json["all_links"] = std::accumulate(counts.begin(), counts.end(), std::size_t{0}) / 2;
  }
  return json;
}

namespace {

ordered_json missed_json(const Report& report) {
  ordered_json reasons = ordered_json::array(), nodes = ordered_json::array();
  for (std::size_t k = 0; k < why_missed_count; ++k) {
    const MissedStyle& style = missed_style(static_cast<WhyMissed>(k));
    const auto [r, g, b] = to_bytes(style.colour);
    reasons.push_back({{"name", to_string(style.why)}, {"words", style.words}, {"rgb", {r, g, b}}});
  }
  for (const MissedShare& share : report.options.missed ? report.options.missed->shares : std::vector<MissedShare>()) {
    ordered_json shares = ordered_json::array();
    for (std::size_t k = 0; k < why_missed_count; ++k) shares.push_back(share.share(static_cast<WhyMissed>(k)));
    nodes.push_back({{"node", share.node}, {"voxels", share.voxels}, {"shares", std::move(shares)}});
  }
  return {{"reasons", std::move(reasons)}, {"nodes", std::move(nodes)}};
}

}  // namespace

namespace {

ordered_json trade_off_json(const std::vector<TradeOffPoint>& points) {
  ordered_json json = ordered_json::array();
  for (const TradeOffPoint& point : points) {
    const auto registered = point.values.find("registration");
    json.push_back(
        {{"stations", point.stations.size()},
         {"capture", known(point.values.at("capture").value)},
         {"capture_se", point.values.at("capture").standard_error},
         {"registration", registered == point.values.end() ? ordered_json() : known(registered->second.value)},
         {"minutes_on_site", point.minutes_on_site ? ordered_json(*point.minutes_on_site) : ordered_json()},
         {"answer", point.answer},
         {"knee", point.knee}});
  }
  return json;
}

ordered_json accuracy_json(const Report& report) {
  if (!report.accuracy) return nullptr;
  ordered_json rows = ordered_json::array();
  for (const PlaceAccuracy& place : report.accuracy->places)
    rows.push_back({{"name", place.name},
                    {"mean_mm", 1000 * place.mean_m},
                    {"worst_mm", 1000 * place.worst_m},
                    {"beyond", place.beyond}});
  const AccuracyClass wanted = report.shown().accuracy_class;
  return {{"by", report.accuracy->by_room ? "room" : "mesh"},
          {"class", to_string(wanted)},
          {"allowed_mm", 1000 * largest_error_m(wanted)},
          {"rows", std::move(rows)}};
}

ordered_json rooms_json(const std::vector<RoomFacts>& rooms) {
  ordered_json rows = ordered_json::array();
  for (const RoomFacts& room : rooms)
    rows.push_back({{"storey", room.storey},
                    {"name", room.name},
                    {"floor_m2", room.floor_m2},
                    {"captured", room.captured ? ordered_json(*room.captured) : ordered_json()},
                    {"stations", room.stations},
                    {"why_no_station", room.why}});
  return rows;
}

// Elements by missed area, largest first; the page has only the first ones.
ordered_json elements_json(std::span<const ElementShare> elements) {
  constexpr std::size_t kMost = 1000;
  std::vector<const ElementShare*> judged;
  for (const ElementShare& one : elements)
    if (one.captured) judged.push_back(&one);
  std::ranges::stable_sort(judged, std::ranges::greater{},
                           [](const ElementShare* one) { return one->area_m2 * (1 - *one->captured); });
  ordered_json rows = ordered_json::array();
  const auto value = [](const std::optional<double>& known, double factor) {
    return known ? ordered_json(factor * *known) : ordered_json();
  };
  for (std::size_t k = 0; k < std::min(kMost, judged.size()); ++k) {
    const ElementShare& one = *judged[k];
    rows.push_back({{"name", one.name},
                    {"area_m2", one.area_m2},
                    {"captured", *one.captured},
                    {"incidence", one.incidence ? ordered_json(one.incidence->in_degrees()) : ordered_json()},
                    {"point_distance_mm", value(one.point_distance_m, 1000)},
                    {"deviation_mm", value(one.deviation_m, 1000)}});
  }
  return {{"all", judged.size()}, {"rows", std::move(rows)}};
}

// Returns a picture as a data URL; empty if there is none.
std::string logo_json(const std::filesystem::path& file) {
  if (file.empty()) return "";
  read_image(file);  // refuses what is no picture
  const std::string bytes = read_file(file);
  const bool png = bytes.starts_with("\x89PNG");
  const auto* first = reinterpret_cast<const std::uint8_t*>(bytes.data());
  return std::string("data:image/") + (png ? "png" : "jpeg") + ";base64," + base64({first, bytes.size()});
}

}  // namespace

ordered_json report_json(const Report& report) {
  ordered_json axes = ordered_json::array(), measures = axes, networks = axes;
  ordered_json facts = ordered_json::array();
  for (const auto& [heading, text] : report.facts) facts.push_back({{"heading", heading}, {"text", text}});
  for (const Objective& axis : report.front_axes) axes.push_back(measure_json(axis));
  for (const Objective& measure : report.measures) measures.push_back(measure_json(measure));
  for (const Report::Network& network : report.networks) {
    networks.push_back(network_json(network.evaluation, report.requirements));
    networks.back()["dominated"] = network.dominated;
    for (ordered_json& line : lines_json(report.ground)) networks.back()["summary"].push_back(std::move(line));
  }
  for (ordered_json& line : lines_json(report.again)) networks[report.answer]["summary"].push_back(std::move(line));
  ordered_json& stations = networks[report.answer]["stations"];
  for (std::size_t k = 0; k < report.pictures.size(); ++k)
    if (!report.pictures[k].empty()) stations[k]["picture"] = base64(report.pictures[k]);
  for (std::size_t k = 0; k < networks.size(); ++k)  // a page draws one round
    if (k != report.answer && !networks[k]["visit"].is_null()) networks[k]["visit"]["ways"] = ordered_json::array();
  return {{"title", report.options.title},
          {"question", report.question},
          {"command", report.options.command},
          {"version", version()},
          {"facts", std::move(facts)},
          {"date", report.options.date},
          {"crs", report.crs},
          {"logo", logo_json(report.options.logo)},
          {"answer", report.answer},
          {"axes", std::move(axes)},
          {"measures", std::move(measures)},
          {"networks", std::move(networks)},
          {"missed", missed_json(report)},
          {"accuracy", accuracy_json(report)},
          {"rooms", rooms_json(report.rooms)},
          {"elements", elements_json(report.options.elements)},
          {"trade_off", trade_off_json(report.trade_off)},
          {"registration_jump", registration_jump_text(report.trade_off)},
          {"parameters", ordered_json::parse(report.parameters)}};
}

}  // namespace vantage
