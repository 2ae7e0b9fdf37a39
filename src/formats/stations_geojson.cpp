// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/atomic_file.hpp"
#include "core/json_text.hpp"
#include "formats/station_grounds.hpp"

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
    ordered_json properties{
        {"kind", "station"}, {"name", stations.names[k]}, {"status", to_string(s.status)}, {"existing", s.existing}};
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
  const auto centres = centres_of(stations);
  const auto there = to_wgs84(crs, centres);
  for (std::size_t k = 0; k < stations.targets.size(); ++k) {
    const Target& target = stations.targets[k];
    const GeodeticPoint& at = there[k];
    ordered_json seen_by = ordered_json::array();
    for (const std::size_t station : target.stations) seen_by.push_back(stations.names[station]);
    features.push_back(
        {{"type", "Feature"},
         {"geometry",
          {{"type", "Point"},
           {"coordinates",
            {rounded(at.longitude_deg, 1e10), rounded(at.latitude_deg, 1e10), rounded(at.height_m, 1e4)}}}},
         {"properties",
          {{"kind", kind_of(target)},
           {"name", target.name},
           {"proposed", target.proposed},
           {"sigma_m", target.control_m > 0 ? ordered_json(target.control_m) : ordered_json()},
           {"stations", std::move(seen_by)},
           {"x", target.centre.x},
           {"y", target.centre.y},
           {"z", target.centre.z}}}});
  }
  const ordered_json collection{{"type", "FeatureCollection"}, {"features", std::move(features)}};
  write_atomically(file, json_text(collection, 2) + "\n");
}

}  // namespace vantage
