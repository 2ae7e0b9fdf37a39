// SPDX-License-Identifier: Apache-2.0
// The XML section of an E57 file (ASTM E2807, 8): what there is, where, and how to read it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "vantage/types.hpp"

namespace vantage {

// One field of the records, all of whole bytes: an integer's range is that of its type.
struct E57Field {
  enum class Type { single_precision, double_precision, integer };
  std::string name;
  Type type = Type::single_precision;
  std::size_t bytes = 4;
  bool unit_range = false;  // of a floating-point number: 0 to 1
};

// Extremes of the values of one station's points, as stored.
struct E57Bounds {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::array<double, 3> low{kInfinity, kInfinity, kInfinity},
      high{-kInfinity, -kInfinity, -kInfinity};  // in the scanner's frame, metres
  std::uint32_t row_low = UINT32_MAX, row_high = 0, column_low = UINT32_MAX, column_high = 0;
};

// A Data3D: one station's scan.
struct E57Scan {
  std::string guid, name, sensor_model;
  Vec3 translation;                            // pose: from the scanner's frame to the file's, metres
  std::array<double, 4> rotation{1, 0, 0, 0};  // w, x, y, z
  std::uint64_t records = 0, section = 0;      // physical address of the points
  std::vector<E57Field> fields;
  E57Bounds bounds;  // of records; nothing without any
};

// `crs`: well-known text of the file's frame, or nothing.
std::string e57_xml(const std::string& guid, const std::string& crs, const std::vector<E57Scan>& scans);

// A GUID in the registry's form that stands for two hashes: equal content, equal GUID (RFC 9562, version 8).
std::string e57_guid(std::uint64_t high, std::uint64_t low);

}  // namespace vantage
