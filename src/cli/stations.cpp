// SPDX-License-Identifier: Apache-2.0
#include "cli/stations.hpp"

#include <spdlog/spdlog.h>

#include <cmath>

#include "cli/options.hpp"
#include "cli/station_scanners.hpp"
#include "core/read_json.hpp"
#include "formats/station_json.hpp"

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
    if (entry > entries.size())
      throw Error(Errc::invalid_argument, "--entry: " + std::to_string(entry) + " is not in " + file + ", which has " +
                                              std::to_string(entries.size()) + " entries, counted from 1");
    std::vector<StationText> stations;
    for (const auto& station : entries[entry - 1].at("stations")) {
      stations.push_back(station_of_json(station));
      if (!stations.back().position && !stations.back().uv)
        throw Error(Errc::malformed_file, file + ": a station has neither position nor uv");
    }
    return stations;
  } catch (const nlohmann::json::exception& error) {
    throw Error(Errc::malformed_file, file + ": is not a plan's front.json: " + error.what());
  }
}

}  // namespace

void StationOptions::add(CLI::App& command) {
  add_values(
      command, "--station", "X,Y,Z|U,V",
      "A station: the scanner's head, or a point of the search area; x=,y= finds the ground; with heading=,tilt=,"
      "scanner=,step= for another setup; may be repeated",
      [this](const std::string& text, const std::string& what) { typed.push_back(parse_station(text, what)); })
      ->group("Stations");
  add_text(command, "--stations", "FILE",
           "Stations from a table with columns x,y,z or Easting,Northing,Height or u,v, optionally heading, tilt, "
           "scanner and step; or from a plan's front.json",
           file)
      ->group("Stations");
  add_value(command, "--entry", "K", "Entry of front.json, counted from 1; 1 otherwise",
            [this](const std::string& text, const std::string& what) {
              if (text == "0") throw Error(Errc::invalid_argument, what + ": entries are counted from 1");
              entry = parse_count(text, what, 1);
            })
      ->group("Stations");
}

std::vector<StationText> StationOptions::read(std::size_t most) const {
  std::vector<StationText> stations = typed;
  if (file && file->ends_with(".json")) {
    for (const auto& station : read_front(*file, entry.value_or(1))) stations.push_back(station);
  } else if (entry) {
    throw Error(Errc::invalid_argument, "--entry needs --stations front.json");
  } else if (file) {
    for (const auto& row : read_stations_csv(*file))
      stations.push_back({.position = row.position,
                          .uv = row.uv,
                          .ground = row.ground,
                          .xy = row.xy,
                          .name = row.name,
                          .setup = row.setup,
                          .scanner = row.scanner,
                          .step = row.step});
  }
  if (stations.empty())
    throw Error(Errc::invalid_argument, "no station given: add --station X,Y,Z, --station u,v or --stations FILE");
  if (stations.size() > most)
    throw Error(Errc::invalid_argument, std::to_string(stations.size()) + " stations given, and at most " +
                                            std::to_string(most) + " can be simulated together");
  return stations;
}

namespace {

// The ground at x, y. Throws Error invalid_argument if there is none, or if floors lie above each other.
Vec3 ground_at(Site& site, const std::array<double, 2>& xy) {
  constexpr double kSameFloor_m = 0.5, kFar_m = 1e6;  // beyond any site
  const auto at = fmt::format("x,y = {},{}", xy[0], xy[1]);
  const auto ground = [&](double z) -> std::optional<Vec3> {
    const auto uv = site.area().project({xy[0], xy[1], z});
    return uv ? site.area().locate(*uv) : std::nullopt;
  };
  const auto low = ground(-kFar_m), high = ground(kFar_m);
  if (!low || !high)
    throw Error(Errc::invalid_argument, "--station: there is no ground to stand on at " + at +
                                            "; with a height, as x=…,y=…,z=…, the head goes anywhere");
  if (high->z - low->z > kSameFloor_m)
    throw Error(Errc::invalid_argument,
                fmt::format("--station: at {0} there are floors at {1:.2f} and {2:.2f}; say which, as "
                            "x={3},y={4},ground={1:.2f}",
                            at, low->z, high->z, xy[0], xy[1]));
  return {xy[0], xy[1], low->z};
}

// Two numbers without names are (u, v) if they cannot be anything else.
Uv uv_of_pair(Site& site, const std::array<double, 2>& pair) {
  const SearchArea& area = site.area();
  const Uv low = area.uv_min(), high = area.uv_max();
  const auto within = [](double value, double from, double to) { return value >= from && value <= to; };
  const bool is_uv = within(pair[0], low.u, high.u) && within(pair[1], low.v, high.v);
  const bool small = within(pair[0], 0, 1) && within(pair[1], 0, 1);
  if (is_uv && (small || !area.project({pair[0], pair[1], 0}))) return {pair[0], pair[1]};
  throw Error(Errc::invalid_argument,
              fmt::format("--station: '{0},{1}' may be x,y or u,v: for metres in the scene's frame, with the head "
                          "{2:g} m above the ground there, give x={0},y={1}; for a point of the search area, whose u "
                          "runs from {3:.4g} to {4:.4g} and v from {5:.4g} to {6:.4g}, give u={0},v={1}",
                          pair[0], pair[1], site.scanner().height_m, low.u, high.u, low.v, high.v));
}

// Completes a station to a head or (u, v).
StationText completed(Site& site, StationText station) {
  if (station.pair) station.uv = uv_of_pair(site, *station.pair);
  if (!station.position && !station.ground && station.xy) station.ground = ground_at(site, *station.xy);
  if (!station.position && station.ground) station.position = *station.ground + Vec3{0, 0, site.scanner().height_m};
  return station;
}

}  // namespace

