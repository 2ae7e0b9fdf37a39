// SPDX-License-Identifier: Apache-2.0
#include "cli/area.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string_view>

#include "cli/options.hpp"
#include "cli/parse.hpp"
#include "core/read_file.hpp"

namespace vantage::cli {
namespace {

using Ring = std::vector<std::array<double, 2>>;

template <std::size_t N>
Setter numbers_into(std::optional<std::array<double, N>>& target, const Interval& interval) {
  return [&target, interval](const std::string& text, const std::string& what) {
    const auto values = parse_numbers(text, what, N, N, interval);
    std::array<double, N> all{};
    std::copy(values.begin(), values.end(), all.begin());
    target = all;
  };
}

void add_rings(const nlohmann::json& polygon, PlanRegion& region) {
  for (const auto& line : polygon) {
    Ring ring;
    for (const auto& point : line) ring.push_back({point.at(0).get<double>(), point.at(1).get<double>()});
    if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();  // GeoJSON says it twice
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

// Corners, x and y on each line, parted by commas, semicolons, tabs or blanks. A first line without numbers is a
// header.
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
      throw Error(Errc::malformed_file, fmt::format("{}:{}: \"{}\" is no corner x,y", file, line_number, text));
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
  if (region.rings.empty()) throw Error(Errc::malformed_file, file + ": holds no Polygon or MultiPolygon");
  for (const Ring& ring : region.rings)
    if (ring.size() < 3)
      throw Error(Errc::malformed_file,
                  fmt::format("{}: a polygon needs three corners, one has {}", file, ring.size()));
  return region;
}

void AreaOptions::add(CLI::App& command, SceneOptions& roles) {
  add_value(command, "--security", "H1,H2,R",
            "Clear space a station needs: two spheres of radius R at heights H1 and H2 above the ground; R 0: none",
            numbers_into(security, not_negative))
      ->group("Placement");
  add_number(command, "--slope", "DEG", "Steepest ground that counts as walkable, where the scene marks no search area",
             slope, {.low = 0, .high = 90, .high_included = false})
      ->group("Placement");
  add_number(command, "--headroom", "M", "Clear height that walkable ground needs", headroom, not_negative)
      ->group("Placement");
  add_number(command, "--min-area", "M2", "Smallest connected piece of walkable ground", min_area, not_negative)
      ->group("Placement");
  add_value(command, "--passage", "W,H", "Width and height of the narrowest opening that a person passes; 0.6,1.9",
            numbers_into(passage, positive))
      ->group("Placement");
  add_number(command, "--climb", "M", "Highest step that a person takes; 0.25", climb, not_negative)
      ->group("Placement");
  add_value(command, "--enter", "X,Y,Z", "Where one enters the site; found by itself otherwise",
            numbers_into(enter, any_number))
      ->group("Placement");
  add_texts(command, "--doors", "PATTERN", "Nodes that are closed doors, which count as open for who walks",
            roles.doors)
      ->group("Placement");
  add_texts(command, "--station-area", "PATTERN", "Nodes to stand on that stay what they are, as surveyed",
            roles.station_area)
      ->group("Placement");
  add_value(command, "--levels", "LOW,HIGH", "Heights of ground between which stations may stand",
            numbers_into(levels, any_number))
      ->group("Placement");
  add_texts(command, "--within", "FILE", "Stations only within a polygon: GeoJSON, or a CSV file with x,y a line",
            within)
      ->group("Placement");
  add_texts(command, "--without", "FILE", "No stations within a polygon", without)->group("Placement");
}

WalkableOptions AreaOptions::walkable(double scale) const {
  WalkableOptions walkable;
  if (slope) walkable.max_slope = Angle::degrees(*slope);
  walkable.headroom_m = headroom.value_or(walkable.headroom_m * scale);
  walkable.min_area_m2 = min_area.value_or(walkable.min_area_m2 * scale * scale);
  walkable.passage_width_m = passage ? (*passage)[0] : walkable.passage_width_m * scale;
  walkable.passage_height_m = passage ? (*passage)[1] : walkable.passage_height_m * scale;
  walkable.climb_m = climb.value_or(walkable.climb_m * scale);
  if (enter) walkable.enter = Vec3{(*enter)[0], (*enter)[1], (*enter)[2]};
  walkable.levels = levels;
  if (levels && (*levels)[0] > (*levels)[1])
    throw Error(Errc::invalid_argument, fmt::format("--levels: {:g} is not below {:g}", (*levels)[0], (*levels)[1]));
  for (const std::string& file : within) walkable.within.push_back(read_region(file));
  for (const std::string& file : without) walkable.without.push_back(read_region(file));
  return walkable;
}

SecurityVolume AreaOptions::volume(double scale) const {
  if (security) return {(*security)[0], (*security)[1], (*security)[2]};
  SecurityVolume volume;
  volume.lower_m *= scale;
  volume.upper_m *= scale;
  volume.radius_m *= scale;
  return volume;
}

void AreaOptions::add_files_to(nlohmann::json& options) const {
  for (const auto& [name, files] : {std::pair{"within", &within}, {"without", &without}})
    for (const std::string& file : *files) options[name].push_back(std::filesystem::absolute(file).string());
}

void tell_area(const SearchArea& area, const Scene& scene) {
  spdlog::info("search area: {}", area.description());
  std::string left_out;
  bool sealed = false;
  for (const LeftOut& out : area.left_out()) {
    left_out += fmt::format("{}{:.3g} m² {}", left_out.empty() ? "" : ", ", out.area_m2, to_string(out.reason));
    sealed = sealed || (out.reason == LeftOutReason::sealed && out.area_m2 >= 1);
  }
  if (!left_out.empty()) spdlog::info("left out of the search area: {}", left_out);
  if (!sealed || !scene.options().doors.empty()) return;
  for (const MeshInfo& mesh : scene.meshes()) {
    std::string name;
    for (const char c : mesh.name) name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (name.find("door") == std::string::npos) continue;
    spdlog::info("what is sealed may lie behind closed doors, as \"{}\": --doors opens them", mesh.name);
    return;
  }
}

}  // namespace vantage::cli
