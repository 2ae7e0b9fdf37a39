// SPDX-License-Identifier: Apache-2.0
#include "core/atomic_file.hpp"
#include "core/text.hpp"
#include "formats/station_grounds.hpp"
#include "formats/xml_text.hpp"

namespace vantage {
namespace {

// Colours are aabbggrr in KML.
std::string style(const char* id, const char* colour) {
  return std::string("<Style id=\"") + id + "\"><IconStyle><color>" + colour + "</color></IconStyle></Style>\n";
}

std::string datum(const char* name, const std::string& value) {
  return std::string("<Data name=\"") + name + "\"><value>" + xml_text(value) + "</value></Data>\n";
}

}  // namespace

void write_stations_kml(const std::filesystem::path& file, const NamedStations& stations, const std::string& crs) {
  const auto grounds = grounds_of(stations);
  const auto places = to_wgs84(crs, grounds);
  std::string kml =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n<Document>\n"
      "<name>Scanner stations</name>\n";
  kml += style("new", "ffb5681f") + style("existing", "ff4d9e2b") + style("left_out", "ff1f1fb8");
  if (!stations.targets.empty()) kml += style("target", "ff1f1a1a");
  for (std::size_t k = 0, placed = 0; k < stations.stations.size(); ++k) {
    const PlacedStation& s = stations.stations[k];
    if (!has_ground(s)) continue;
    const GeodeticPoint& at = places[placed++];
    kml += "<Placemark>\n<name>" + xml_text(stations.names[k]) + "</name>\n";
    kml += std::string("<styleUrl>#") + (!active(s) ? "left_out" : s.existing ? "existing" : "new") + "</styleUrl>\n";
    kml += "<ExtendedData>\n" + datum("status", to_string(s.status)) + datum("existing", s.existing ? "true" : "false");
    kml += datum("head_height_m", fixed(s.position.z - s.ground.z, 4));
    kml += datum("x", fixed(s.position.x, 4)) + datum("y", fixed(s.position.y, 4));
    kml += datum("z", fixed(s.position.z, 4)) + datum("ground_z", fixed(s.ground.z, 4));
    kml += "</ExtendedData>\n<Point><altitudeMode>absolute</altitudeMode><coordinates>";
    kml += fixed(at.longitude_deg, 10) + "," + fixed(at.latitude_deg, 10) + "," + fixed(at.height_m, 4);
    kml += "</coordinates></Point>\n</Placemark>\n";
  }
  const auto centres = centres_of(stations);
  const auto there = to_wgs84(crs, centres);
  for (std::size_t k = 0; k < stations.targets.size(); ++k) {
    const Target& target = stations.targets[k];
    const GeodeticPoint& at = there[k];
    std::string seen_by;
    for (const std::size_t station : target.stations) seen_by += (seen_by.empty() ? "" : " ") + stations.names[station];
    kml += "<Placemark>\n<name>" + xml_text(target.name) + "</name>\n<styleUrl>#target</styleUrl>\n";
    kml += "<ExtendedData>\n" + datum("kind", kind_of(target)) + datum("proposed", target.proposed ? "true" : "false");
    if (target.control_m > 0) kml += datum("sigma_m", number(target.control_m));
    kml += datum("stations", seen_by) + datum("x", fixed(target.centre.x, 4)) + datum("y", fixed(target.centre.y, 4));
    kml += datum("z", fixed(target.centre.z, 4));
    kml += "</ExtendedData>\n<Point><altitudeMode>absolute</altitudeMode><coordinates>";
    kml += fixed(at.longitude_deg, 10) + "," + fixed(at.latitude_deg, 10) + "," + fixed(at.height_m, 4);
    kml += "</coordinates></Point>\n</Placemark>\n";
  }
  write_atomically(file, kml + "</Document>\n</kml>\n");
}

}  // namespace vantage
