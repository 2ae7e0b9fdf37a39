// SPDX-License-Identifier: Apache-2.0
#include "formats/station_files.hpp"

#include "vantage/error.hpp"
#include "vantage/export.hpp"

namespace vantage {
namespace {

std::string crs_text(const Site& site) { return site.crs().empty() ? "" : coordinate_system(site.crs()); }

std::vector<Vec3> corners(const Box& box) {
  return {box.min, box.max, {box.min.x, box.max.y, 0}, {box.max.x, box.min.y, 0}};
}

}  // namespace

void write_stations(const std::filesystem::path& file, std::span<const PlacedStation> placed,
                    std::span<const std::string> names, const StationLinks& links, Site& site,
                    std::span<const Target> targets) {
  const NamedStations stations{placed, names, targets};
  const std::string extension = file.extension().string();
  if (extension == ".geojson")
    write_stations_geojson(file, stations, crs_text(site));
  else if (extension == ".kml")
    write_stations_kml(file, stations, crs_text(site));
  else if (extension == ".dxf")
    write_stations_dxf(file, stations, links, site.area());
  else
    throw Error(Errc::invalid_argument, "unknown format of " + file.string() + " from its extension \"" + extension +
                                            "\"; use .geojson, .kml or .dxf");
}

void write_station_files(const std::filesystem::path& folder, const NamedStations& stations, const StationLinks& links,
                         Site& site) {
  write_stations_dxf(folder / "stations.dxf", stations, links, site.area());
  const std::string crs = crs_text(site);
  if (crs.empty()) return;
  try {
    to_wgs84(crs, corners(site.scene().bounds()));
  } catch (const Error& error) {
    if (site.options().warn) site.options().warn(std::string("no stations.geojson and stations.kml: ") + error.what());
    return;
  }
  write_stations_geojson(folder / "stations.geojson", stations, crs);
  write_stations_kml(folder / "stations.kml", stations, crs);
}

}  // namespace vantage
