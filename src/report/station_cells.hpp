// SPDX-License-Identifier: Apache-2.0
// A station in tables: the same columns wherever one is written.
#pragma once

#include <string>

#include "core/text.hpp"
#include "vantage/placement.hpp"

namespace vantage {

inline constexpr const char* kStationColumns[] = {"name", "x", "y", "z", "ground_z", "u", "v", "status", "kept"};

// One cell a column, with commas between them. A station in a hole has no position; empty cells keep a reader from
// taking it for the origin.
inline std::string station_cells(const PlacedStation& s, const std::string& name) {
  const bool quoted = name.find_first_of(",\"\n") != std::string::npos;
  std::string cells;
  for (const char c : name) cells += quoted && c == '"' ? '\'' : c;
  if (quoted) cells = "\"" + cells + "\"";
  if (s.status == StationStatus::hole)
    cells += ",,,,,";
  else
    cells += "," + number(s.position.x) + "," + number(s.position.y) + "," + number(s.position.z) + "," +
             number(s.ground.z) + ",";
  return cells + number(s.uv.u) + "," + number(s.uv.v) + "," + to_string(s.status) + (s.kept ? ",1" : ",0");
}

}  // namespace vantage
