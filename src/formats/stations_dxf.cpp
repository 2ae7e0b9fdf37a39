// SPDX-License-Identifier: Apache-2.0
// DXF of release 12, in ASCII (Autodesk: Drawing Interchange File Formats, Release 12, 1992): the release that every
// program reads.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/atomic_file.hpp"
#include "core/text.hpp"
#include "formats/area_outline.hpp"
#include "formats/station_grounds.hpp"

namespace vantage {
namespace {

// Writes letters, numbers and signs in ASCII, others as escapes by their number.
std::string dxf_text(const std::string& utf8) {
  std::string text;
  for (std::size_t at = 0; at < utf8.size();) {
    const auto lead = static_cast<unsigned char>(utf8[at]);
    const std::size_t more = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC0 ? 1 : 0;
    std::uint32_t code = more == 3 ? lead & 7u : more == 2 ? lead & 15u : more == 1 ? lead & 31u : lead;
    for (std::size_t k = 1; k <= more && at + k < utf8.size(); ++k)
      code = code << 6 | (static_cast<unsigned char>(utf8[at + k]) & 63u);
    at += 1 + more;
    if (code < 0x20 || code == 0x7F) {
      text += ' ';
    } else if (code < 0x7F) {
      text += static_cast<char>(code);
    } else if (code > 0xFFFF) {
      text += '?';  // there is no such escape
    } else {
      char escaped[16];
      std::snprintf(escaped, sizeof escaped, "\\U+%04X", code);
      text += escaped;
    }
  }
  return text;
}

// Group codes and values, a line each.
class Drawing {
 public:
  void put(int code, const std::string& value) { text_ += std::to_string(code) + "\n" + value + "\n"; }
  void put(int code, int value) { put(code, std::to_string(value)); }
  void put(int code, double value) { put(code, fixed(value, 5)); }
  // `first`: the group of x, as 10; y and z have it 10 and 20 higher.
  void put(int first, const Vec3& p) { put(first, p.x), put(first + 10, p.y), put(first + 20, p.z); }
  void entity(const char* type, const char* layer) { put(0, type), put(8, layer); }
  void begin(const char* section) { put(0, "SECTION"), put(2, section); }
  void end() { put(0, "ENDSEC"); }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

struct Layer {
  const char* name;
  int colour;  // AutoCAD colour index: 1 red, 3 green, 2 yellow, 5 blue, 6 magenta, 7 black or white, 8 grey
};
constexpr Layer kStations{"STATIONS", 5}, kExisting{"STATIONS_EXISTING", 3}, kLeftOut{"STATIONS_LEFT_OUT", 1},
    kNames{"STATION_NAMES", 7}, kLinks{"LINKS", 4}, kArea{"SEARCH_AREA", 8}, kTargets{"TARGETS", 6},
    kControl{"CONTROL_POINTS", 2}, kTargetNames{"TARGET_NAMES", 7};
constexpr Layer kLayers[] = {kStations, kExisting, kLeftOut, kNames, kLinks, kArea, kTargets, kControl, kTargetNames};

void put_tables(Drawing& drawing) {
  drawing.begin("TABLES");
  drawing.put(0, "TABLE"), drawing.put(2, "LTYPE"), drawing.put(70, 1);
  drawing.put(0, "LTYPE"), drawing.put(2, "CONTINUOUS"), drawing.put(70, 0), drawing.put(3, "Solid line");
  drawing.put(72, 65), drawing.put(73, 0), drawing.put(40, 0.0);
  drawing.put(0, "ENDTAB");
  drawing.put(0, "TABLE"), drawing.put(2, "LAYER"), drawing.put(70, static_cast<int>(std::size(kLayers)));
  for (const Layer& layer : kLayers) {
    drawing.put(0, "LAYER"), drawing.put(2, layer.name), drawing.put(70, 0), drawing.put(62, layer.colour);
    drawing.put(6, "CONTINUOUS");
  }
  drawing.put(0, "ENDTAB");
  drawing.end();
}

void put_ring(Drawing& drawing, const std::vector<Vec3>& ring) {
  drawing.entity("POLYLINE", kArea.name);
  drawing.put(66, 1), drawing.put(10, Vec3{}), drawing.put(70, 1 + 8);  // closed, 3D
  for (const Vec3& p : ring) drawing.entity("VERTEX", kArea.name), drawing.put(10, p), drawing.put(70, 32);
  drawing.entity("SEQEND", kArea.name);
}

}  // namespace

void write_stations_dxf(const std::filesystem::path& file, const NamedStations& stations, const StationLinks& links,
                        const SearchArea& area) {
  const auto grounds = grounds_of(stations);
  const std::size_t n = stations.stations.size();
  if (links.values.size() != 0 && links.values.size() != n)
    throw Error(Errc::invalid_argument,
                std::to_string(n) + " stations, but an overlap matrix of " + std::to_string(links.values.size()));
  const auto rings = area_outline(area.mesh());
  Box box;
  for (const Vec3& ground : grounds) box.extend(ground);
  for (const auto& ring : rings)
    for (const Vec3& p : ring) box.extend(p);
  for (const Target& target : stations.targets) box.extend(target.centre);
  if (box.empty()) box.extend({});
  // Text that can be read on a sheet of the whole site.
  const double letter = std::clamp(std::max(box.size().x, box.size().y) / 80, 0.05, 5.0);

  Drawing drawing;
  drawing.put(999, "vantage: scanner stations in metres");
  drawing.begin("HEADER");
  drawing.put(9, "$ACADVER"), drawing.put(1, "AC1009");
  drawing.put(9, "$EXTMIN"), drawing.put(10, box.min);
  drawing.put(9, "$EXTMAX"), drawing.put(10, box.max);
  drawing.end();
  put_tables(drawing);
  drawing.begin("ENTITIES");
  for (const auto& ring : rings) put_ring(drawing, ring);
  for (std::size_t i = 0; i < links.values.size(); ++i)
    for (std::size_t j = i + 1; j < links.values.size(); ++j) {
      if (links.values(i, j) < links.least || links.values(i, j) <= 0) continue;
      drawing.entity("LINE", kLinks.name);
      drawing.put(10, stations.stations[i].ground), drawing.put(11, stations.stations[j].ground);
    }
  for (std::size_t i = 0; i < n; ++i) {
    const PlacedStation& station = stations.stations[i];
    if (!has_ground(station)) continue;
    const Layer& layer = !active(station) ? kLeftOut : station.existing ? kExisting : kStations;
    drawing.entity("POINT", layer.name), drawing.put(10, station.ground);
    drawing.entity("CIRCLE", layer.name), drawing.put(10, station.ground), drawing.put(40, 0.6 * letter);
    drawing.entity("TEXT", kNames.name);
    drawing.put(10, station.ground + Vec3{0.9 * letter, 0.4 * letter, 0}), drawing.put(40, letter);
    drawing.put(1, dxf_text(stations.names[i]));
  }
  for (const Target& target : stations.targets) {
    const Layer& layer = target.control_m > 0 ? kControl : kTargets;
    drawing.entity("POINT", layer.name), drawing.put(10, target.centre);
    drawing.entity("CIRCLE", layer.name), drawing.put(10, target.centre), drawing.put(40, 0.3 * letter);
    drawing.entity("TEXT", kTargetNames.name);
    drawing.put(10, target.centre + Vec3{0.5 * letter, 0.3 * letter, 0}), drawing.put(40, 0.8 * letter);
    drawing.put(1, dxf_text(target.name));
  }
  drawing.end();
  drawing.put(0, "EOF");
  write_atomically(file, drawing.text());
}

}  // namespace vantage
