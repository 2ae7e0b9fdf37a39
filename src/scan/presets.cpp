// SPDX-License-Identifier: Apache-2.0
// Reads data/scanners.json, which the build embeds, and files of that form (see docs/scanners.md). Strict: a figure
// without a known source, or an unknown name, is an error, so that a typing mistake cannot pass as a scanner.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/closest_name.hpp"
#include "core/read_file.hpp"
#include "core/text.hpp"
#include "vantage/error.hpp"
#include "vantage/scanner.hpp"

namespace vantage {

extern const char* const built_in_presets;  // data/scanners.json, from the build

namespace {

using Json = nlohmann::json;

constexpr double kMostSwept = 16'777'216;  // as Scanner::check() allows

// A node of a presets file: its value, and its location for messages.
class Node {
 public:
  Node(const Json& value, std::string where, const std::set<std::string>* sources)
      : value_(&value), where_(std::move(where)), sources_(sources) {}

  [[noreturn]] void fail(const std::string& what) const { throw Error(Errc::malformed_file, where_ + ": " + what); }

  Node member(const std::string& name) const {
    if (!has(name)) fail("\"" + name + "\" is missing");
    return Node((*value_)[name], where_ + " / " + name, sources_);
  }
  bool has(const std::string& name) const { return value_->is_object() && value_->contains(name); }

  void only(std::initializer_list<const char*> known) const {
    if (!value_->is_object()) fail("must be an object");
    for (const auto& [name, ignored] : value_->items()) {
      if (std::none_of(known.begin(), known.end(), [&n = name](const char* k) { return n == k; }))
        fail("\"" + name + "\" is not known here");
    }
  }

  std::string text() const {
    if (!value_->is_string()) fail("must be a text");
    return value_->get<std::string>();
  }
  double number() const {
    if (!value_->is_number()) fail("must be a number");
    return value_->get<double>();
  }
  std::vector<double> numbers() const {
    if (!value_->is_array()) fail("must be an array of numbers");
    std::vector<double> found;
    for (const Json& entry : *value_) {
      if (!entry.is_number()) fail("must be an array of numbers");
      found.push_back(entry.get<double>());
    }
    return found;
  }
  // Every figure has its source beside it, or is marked as assumed. The other members are its values.
  const Node& sourced() const {
    const Node source = member("source");
    if (source.text() != "assumed" && !sources_->contains(source.text()))
      source.fail("\"" + source.text() + "\" is not among the scanner's sources");
    return *this;
  }
  double figure() const {
    only({"value", "source", "note"});
    return sourced().member("value").number();
  }
  const Json& json() const { return *value_; }

 private:
  const Json* value_;
  std::string where_;
  const std::set<std::string>* sources_;
};

// Returns the step angle of a setting ("3mm", "1/4"), from the maker's figures.
Angle step_of(const Node& setting) {
  const bool by_angle = setting.has("step_deg"), by_spacing = setting.has("spacing_mm"),
             by_turn = setting.has("pixels_per_turn");
  if (by_angle + by_spacing + by_turn != 1)
    setting.fail("needs one of \"step_deg\", \"spacing_mm\" with \"at_m\", \"pixels_per_turn\"");
  if (by_angle) return Angle::degrees(setting.member("step_deg").number());
  if (by_turn) return Angle::radians(2 * std::numbers::pi / setting.member("pixels_per_turn").number());
  return Angle::radians(setting.member("spacing_mm").number() * 1e-3 / setting.member("at_m").number());
}

// Returns the zeniths of rows that are listed by elevation, from the top or from the bottom.
std::vector<Angle> zeniths_of(const Node& node) {
  node.only({"value", "source", "note"});
  std::vector<double> elevations = node.sourced().member("value").numbers();
  if (elevations.empty()) node.member("value").fail("must have an elevation for each row");
  if (elevations.front() < elevations.back()) std::ranges::reverse(elevations);
  std::vector<Angle> zeniths;
  for (const double elevation : elevations) {
    if (!(elevation >= -90 && elevation <= 90)) node.member("value").fail("elevations must be from -90 to 90");
    if (!zeniths.empty() && !(zeniths.back() < Angle::degrees(90 - elevation)))
      node.member("value").fail("elevations must all rise or all fall");
    zeniths.push_back(Angle::degrees(90 - elevation));
  }
  return zeniths;
}

NoiseTable noise_of(const Node& node) {
  node.only({"distances_m", "reflectivities", "sigma_mm", "source", "note"});
  node.sourced();
  NoiseTable table;
  table.distances_m = node.member("distances_m").numbers();
  // A file without reflectivities gives one row for all of them.
  table.reflectivities =
      node.has("reflectivities") ? node.member("reflectivities").numbers() : std::vector<double>{0.5};
  const Node sigma = node.member("sigma_mm");
  if (!sigma.json().is_array() || sigma.json().size() != table.reflectivities.size())
    sigma.fail("must have a row for each reflectivity");
  for (std::size_t row = 0; row < sigma.json().size(); ++row) {
    if (!sigma.json()[row].is_array() || sigma.json()[row].size() != table.distances_m.size())
      sigma.fail("row " + std::to_string(row + 1) + " must have a value for each distance");
    for (const Json& value : sigma.json()[row]) {
      if (!value.is_number()) sigma.fail("row " + std::to_string(row + 1) + " must hold numbers");
      table.sigma_m.push_back(value.get<double>() * 1e-3);
    }
  }
  return table;
}

struct Document {
  Json json;
  std::string file;
  std::filesystem::path folder;  // of the files that it names

