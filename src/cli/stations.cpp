// SPDX-License-Identifier: Apache-2.0
#include "cli/stations.hpp"

#include <spdlog/spdlog.h>

#include <cmath>

#include "cli/options.hpp"

namespace vantage::cli {
namespace {

std::optional<Vec3> vec3_of(const nlohmann::json& value) {
  if (!value.is_array() || value.size() != 3) return std::nullopt;
  return Vec3{value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

std::optional<Uv> uv_of(const nlohmann::json& value) {
  if (!value.is_array() || value.size() != 2) return std::nullopt;
  return Uv{value[0].get<double>(), value[1].get<double>()};
}

std::vector<StationText> read_front(const std::string& file, std::uint64_t entry) {
  const auto front = read_json(file);
  try {
    const auto& entries = front.at("front");
    if (entry >= entries.size())
      throw Error(Errc::invalid_argument, "--entry: " + std::to_string(entry) + " is not in " + file + ", which has " +
                                              std::to_string(entries.size()) + " entries, counted from 0");
    std::vector<StationText> stations;
    for (const auto& station : entries[entry].at("stations")) {
      StationText text{vec3_of(station.value("position", nlohmann::json())),
                       uv_of(station.value("uv", nlohmann::json()))};
      if (station.value("status", "ok") == "hole") text.position.reset();
      if (!text.position && !text.uv)
        throw Error(Errc::malformed_file, file + ": a station has neither position nor uv");
      stations.push_back(text);
    }
    return stations;
  } catch (const nlohmann::json::exception& error) {
    throw Error(Errc::malformed_file, file + ": is not a plan's front.json: " + error.what());
  }
}

}  // namespace

void StationOptions::add(CLI::App& command) {
  add_values(command, "--station", "X,Y,Z|U,V",
             "A station: the scanner's head, or a point of the search area; may be repeated",
             [this](const std::string& text, const std::string& what) { typed.push_back(parse_station(text, what)); })
      ->group("Stations");
  add_text(command, "--stations", "FILE",
           "Stations from a CSV file with columns x,y,z or u,v, or from a plan's front.json", file)
      ->group("Stations");
  add_value(command, "--entry", "K", "Which entry of front.json, counted from 0",
            [this](const std::string& text, const std::string& what) { entry = parse_count(text, what); })
      ->group("Stations");
}

std::vector<StationText> StationOptions::read(std::size_t most) const {
  std::vector<StationText> stations = typed;
  if (file && file->ends_with(".json")) {
    for (const auto& station : read_front(*file, entry.value_or(0))) stations.push_back(station);
  } else if (entry) {
    throw Error(Errc::invalid_argument, "--entry goes with --stations front.json");
  } else if (file) {
    for (const auto& row : read_stations_csv(*file)) stations.push_back({row.position, row.uv});
  }
  if (stations.empty())
    throw Error(Errc::invalid_argument, "no station given: add --station X,Y,Z, --station u,v or --stations FILE");
  if (stations.size() > most)
    throw Error(Errc::invalid_argument, std::to_string(stations.size()) + " stations given, and at most " +
                                            std::to_string(most) + " can be simulated together");
  return stations;
}

std::vector<SiteStation> place(LoadedSite& site, const std::vector<StationText>& stations) {
  const double height = site.scanner.height_m;
  std::vector<SiteStation> placed;
  for (const auto& station : stations) {
    if (!station.position) {
      const std::array<double, 2> uv{station.uv->u, station.uv->v};
      placed.push_back({place_stations(site.area(), site.clash(), height, uv).front(), true});
      continue;
    }
    const PlacedHead head =
        place_head(site.has_area() ? &site.area() : nullptr, site.clash(), height, *station.position, station.uv);
    placed.push_back({head.station, head.has_uv});
  }
  return placed;
}

Network to_network(const std::vector<SiteStation>& stations) {
  Network network;
  for (const auto& station : stations) network.push_back({station.placed.position, active(station.placed)});
  return network;
}

nlohmann::json to_json(const SiteStation& station) {
  const PlacedStation& placed = station.placed;
  nlohmann::json json{{"position", nullptr}, {"uv", nullptr}, {"status", to_string(placed.status)}};
  if (placed.status != StationStatus::hole)
    json["position"] = {placed.position.x, placed.position.y, placed.position.z};
  if (station.has_uv) json["uv"] = {placed.uv.u, placed.uv.v};
  return json;
}

void warn_of_unusable(const std::vector<SiteStation>& stations) {
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const auto& placed = stations[k].placed;
    if (placed.status == StationStatus::ok) continue;
    const std::string where =
        placed.status == StationStatus::hole
            ? fmt::format("u,v = {:g},{:g}", placed.uv.u, placed.uv.v)
            : fmt::format("{:.6g},{:.6g},{:.6g}", placed.position.x, placed.position.y, placed.position.z);
    spdlog::warn("station {} at {} {}{}", k, where, explain(placed.status), active(placed) ? "" : "; it is left out");
  }
}

}  // namespace vantage::cli
