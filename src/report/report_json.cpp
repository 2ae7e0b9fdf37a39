// SPDX-License-Identifier: Apache-2.0
#include "report/report_json.hpp"

#include "export/missed_colours.hpp"
#include "report/packed.hpp"
#include "vantage/summary.hpp"
#include "vantage/version.hpp"

namespace vantage {
namespace {

using nlohmann::ordered_json;

ordered_json known(double value) { return value == value ? ordered_json(value) : ordered_json(); }

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
  for (std::size_t k = 0; k < network.stations.size(); ++k) {
    const PlacedStation& s = network.stations[k];
    const bool placed = s.status != StationStatus::hole;
    stations.push_back({{"name", names[k]},
                        {"head", placed ? point_json(s.position) : ordered_json()},
                        {"ground", placed ? point_json(s.ground) : ordered_json()},
                        {"status", to_string(s.status)},
                        {"fault", explain(s.status)},
                        {"active", active(s)},
                        {"kept", s.kept},
                        {"points", network.exact && k < points.size() ? ordered_json(points[k]) : ordered_json()}});
  }
  return stations;
}

// A station between others is linked only to one of the same component; the only link between two components is a
// bridge.
ordered_json links_json(const StationLinks& links) {
  ordered_json json = ordered_json::array();
  const Connectivity graph = connectivity(links.values, links.least);
  for (std::size_t i = 0; i < links.values.size(); ++i)
    for (std::size_t j = i + 1; j < links.values.size(); ++j) {
      const double value = links.values(i, j);
      if (!(value > 0 && value >= links.least)) continue;
      const bool bridge = std::ranges::count(graph.bridges, std::pair(i, j)) > 0;
      const bool weakest = links.weakest == std::pair(i, j);
      json.push_back({{"a", i}, {"b", j}, {"value", value}, {"bridge", bridge}, {"weakest", weakest}});
    }
  return json;
}

}  // namespace

ordered_json network_json(const Evaluation& network, std::span<const Requirement> requirements) {
  ordered_json values, summary = ordered_json::array();
  for (const auto& [name, value] : network.values)
    values[name] = {{"value", known(value.value)}, {"error", value.standard_error}};
  for (const auto& [heading, text] : summary_lines(network, requirements))
    summary.push_back({{"heading", heading}, {"text", text}});
  ordered_json json = {{"confirmed", network.exact},
                       {"missed", known(network.violation)},
                       {"values", std::move(values)},
                       {"captured", network.value("coverage")},
                       {"of_visible", nullptr},
                       {"seconds_on_site", nullptr},
                       {"summary", std::move(summary)},
                       {"stations", stations_json(network)},
                       {"parts", nullptr}};
  if (network.values.contains("capture")) json["of_visible"] = network.value("capture");
  if (network.visit) json["seconds_on_site"] = 60 * network.visit->minutes;
  if (const auto links = network.links()) {
    json["parts"] = links->parts.size();
    json["link_measure"] = to_string(links->measure);
    json["least_link"] = links->least;
    json["links"] = links_json(*links);
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

ordered_json report_json(const Report& report) {
  ordered_json axes = ordered_json::array(), measures = axes, networks = axes;
  for (const Objective& axis : report.front_axes) axes.push_back(measure_json(axis));
  for (const Objective& measure : report.measures) measures.push_back(measure_json(measure));
  for (const Report::Network& network : report.networks) {
    networks.push_back(network_json(network.evaluation, report.requirements));
    networks.back()["dominated"] = network.dominated;
    for (const auto& [heading, text] : report.ground)
      networks.back()["summary"].push_back({{"heading", heading}, {"text", text}});
  }
  ordered_json& stations = networks[report.answer]["stations"];
  for (std::size_t k = 0; k < report.pictures.size(); ++k)
    if (!report.pictures[k].empty()) stations[k]["picture"] = base64(report.pictures[k]);
  return {{"title", report.options.title},     {"question", report.question},
          {"command", report.options.command}, {"version", version()},
          {"answer", report.answer},           {"axes", std::move(axes)},
          {"measures", std::move(measures)},   {"networks", std::move(networks)},
          {"missed", missed_json(report)},     {"parameters", ordered_json::parse(report.parameters)}};
}

}  // namespace vantage
