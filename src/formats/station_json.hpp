// SPDX-License-Identifier: Apache-2.0
// A station in JSON, by the same keys in front.json, --json, the editor's file and its page, and the report.
#pragma once

#include <span>
#include <string>

#include "evaluate/known_points.hpp"
#include "vantage/placement.hpp"
#include "vantage/scanner.hpp"
#include "vantage/station_setup.hpp"

namespace vantage {

// {name, position, ground, uv, status, existing}: position of the head, survey frame, metres; null where there is no
// ground.
template <class Json>
Json station_json(const PlacedStation& station, const std::string& name) {
  const auto point = [](const Vec3& p) { return Json{p.x, p.y, p.z}; };
  const bool placed = station.status != StationStatus::hole;
  return {{"name", name},
          {"position", placed ? point(station.position) : Json()},
          {"ground", placed ? point(station.ground) : Json()},
          {"uv", {station.uv.u, station.uv.v}},
          {"status", to_string(station.status)},
          {"existing", station.existing}};
}

// Adds {heading, tilt, scanner, step}, as the columns of stations.csv; and, if the scanner is another than the first,
// with another view, {zenith_step, horizontal, vertical, zenith_start, nearest, farthest}. Degrees and metres. `step`
// is that of azimuth, and, without `zenith_step`, of zenith; it is left out if the first scanner's own two differ.
template <class Json>
void add_setup(Json& station, const StationSetup& setup, std::span<const Scanner> scanners) {
  const Scanner &scanner = scanners[setup.scanner], &first = scanners.front();
  const bool one_step = scanner.one_step();
  const bool own_view = setup.scanner > 0 && scanner.directions.empty() &&
                        (!one_step || scanner.horizontal_angle != first.horizontal_angle ||
                         scanner.vertical_angle != first.vertical_angle || scanner.zenith_start != first.zenith_start ||
                         scanner.min_range_m != first.min_range_m || scanner.max_range_m != first.max_range_m);
  station["heading"] = setup.heading.in_degrees();
  station["tilt"] = setup.tilt.in_degrees();
  station["scanner"] = scanner.name;
  if (one_step || own_view) station["step"] = scanner.azimuth_step.in_degrees();
  if (!own_view) return;
  if (!one_step) station["zenith_step"] = scanner.zenith_step.in_degrees();
  station["horizontal"] = scanner.horizontal_angle.in_degrees();
  station["vertical"] = scanner.vertical_angle.in_degrees();
  station["zenith_start"] = scanner.zenith_start.in_degrees();
  station["nearest"] = scanner.min_range_m;
  station["farthest"] = scanner.max_range_m;
}

// Adds {known_points, set_up}: how many control points its scan measures, and what they allow.
template <class Json>
void add_set_up(Json& station, const KnownPoints& known, const Evaluation& evaluation) {
  station["known_points"] = known.seen.size();
  station["set_up"] = set_up_text(known, evaluation);
}

}  // namespace vantage
