// SPDX-License-Identifier: Apache-2.0
#include "report/report_json.hpp"

#include "export/missed_colours.hpp"
#include "report/packed.hpp"
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

ordered_json stations_json(const ReportNetwork& network) {
  ordered_json stations = ordered_json::array();
  const PlanEntry& entry = network.entry;
  for (std::size_t k = 0; k < entry.stations.size(); ++k) {
    const PlacedStation& s = entry.stations[k];
    const bool placed = s.status != StationStatus::hole;
    stations.push_back(
        {{"name", network.names[k]},
         {"head", placed ? point_json(s.position) : ordered_json()},
         {"ground", placed ? point_json(s.ground) : ordered_json()},
         {"status", to_string(s.status)},
         {"fault", explain(s.status)},
         {"active", active(s)},
         {"kept", s.kept},
         {"points", k < entry.points_on_surveyed.size() ? ordered_json(entry.points_on_surveyed[k]) : ordered_json()}});
    if (k < network.pictures.size() && !network.pictures[k].empty())
      stations.back()["picture"] = base64(network.pictures[k]);
  }
  return stations;
}

// A station between others is linked to a station of the same part only; what joins two parts of it alone is a bridge.
ordered_json links_json(const ReportNetwork& network) {
  ordered_json links = ordered_json::array();
  if (!network.summary.links) return links;
  const double least = network.summary.links->least;
  const Connectivity graph = connectivity(network.links, least);
  for (std::size_t i = 0; i < network.links.size(); ++i)
    for (std::size_t j = i + 1; j < network.links.size(); ++j) {
      const double value = network.links(i, j);
      if (!(value > 0 && value >= least)) continue;
      const bool bridge = std::ranges::count(graph.bridges, std::pair(i, j)) > 0;
      const bool weakest = network.summary.links->weakest == std::pair(i, j);
      links.push_back({{"a", i}, {"b", j}, {"value", value}, {"bridge", bridge}, {"weakest", weakest}});
    }
  return links;
}

}  // namespace

ordered_json network_json(const ReportNetwork& network) {
  const PlanEntry& entry = network.entry;
  ordered_json values, summary = ordered_json::array();
  for (const auto& [name, value] : entry.values)
    values[name] = {{"value", known(value.best_known())}, {"error", entry.confirmed ? 0 : value.standard_error}};
  for (const auto& [heading, text] : summary_lines(network.summary))
    summary.push_back({{"heading", heading}, {"text", text}});
  ordered_json json = {{"confirmed", entry.confirmed},         {"dominated", entry.dominated},
                       {"missed", known(entry.missed)},        {"values", std::move(values)},
                       {"captured", network.summary.captured}, {"of_visible", nullptr},
                       {"seconds_on_site", nullptr},           {"summary", std::move(summary)},
                       {"stations", stations_json(network)},   {"parts", nullptr}};
  if (network.summary.of_visible) json["of_visible"] = *network.summary.of_visible;
  if (network.summary.seconds_on_site) json["seconds_on_site"] = *network.summary.seconds_on_site;
  if (const auto& links = network.summary.links) {
    json["parts"] = links->parts.size();
    json["link_measure"] = links->measure;
    json["least_link"] = links->least;
    json["links"] = links_json(network);
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
  for (const MissedShare& share : report.missed) {
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
  for (const ReportNetwork& network : report.networks) networks.push_back(network_json(network));
  return {{"title", report.title},           {"question", report.question},
          {"command", report.command},       {"version", version()},
          {"answer", report.answer},         {"axes", std::move(axes)},
          {"measures", std::move(measures)}, {"networks", std::move(networks)},
          {"missed", missed_json(report)},   {"parameters", ordered_json::parse(report.parameters)}};
}

}  // namespace vantage
