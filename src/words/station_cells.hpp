// SPDX-License-Identifier: Apache-2.0
// Cells of a station in tables: the same columns in all of them.
#pragma once

#include <algorithm>
#include <span>
#include <string>

#include "core/text.hpp"
#include "vantage/placement.hpp"
#include "vantage/scanner.hpp"
#include "words/csv_cell.hpp"

namespace vantage {

inline constexpr const char* kStationColumns[] = {"name", "x", "y", "z", "ground_z", "u", "v", "status", "existing"};

// Columns of a station's setup, in tables that need them.
inline constexpr const char* kSetupColumns[] = {"heading", "tilt", "scanner", "step"};

// True if a table needs them: some station is turned, or has another scanner than the first.
inline bool tells_setups(std::span<const PlacedStation> stations) {
  return std::ranges::any_of(stations, [](const PlacedStation& s) { return s.setup != StationSetup(); });
}

// Degrees; the scanner in the form of load_scanner(), and its step if both are equal.
inline std::string setup_cells(const StationSetup& setup, std::span<const Scanner> scanners) {
  std::string cells = number(setup.heading.in_degrees()) + "," + number(setup.tilt.in_degrees());
  if (setup.scanner >= scanners.size()) return cells + ",,";
  const Scanner& scanner = scanners[setup.scanner];
  cells += "," + csv_cell(scanner.name) + ",";
  return scanner.one_step() ? cells + number(scanner.azimuth_step.in_degrees()) : cells;
}

// One cell for each column, separated by commas. A station in a hole has no position; its empty cells keep a reader
// from taking it for the origin.
inline std::string station_cells(const PlacedStation& s, const std::string& name) {
  std::string cells = csv_cell(name);
  if (s.status == StationStatus::hole)
    cells += ",,,,,";
  else
    cells += "," + number(s.position.x) + "," + number(s.position.y) + "," + number(s.position.z) + "," +
             number(s.ground.z) + ",";
  return cells + number(s.uv.u) + "," + number(s.uv.v) + "," + to_string(s.status) + (s.existing ? ",1" : ",0");
}

}  // namespace vantage