  Document() : Document(built_in_presets, "the built-in presets") {}
  explicit Document(const std::filesystem::path& path) : Document(text_of(path), path.string()) {
    folder = path.parent_path();
  }
  Document(const std::string& text, std::string name) : file(std::move(name)) {
    try {
      json = Json::parse(text);
    } catch (const Json::exception& e) {
      throw Error(Errc::malformed_file, file + ": not valid JSON: " + e.what());
    }
    if (!json.is_object() || json.value("format", Json()) != Json("vantage-scanners-1"))
      throw Error(Errc::malformed_file, file + ": \"format\" must be \"vantage-scanners-1\"");
    if (!json.contains("scanners") || !json["scanners"].is_object() || json["scanners"].empty())
      throw Error(Errc::malformed_file, file + ": \"scanners\" must be an object with at least one scanner");
  }
  const Json& scanners() const { return json["scanners"]; }

 private:
  static std::string text_of(const std::filesystem::path& path) { return read_file(path); }
};

// Returns the presets of a file, then the built-in ones.
std::vector<Document> documents(const std::filesystem::path& more) {
  std::vector<Document> all;
  if (!more.empty()) all.emplace_back(more);
  all.emplace_back();
  return all;
}

template <class Object>
std::string names_of(const Object& object) {
  std::string names;
  for (const auto& [name, ignored] : object.items()) names += (names.empty() ? "" : ", ") + name;
  return names;
}

// Returns directions along a line that turns and nods evenly, up and down between two elevations.
DirectionTable swept(const Node& sweep, double seconds, double points_per_second) {
  sweep.only({"turns_per_second", "nods_per_second", "elevations_deg", "source", "note"});
  sweep.sourced();
  const double turns = sweep.member("turns_per_second").number(), nods = sweep.member("nods_per_second").number();
  const Node field = sweep.member("elevations_deg");
  const std::vector<double> ends = field.numbers();
  if (ends.size() != 2 || !(ends[0] >= -90 && ends[0] < ends[1] && ends[1] <= 90))
    field.fail("must be a lower and an upper elevation, from -90 to 90");
  if (!(turns > 0 && turns <= 1e4 && nods > 0 && nods <= 1e4))
    sweep.fail("turns and nods must be above 0 and at most 1e4");
  const double rays = std::floor(seconds * points_per_second);
  if (!(rays >= 1 && rays <= kMostSwept))
    sweep.fail("must have from 1 to 2^24 points, and has " + std::to_string(rays));
  DirectionTable table;
  for (double k = 0; k < rays; ++k) {
    const double time = k / points_per_second, nod = time * nods - std::floor(time * nods);
    const double elevation = ends[0] + (ends[1] - ends[0]) * (1 - std::abs(1 - 2 * nod));
    table.directions.push_back(
        {Angle::degrees(90 - elevation), Angle::degrees(360 * (time * turns - std::floor(time * turns)))});
    table.times_s.push_back(time);
  }
  return table;
}

// Sets the field and steps of a setting: a grid, uneven rows or a list of directions.
void set_pattern(Scanner& scanner, const Document& document, const Node& node, const Node& chosen) {
  const auto leave_out = [&](std::initializer_list<const char*> names, const std::string& why) {
    for (const char* name : names)
      if (node.has(name)) node.fail("leave out \"" + std::string(name) + "\": " + why);
  };
  const bool by_file = chosen.has("directions_csv");
  if (by_file || chosen.has("seconds")) {
    leave_out({"horizontal_angle_deg", "vertical_angle_deg", "zenith_start_deg", "elevations_deg"},
              "directions tell the field");
    for (const char* name : {"step_deg", "spacing_mm", "pixels_per_turn"})
      if (chosen.has(name)) chosen.fail("directions have no \"" + std::string(name) + "\"");
    if (by_file && chosen.has("seconds")) chosen.fail("needs one of \"directions_csv\", \"seconds\"");
    DirectionTable table =
        by_file ? load_directions(document.folder / chosen.member("directions_csv").text())
                : swept(node.member("sweep"), chosen.member("seconds").number(), scanner.points_per_second);
    scanner.set_directions(std::move(table.directions), std::move(table.times_s));
    return;
  }
  scanner.azimuth_step = scanner.zenith_step = step_of(chosen);
  scanner.horizontal_angle = Angle::degrees(node.member("horizontal_angle_deg").figure());
  if (node.has("elevations_deg")) {
    leave_out({"vertical_angle_deg", "zenith_start_deg"}, "\"elevations_deg\" tell the vertical field");
    scanner.set_row_zeniths(zeniths_of(node.member("elevations_deg")));
  } else {
    scanner.vertical_angle = Angle::degrees(node.member("vertical_angle_deg").figure());
    if (node.has("zenith_start_deg")) scanner.zenith_start = Angle::degrees(node.member("zenith_start_deg").figure());
  }
}

// Reads the scanner `key` at `setting`; empty: its default setting.
Scanner read_scanner(const Document& document, const std::string& key, std::string setting) {
  std::set<std::string> sources;
  const Node node(document.scanners()[key], document.file + ": " + key, &sources);
  node.only({"name",
             "sources",
             "horizontal_angle_deg",
             "vertical_angle_deg",
             "zenith_start_deg",
             "elevations_deg",
             "sweep",
             "min_range_m",
             "max_range_m",
             "points_per_second",
             "beam_divergence_mrad",
             "exit_diameter_mm",
             "settings",
             "default_setting",
             "noise",
             "detection",
             "angle_accuracy_arcsec",
             "range_accuracy_mm",
             "range_accuracy_ppm",
             "tilt_accuracy_arcsec",
             "battery",
             "dropout"});
  const Node listed = node.member("sources");
  if (!listed.json().is_object()) listed.fail("must be an object of texts");
  for (const auto& [name, ignored] : listed.json().items()) {
    if (listed.member(name).text().empty()) listed.member(name).fail("must name a document");
    sources.insert(name);
  }

  const Node settings = node.member("settings");
  if (setting.empty()) setting = node.member("default_setting").text();
  if (!settings.has(setting)) {
    throw Error(Errc::invalid_argument,
                "scanner \"" + key + "\" has no setting \"" + setting + "\"; it has " + names_of(settings.json()));
  }
  const Node chosen = settings.member(setting);
  chosen.only({"step_deg", "spacing_mm", "at_m", "pixels_per_turn", "directions_csv", "seconds", "min_range_m",
               "max_range_m", "points_per_second", "detection_range_m", "noise_factor", "source", "note"});
  chosen.sourced();

  Scanner scanner;
  scanner.name = node.member("name").text() + " @" + setting;
  // A setting's own figures take precedence over the scanner's.
  const auto own_or_common = [&](const char* name) {
    return chosen.has(name) ? chosen.member(name).number() : node.member(name).figure();
  };
  scanner.min_range_m = own_or_common("min_range_m");
  scanner.max_range_m = own_or_common("max_range_m");
  if (chosen.has("points_per_second") || node.has("points_per_second"))
    scanner.points_per_second = own_or_common("points_per_second");
  set_pattern(scanner, document, node, chosen);
  if (node.has("beam_divergence_mrad"))
    scanner.beam_divergence = Angle::radians(node.member("beam_divergence_mrad").figure() * 1e-3);
  if (node.has("exit_diameter_mm")) scanner.exit_diameter_m = node.member("exit_diameter_mm").figure() * 1e-3;
  if (node.has("angle_accuracy_arcsec"))
    scanner.angle_accuracy = Angle::degrees(node.member("angle_accuracy_arcsec").figure() / 3600);
  if (node.has("range_accuracy_mm")) scanner.range_accuracy_m = node.member("range_accuracy_mm").figure() * 1e-3;
  if (node.has("range_accuracy_ppm")) scanner.range_accuracy_ppm = node.member("range_accuracy_ppm").figure();
  if (node.has("tilt_accuracy_arcsec"))
    scanner.tilt_accuracy = Angle::degrees(node.member("tilt_accuracy_arcsec").figure() / 3600);
  if (node.has("battery")) {
    const Node battery = node.member("battery");
    battery.only({"minutes", "scans", "source", "note"});
    battery.sourced();
    if (!battery.has("minutes") && !battery.has("scans")) battery.fail("needs minutes or scans");
    if (battery.has("minutes")) scanner.battery_min = battery.member("minutes").number();
    if (battery.has("scans")) scanner.battery_scans = battery.member("scans").number();
  }
  if (node.has("noise")) scanner.noise = noise_of(node.member("noise"));
  if (chosen.has("noise_factor")) {
    const Node factor = chosen.member("noise_factor");
    const double times = factor.figure();
    if (!(times > 0 && times <= 100)) factor.member("value").fail("must be above 0 and at most 100");
    if (scanner.noise.empty()) factor.fail("the scanner has no noise table to multiply");
    for (double& sigma : scanner.noise.sigma_m) sigma *= times;
  }
  if (node.has("detection")) {
    const Node detection = node.member("detection");
    detection.only({"range_m", "reflectivity", "source", "note"});
    detection.sourced();
    scanner.detection_range_m =
        (chosen.has("detection_range_m") ? chosen.member("detection_range_m") : detection.member("range_m")).number();
    scanner.detection_reflectivity = detection.member("reflectivity").number();
  }
  if (node.has("dropout")) scanner.dropout = node.member("dropout").figure();
  try {
    scanner.check();
  } catch (const Error& e) {
    node.fail("setting " + setting + ": " + e.what());
  }
  return scanner;
}

}  // namespace

Scanner load_scanner(const std::string& name, const std::filesystem::path& more) {
  const std::size_t at = name.find('@');
  const std::string said = lower_case(name.substr(0, at));
  const std::string key = said.substr(0, said.find_last_not_of(' ') + 1);
  const std::string setting = at == std::string::npos ? "" : lower_case(name.substr(at + 1));
  if (at != std::string::npos && setting.empty())
    throw Error(Errc::invalid_argument, "scanner \"" + name + "\": a setting must follow the @, as in rtc360@6mm");
  std::string known;
  std::vector<std::string> keys;
  for (const Document& document : documents(more)) {
    if (document.scanners().contains(key)) return read_scanner(document, key, setting);
    for (const auto& [own, entry] : document.scanners().items()) {
      if (lower_case(entry.value("name", "")) == key) return read_scanner(document, own, setting);
      keys.push_back(own);
    }
    known += (known.empty() ? "" : "; ") + document.file + ": " + names_of(document.scanners());
  }
  throw Error(Errc::invalid_argument, "there is no scanner \"" + key + "\": " + known + did_you_mean(key, keys));
}

std::vector<ScannerPreset> list_scanners(const std::filesystem::path& more) {
  std::vector<ScannerPreset> list;
  const auto add = [&](const Document& document, const std::string& key, const Json& entry) {
    if (std::any_of(list.begin(), list.end(), [&](const ScannerPreset& known) { return known.key == key; })) return;
    const Scanner scanner = read_scanner(document, key, "");
    char figures[160];
    const std::string rows = !scanner.directions.empty()    ? std::to_string(scanner.rows()) + " directions, "
                             : !scanner.row_zeniths.empty() ? std::to_string(scanner.rows()) + " rows, "
                                                            : "";
    std::snprintf(figures, sizeof figures, ": %.4g° around, %szenith %.4g° to %.4g°, %.3g to %.4g m, ",
                  scanner.horizontal_angle.in_degrees(), rows.c_str(), scanner.zenith_start.in_degrees(),
                  scanner.zenith_start.in_degrees() + scanner.vertical_angle.in_degrees() / 2, scanner.min_range_m,
                  scanner.max_range_m);
    list.push_back({key, entry["name"].get<std::string>() + figures + describe(scanner.noise) + "; settings " +
                             names_of(entry["settings"]) + " (default " + entry["default_setting"].get<std::string>() +
                             ")"});
  };
  for (const Document& document : documents(more)) {
    for (const auto& [key, entry] : document.scanners().items()) add(document, key, entry);
  }
  return list;
}

std::filesystem::path own_presets_file() {
  const char* const folder = std::getenv("VANTAGE_DATA");
  return folder && *folder ? std::filesystem::path(folder) / "scanners.json" : std::filesystem::path();
}

}  // namespace vantage