std::vector<SiteStation> place(Site& site, const std::vector<StationText>& stations) {
  std::vector<SiteStation> placed;
  for (const auto& typed : stations) {
    const StationText station = completed(site, typed);
    if (station.position) {
      const PlacedHead head = site.place_head(*station.position, station.uv);
      placed.push_back({head.station, head.has_uv, station.name});
    } else {
      const std::array<double, 2> uv{station.uv->u, station.uv->v};
      placed.push_back({place_stations(site, uv).front(), true, station.name});
    }
    StationSetup& setup = placed.back().placed.setup = station.setup;
    setup.scanner = scanner_of(site, station);
  }
  return placed;
}

Network to_network(const std::vector<SiteStation>& stations) {
  Network network;
  for (const auto& station : stations)
    network.push_back({station.placed.position, active(station.placed), station.placed.setup});
  return network;
}

nlohmann::json to_json(const SiteStation& station, const std::string& name, std::span<const Scanner> scanners) {
  const PlacedStation& placed = station.placed;
  nlohmann::json json = station_json<nlohmann::json>(placed, name);
  if (!station.has_uv) json["uv"] = nullptr;
  if (placed.setup != StationSetup()) add_setup(json, placed.setup, scanners);
  return json;
}

StationText station_of_json(const nlohmann::json& json) {
  StationText text{
      .position = vec3_of(json.value("position", nlohmann::json())),
      .uv = uv_of(json.value("uv", nlohmann::json())),
      .name = json.value("name", ""),
      .setup = {.heading = Angle::degrees(json.value("heading", 0.0)), .tilt = Angle::degrees(json.value("tilt", 0.0))},
      .scanner = json.value("scanner", "")};
  const auto angle = [&](const char* key) {
    return json.contains(key) ? std::optional(Angle::degrees(json[key].get<double>())) : std::nullopt;
  };
  const auto metres = [&](const char* key) {
    return json.contains(key) ? std::optional(json[key].get<double>()) : std::nullopt;
  };
  text.step = angle("step");
  text.view = {.zenith_step = angle("zenith_step"),
               .horizontal = angle("horizontal"),
               .vertical = angle("vertical"),
               .zenith_start = angle("zenith_start"),
               .nearest_m = metres("nearest"),
               .farthest_m = metres("farthest")};
  if (json.value("status", "ok") == "hole") text.position.reset();
  return text;
}

std::vector<PlacedStation> placed_of(const std::vector<SiteStation>& stations) {
  std::vector<PlacedStation> placed;
  for (const auto& station : stations) placed.push_back(station.placed);
  return placed;
}

std::vector<std::string> names_of(const std::vector<SiteStation>& stations) {
  std::vector<std::string> given;
  for (const auto& station : stations) given.push_back(station.name);
  return station_names(placed_of(stations), given);
}

std::string fault_text(Site& site, const PlacedStation& placed, const std::string& consequence) {
  std::string text = explain(placed.status) + (active(placed) ? "" : "; " + consequence);
  if (placed.status == StationStatus::ok || placed.status == StationStatus::hole || !site.has_area()) return text;
  return text + "; " + move_text(placed.position, {.to = site.nearest_place(placed.position)});
}

void warn_of_unusable(Site& site, const std::vector<SiteStation>& stations) {
  constexpr std::size_t kMost = 10;  // the summary has all
  const auto names = names_of(stations);
  std::size_t told = 0;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const auto& placed = stations[k].placed;
    if (placed.status == StationStatus::ok || ++told > kMost) continue;
    const std::string where =
        placed.status == StationStatus::hole
            ? fmt::format("u,v = {:g},{:g}", placed.uv.u, placed.uv.v)
            : fmt::format("{:.3f},{:.3f},{:.3f}", placed.position.x, placed.position.y, placed.position.z);
    spdlog::warn("{} at {} {}", names[k], where, fault_text(site, placed));
  }
  if (told > kMost) spdlog::warn("{} more stations do not stand well; the summary has all", told - kMost);
}

}  // namespace vantage::cli
