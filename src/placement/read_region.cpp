// SPDX-License-Identifier: Apache-2.0
#include <cctype>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>

#include "core/read_file.hpp"
#include "core/read_json.hpp"
#include "vantage/error.hpp"
#include "vantage/placement.hpp"

namespace vantage {
namespace {

using Ring = std::vector<std::array<double, 2>>;

void add_rings(const nlohmann::json& polygon, PlanRegion& region) {
  for (const auto& line : polygon) {
    Ring ring;
    for (const auto& point : line) ring.push_back({point.at(0).get<double>(), point.at(1).get<double>()});
    if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();  // GeoJSON repeats it
    region.rings.push_back(std::move(ring));
  }
}

void add_geometry(const nlohmann::json& object, PlanRegion& region) {
  const std::string type = object.at("type").get<std::string>();
  if (type == "FeatureCollection")
    for (const auto& feature : object.at("features")) add_geometry(feature, region);
  else if (type == "Feature")
    add_geometry(object.at("geometry"), region);
  else if (type == "GeometryCollection")
    for (const auto& geometry : object.at("geometries")) add_geometry(geometry, region);
  else if (type == "Polygon")
    add_rings(object.at("coordinates"), region);
  else if (type == "MultiPolygon")
    for (const auto& polygon : object.at("coordinates")) add_rings(polygon, region);
}

// Reads corners, one x and y per line, separated by commas, semicolons, tabs or blanks. A first line without numbers is
// a header.
PlanRegion read_corners(std::istream& in, const std::string& file) {
  Ring ring;
  std::size_t line_number = 0;
  for (std::string line; std::getline(in, line);) {
    ++line_number;
    std::string_view text = line;
    if (line_number == 1 && text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    std::vector<double> numbers;
    bool readable = true, any = false;
    for (std::size_t at = 0; at < text.size();) {
      const auto parts = [](char c) {
        return c == ',' || c == ';' || std::isspace(static_cast<unsigned char>(c)) != 0;
      };
      if (parts(text[at])) {
        ++at;
        continue;
      }
      std::size_t end = at;
      while (end < text.size() && !parts(text[end])) ++end;
      any = true;
      double number = 0;
      const auto [last, error] = std::from_chars(text.data() + at, text.data() + end, number);
      readable = readable && error == std::errc() && last == text.data() + end && std::isfinite(number);
      numbers.push_back(number);
      at = end;
    }
    if (!any || text.front() == '#') continue;
    if (!readable && ring.empty() && line_number == 1) continue;
    if (!readable || numbers.size() < 2)
      throw Error(Errc::malformed_file,
                  file + ":" + std::to_string(line_number) + ": \"" + line + "\" is no corner x,y");
    ring.push_back({numbers[0], numbers[1]});
  }
  if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  return {{ring}};
}

}  // namespace

PlanRegion read_region(const std::string& file) {
  PlanRegion region;
  if (file.ends_with(".json") || file.ends_with(".geojson")) {
    const auto json = read_json(file);
    try {
      add_geometry(json, region);
    } catch (const nlohmann::json::exception& error) {
      throw Error(Errc::malformed_file, file + ": is not GeoJSON: " + error.what());
    }
  } else {
    std::istringstream in(read_file(file));
    region = read_corners(in, file);
  }
  region.file = file;
  if (region.rings.empty()) throw Error(Errc::malformed_file, file + ": holds no Polygon or MultiPolygon");
  for (const Ring& ring : region.rings)
    if (ring.size() < 3)
      throw Error(Errc::malformed_file,
                  file + ": a polygon needs three corners, one has " + std::to_string(ring.size()));
  return region;
}

}  // namespace vantage
