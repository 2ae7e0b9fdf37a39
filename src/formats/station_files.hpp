// SPDX-License-Identifier: Apache-2.0
// Files of stations that a crew takes to the site, by format. Every file appears whole or not at all.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "vantage/evaluation.hpp"
#include "vantage/site.hpp"

namespace vantage {

// Stations with their names, one each. Survey frame.
struct NamedStations {
  std::span<const PlacedStation> stations;
  std::span<const std::string> names;  // From `station_names()`.
  std::span<const Target> targets = {};
};

// A point of the survey frame on WGS 84, in degrees, and its height: z, unchanged.
struct GeodeticPoint {
  double longitude_deg = 0, latitude_deg = 0, height_m = 0;
};
// Transforms `points` to WGS 84 (EPSG:4326), by PROJ's best operation that needs no network. `crs` is well-known text
// or "EPSG:N" of their frame. Throws Error invalid_argument if `crs` is empty or unknown to PROJ, or a point lies
// outside of it.
std::vector<GeodeticPoint> to_wgs84(const std::string& crs, std::span<const Vec3> points);

// The formats of `write_stations()` (vantage/export.hpp), which says what each holds. GeoJSON and KML throw Error: io,
// as `to_wgs84`; DXF: io, invalid_argument (sizes that do not match).
void write_stations_geojson(const std::filesystem::path& file, const NamedStations& stations, const std::string& crs);
void write_stations_kml(const std::filesystem::path& file, const NamedStations& stations, const std::string& crs);
// `links`: of these stations, or without values. The outline and holes of the area are closed polylines.
void write_stations_dxf(const std::filesystem::path& file, const NamedStations& stations, const StationLinks& links,
                        const SearchArea& area);

// Writes stations.dxf and, if the site has a coordinate system, stations.geojson and stations.kml. If stations cannot
// be put on WGS 84 by it, these two are left out, and `SiteOptions::warn` is told why.
void write_station_files(const std::filesystem::path& folder, const NamedStations& stations, const StationLinks& links,
                         Site& site);

}  // namespace vantage
