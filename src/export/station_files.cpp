// SPDX-License-Identifier: Apache-2.0
#include "vantage/station_files.hpp"

#include "vantage/error.hpp"

namespace vantage {

void write_stations(const std::filesystem::path& file, const NamedStations& stations, const StationLinks& links,
                    const SearchArea& area, const std::string& crs) {
  const std::string extension = file.extension().string();
  if (extension == ".geojson")
    write_stations_geojson(file, stations, crs);
  else if (extension == ".kml")
    write_stations_kml(file, stations, crs);
  else if (extension == ".dxf")
    write_stations_dxf(file, stations, links, area);
  else
    throw Error(Errc::invalid_argument, "unknown format of " + file.string() + " from its extension \"" + extension +
                                            "\"; use .geojson, .kml or .dxf");
}

void write_station_files(const std::filesystem::path& folder, const NamedStations& stations, const StationLinks& links,
                         const SearchArea& area, const std::string& crs) {
  write_stations_dxf(folder / "stations.dxf", stations, links, area);
  if (crs.empty()) return;
  write_stations_geojson(folder / "stations.geojson", stations, crs);
  write_stations_kml(folder / "stations.kml", stations, crs);
}

}  // namespace vantage
