// SPDX-License-Identifier: Apache-2.0
// Coordinate reference systems by PROJ (PROJ contributors: PROJ coordinate transformation software library, 2022),
// without its network.
#pragma once

#include <optional>
#include <string>

namespace vantage {

struct CoordinateReference {
  enum class Kind { projected, local, geographic, geocentric, other };
  struct Axis {
    std::string direction;  // east, north, up, …
    std::string unit;       // its name
    double factor = 1;      // metres, or radians, in a unit
  };

  Kind kind = Kind::other;  // of the coordinates in plan
  std::string name = {};
  Axis first = {}, second = {};
  std::optional<Axis> height = {};  // if the system has one
  // Well-known text of version 1 (OGC 01-009, as GDAL writes it) in one line; empty if version 1 has no words for the
  // system. `in_metres` is the same system with all lengths in metres and heights upwards.
  std::string text = {}, in_metres = {};

  bool has_lengths() const { return kind == Kind::projected || kind == Kind::local; }
  // Returns true if x points east and y north, in either order of definition, or both are of a polar system.
  bool has_usual_axes() const;
};

// Reads well-known text of either version, EPSG:N, or EPSG:N+M with heights. Empty if PROJ does not know it.
std::optional<CoordinateReference> read_coordinate_reference(const std::string& definition);

// A unit of length by its EPSG code, such as 9003; empty if PROJ knows no such unit.
struct LengthUnit {
  std::string name;
  double metres = 1;
};
std::optional<LengthUnit> epsg_length_unit(int code);

}  // namespace vantage
