// SPDX-License-Identifier: Apache-2.0
// Units and coordinate systems that files of points declare.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace vantage::importer {

struct DeclaredSystem {
  bool unit = false;                                 // whether the file tells its unit
  Eigen::Vector3d metres = Eigen::Vector3d::Ones();  // in a unit of each axis; below 0 for depths
  std::string text = {};                             // of the system in metres: well-known text or EPSG:N; empty: none
  std::vector<std::string> notes = {};
};

// Reads well-known text of either version. Throws Refused for degrees, geocentric coordinates, and axes other than east
// and north.
DeclaredSystem system_of_text(const std::string& text);

// Reads the keys of GeoTIFF (OGC 19-008r4, 2019) in LAS: records 34735 and 34736. Throws Refused as above.
DeclaredSystem system_of_keys(std::string_view directory, std::string_view doubles);

}  // namespace vantage::importer
