// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "core/atomic_file.hpp"
#include "core/json_text.hpp"
#include "core/text.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"
#include "words/csv_cell.hpp"

namespace vantage {
namespace {

using nlohmann::ordered_json;

// A stop of a robot: it stands on the ground and looks the way it came.
struct Waypoint {
  std::string name;
  Vec3 ground;
  double head_height_m = 0;
  double yaw = 0;                           // radians, from +X towards +Y
  double first_column = 0;                  // degrees, of the scanner's first column
  double dwell_s = 0, wait_s = 0;           // there, and before that for an access window
  const std::vector<Vec3>* path = nullptr;  // that leads to it
};

struct WaypointRound {
  std::size_t day = 1, crew = 1;
  const Round* round = nullptr;
  std::vector<Waypoint> waypoints = {};
};

// The direction of a path's last or first step in plan; empty: it has none.
std::optional<double> direction(const std::vector<Vec3>& path, bool last) {
  for (std::size_t k = 0; k + 1 < path.size(); ++k) {
    const std::size_t at = last ? path.size() - 2 - k : k;
    const Vec3 step = path[at + 1] - path[at];
    if (std::hypot(step.x, step.y) > 0) return std::atan2(step.y, step.x);
  }
  return std::nullopt;
}

double wrapped_degrees(Angle angle) {
  const double degrees = std::remainder(angle.in_degrees(), 360);
  return degrees == -180 ? 180 : degrees;
}

WaypointRound waypoints_of(const Round& round, const Evaluation& evaluation, std::span<const Scanner> scanners,
                           const std::vector<std::string>& names) {
  WaypointRound made{.round = &round};
  const std::size_t existing = existing_count(evaluation.stations);
  for (std::size_t k = 0; k < round.order.size(); ++k) {
    const std::size_t station = existing + round.order[k];
    const PlacedStation& s = evaluation.stations[station];
    const Scanner& scanner = scanners[s.setup.scanner];
    const double first_azimuth = (scanner.heading.in_degrees() - scanner.horizontal_angle.in_degrees() / 2) +
                                 scanner.azimuth_step.in_degrees() / 2 + s.setup.heading.in_degrees();
    // A round that begins at its first station leads nowhere before the second.
    const double yaw = direction(round.paths[k], true)
                           .value_or(direction(round.paths[k + 1], false).value_or(s.setup.heading.in_radians()));
    made.waypoints.push_back({.name = names[station],
                              .ground = s.ground,
                              .head_height_m = s.position.z - s.ground.z,
                              .yaw = yaw,
                              .first_column = wrapped_degrees(Angle::degrees(first_azimuth)),
                              .dwell_s = 60 * round.stay_min[k],
                              .path = &round.paths[k]});
  }
  return made;
}

ordered_json point_of(const Vec3& p) { return {p.x, p.y, p.z}; }

ordered_json json_of(const Waypoint& one, std::size_t order) {
  ordered_json path = ordered_json::array();
  for (const Vec3& p : *one.path) path.push_back(point_of(p));
  return {{"order", order},
          {"name", one.name},
          {"position", point_of(one.ground)},
          {"orientation", {{"x", 0}, {"y", 0}, {"z", std::sin(one.yaw / 2)}, {"w", std::cos(one.yaw / 2)}}},
          {"heading", wrapped_degrees(Angle::radians(one.yaw))},
          {"first_column", one.first_column},
          {"head_height", one.head_height_m},
          {"dwell_s", std::round(1000 * one.dwell_s) / 1000},
          {"wait_s", std::round(1000 * one.wait_s) / 1000},
          {"path", std::move(path)}};
}

std::string waypoints_json(const std::vector<WaypointRound>& rounds, const std::string& crs) {
  ordered_json all = ordered_json::array();
  for (const WaypointRound& one : rounds) {
    ordered_json waypoints = ordered_json::array(), back = waypoints;
    for (std::size_t k = 0; k < one.waypoints.size(); ++k) waypoints.push_back(json_of(one.waypoints[k], k + 1));
    const std::vector<Vec3>& first = one.round->paths.front();
    for (const Vec3& p : one.round->paths.back()) back.push_back(point_of(p));
    all.push_back({{"day", one.day},
                   {"crew", one.crew},
                   {"minutes", one.round->minutes},
                   {"start", point_of(first.empty() ? one.waypoints.front().ground : first.front())},
                   {"waypoints", std::move(waypoints)},
                   {"back", std::move(back)}});
  }
  const ordered_json json = {{"crs", crs.empty() ? ordered_json() : ordered_json(crs)}, {"rounds", std::move(all)}};
  return json_text(json, 1) + "\n";
}

std::string waypoints_csv(const std::vector<WaypointRound>& rounds) {
  std::string text = "day,crew,order,name,x,y,z,head_height,heading,first_column,dwell_s,wait_s\n";
  for (const WaypointRound& round : rounds)
    for (std::size_t k = 0; k < round.waypoints.size(); ++k) {
      const Waypoint& one = round.waypoints[k];
      text += number(round.day) + "," + number(round.crew) + "," + number(k + 1) + "," + csv_cell(one.name) + "," +
              number(one.ground.x) + "," + number(one.ground.y) + "," + number(one.ground.z) + "," +
              fixed(one.head_height_m, 3) + "," + fixed(wrapped_degrees(Angle::radians(one.yaw)), 2) + "," +
              fixed(one.first_column, 2) + "," + fixed(one.dwell_s, 1) + "," + fixed(one.wait_s, 1) + "\n";
    }
  return text;
}

}  // namespace

void write_waypoints(const std::filesystem::path& file, const Evaluation& evaluation, std::span<const Scanner> scanners,
                     const std::string& crs) {
  const std::string extension = file.extension().string();
  if (extension != ".json" && extension != ".csv")
    throw Error(Errc::invalid_argument, "waypoints: '" + file.string() + "' must end with .json or .csv");
  if (!evaluation.visit || evaluation.visit->order.empty())
    throw Error(Errc::invalid_argument,
                "waypoints: the stations have no round; a search area is needed, and a station on it");
  const std::vector<std::string> names = station_names(evaluation.stations, evaluation.names);
  std::vector<WaypointRound> rounds;
  for (const Session& session : evaluation.visit->sessions) {
    rounds.push_back(waypoints_of(session, evaluation, scanners, names));
    rounds.back().day = session.day, rounds.back().crew = session.crew;
    for (std::size_t k = 0; k < session.wait_min.size(); ++k)
      rounds.back().waypoints[k].wait_s = 60 * session.wait_min[k];
  }
  if (rounds.empty()) rounds.push_back(waypoints_of(*evaluation.visit, evaluation, scanners, names));
  write_atomically(file, extension == ".json" ? waypoints_json(rounds, crs) : waypoints_csv(rounds));
}

}  // namespace vantage
