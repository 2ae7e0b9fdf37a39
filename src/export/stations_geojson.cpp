// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/atomic_file.hpp"
#include "export/station_grounds.hpp"

namespace vantage {
namespace {

double rounded(double value, double digits) { return std::round(value * digits) / digits; }

}  // namespace

void write_stations_geojson(const std::filesystem::path& file, const NamedStations& stations, const std::string& crs) {
  using nlohmann::ordered_json;
  const auto grounds = grounds_of(stations);
  const auto places = to_wgs84(crs, grounds);
  ordered_json features = ordered_json::array();
  for (std::size_t k = 0, placed = 0; k < stations.stations.size(); ++k) {
    const PlacedStation& s = stations.stations[k];
    ordered_json properties{{"name", stations.names[k]}, {"status", to_string(s.status)}, {"existing", s.existing}};
    ordered_json geometry;
    if (has_ground(s)) {
      const GeodeticPoint& at = places[placed++];
      geometry = {{"type", "Point"},
                  {"coordinates",
                   {rounded(at.longitude_deg, 1e10), rounded(at.latitude_deg, 1e10), rounded(at.height_m, 1e4)}}};
      properties["head_height_m"] = rounded(s.position.z - s.ground.z, 1e4);
      properties["x"] = s.position.x, properties["y"] = s.position.y, properties["z"] = s.position.z;
      properties["ground_z"] = s.ground.z;
    }
    features.push_back({{"type", "Feature"}, {"geometry", std::move(geometry)}, {"properties", std::move(properties)}});
  }
  const ordered_json collection{{"type", "FeatureCollection"}, {"features", std::move(features)}};
  write_atomically(file, collection.dump(2) + "\n");
}

}  // namespace vantage
