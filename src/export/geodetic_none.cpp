// SPDX-License-Identifier: Apache-2.0
// In place of geodetic_proj.cpp where PROJ was not found.
#include "export/geodetic.hpp"
#include "vantage/error.hpp"
#include "vantage/station_files.hpp"

namespace vantage {

bool has_projections() noexcept { return false; }

std::string epsg_text(int) { return ""; }

std::vector<GeodeticPoint> to_wgs84(const std::string&, std::span<const Vec3>) {
  throw Error(
      Errc::invalid_argument,
      "longitude and latitude need PROJ, which this build of vantage lacks: install it (Debian: libproj-dev) and "
      "build again, or write .csv or .dxf");
}

}  // namespace vantage
