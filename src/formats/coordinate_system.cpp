// SPDX-License-Identifier: Apache-2.0
// Coordinate reference systems for LAS 1.4: well-known text of OGC 01-009 (Coordinate Transformation Services, 2001),
// from PROJ for a code of the EPSG registry, or as given.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "core/coordinate_reference.hpp"
#include "core/read_file.hpp"
#include "core/text.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"

namespace vantage {
namespace {

[[noreturn]] void refuse(const std::string& why) { throw Error(Errc::invalid_argument, why); }

// The factor of the UNIT that stands directly in a PROJCS, LOCAL_CS or GEOCCS.
std::optional<double> unit_of(const std::string& text) {
  int depth = 0, system = -1;
  bool quoted = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    for (const char* begin : {"PROJCS[", "LOCAL_CS[", "GEOCCS["})
      if (system < 0 && text.compare(at, std::string_view(begin).size(), begin) == 0) system = depth + 1;
    if (depth == system && text.compare(at, 5, "UNIT[") == 0) {
      const std::size_t comma = text.find(',', text.find('"', text.find('"', at) + 1));
      double factor = 0;
      if (comma == std::string::npos) return std::nullopt;
      std::size_t first = comma + 1;
      while (first < text.size() && text[first] == ' ') ++first;
      if (std::from_chars(text.data() + first, text.data() + text.size(), factor).ec != std::errc())
        return std::nullopt;
      return factor;
    }
    depth += c == '[' ? 1 : c == ']' ? -1 : 0;
  }
  return std::nullopt;
}

// Joins the text to one line and removes blanks around brackets and commas outside of quotes.
std::string one_line(const std::string& text) {
  std::string line;
  bool quoted = false, blank = false;
  for (const char c : text) {
    if (c == '\0') break;
    if (c == '"') quoted = !quoted;
    if (!quoted && (c == ' ' || c == '\n' || c == '\r' || c == '\t')) {
      blank = true;
      continue;
    }
    if (blank && !line.empty() && line.back() != ',' && line.back() != '[' && c != ']' && c != ',' && c != '[')
      line += ' ';
    blank = false;
    line += c;
  }
  return line;
}

// Refuses a system whose coordinates are not metres east, north and up.
void check(const CoordinateReference& system, const std::string& source) {
  using Kind = CoordinateReference::Kind;
  const std::string which = source + ": " + (system.name.empty() ? "" : system.name + ": ");
  if (system.kind == Kind::geographic)
    refuse(which + "longitude and latitude are angles; vantage's points are in metres: give a projected system");
  if (system.kind == Kind::geocentric)
    refuse(which +
           "its axes begin in the middle of the earth, and vantage's point east, north and up: give a projected "
           "system");
  if (!system.has_lengths()) refuse(which + "it is no projected system; give one, as EPSG:25832");
  if (!system.has_usual_axes())
    refuse(which + "its axes point " + system.first.direction + " and " + system.second.direction +
           ", and vantage's east and north: turn the site, and give the system of these axes (of Krovak's that is "
           "EPSG:5514)");
  for (const auto* axis : {&system.first, &system.second})
    if (std::abs(axis->factor - 1) > 1e-9)
      refuse(which + "its unit is " + number(axis->factor) + " m; vantage's points are in metres");
  if (system.height && std::abs(system.height->factor - 1) > 1e-9)
    refuse(which + "the unit of its heights is " + number(system.height->factor) +
           " m; vantage's points are in metres: give the system in plan alone, or one with heights in metres, as "
           "EPSG:26918+5703");
  if (system.height && system.height->direction == "down")
    refuse(which + "it counts depths, and vantage's points have heights: give the system in plan alone");
}

std::string checked(const std::string& written, const std::string& source) {
  const std::string text = one_line(written);
  const auto begins = [&](std::initializer_list<const char*> words) {
    return std::any_of(words.begin(), words.end(), [&](const char* word) { return text.starts_with(word); });
  };
  const bool first_version = begins({"PROJCS[", "COMPD_CS[", "LOCAL_CS["});
  const auto system = read_coordinate_reference(text);
  if (system) check(*system, source);
  if (!system && begins({"GEOGCS", "GEOGCRS", "GEODCRS"}))
    refuse(source + ": longitude and latitude are angles; vantage's points are in metres: give a projected system");
  if (!system && !first_version)
    refuse(source + ": is no well-known text of a coordinate system that PROJ understands; that begins with PROJCS[, " +
           "PROJCRS[, COMPD_CS[, COMPOUNDCRS[ or LOCAL_CS[");
  if (std::count(text.begin(), text.end(), '[') != std::count(text.begin(), text.end(), ']') || text.back() != ']')
    refuse(source + ": the well-known text does not end: its brackets do not match");
  // LAS 1.4 needs version 1 (OGC 01-009).
  const std::string result = first_version ? text : system->text;
  if (result.empty())
    refuse(source +
           ": its well-known text cannot be told in version 1 (OGC 01-009), which LAS 1.4 needs; give a system "
           "that begins with PROJCS");
  if (result.size() > 65'534) refuse(source + ": the well-known text is longer than LAS can hold");
  const auto unit = system ? std::nullopt : unit_of(result);
  if (unit && std::abs(*unit - 1) > 1e-9)
    refuse(source + ": its unit is " + number(*unit) + " m; vantage's points are in metres");
  return result;
}

// `codes`: of a system, or of one in plan and one of heights, as 26918+5703.
std::string of_code(std::string_view codes, const std::string& asked) {
  const std::size_t plus = codes.find('+');
  for (const std::string_view part : {codes.substr(0, plus), plus < codes.size() ? codes.substr(plus + 1) : "0"}) {
    int code = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), code);
    if (part.empty() || error != std::errc() || end != part.data() + part.size())
      refuse("'" + asked + "' is no coordinate system: give EPSG and its number, as EPSG:25832");
  }
  const auto system = read_coordinate_reference("EPSG:" + std::string(codes));
  if (!system)
    refuse("PROJ knows no coordinate system " + asked +
           " (its registry comes with proj-data); give another code, or a file of well-known text, as SITE.prj");
  check(*system, asked);
  if (system->text.empty())
    refuse(asked + ": it cannot be told as well-known text of version 1, which LAS 1.4 needs; give another system");
  return system->text;
}

}  // namespace

std::string coordinate_system(const std::string& text) {
  if (text.size() > 5 && (text.starts_with("EPSG:") || text.starts_with("epsg:"))) return of_code(text.substr(5), text);
  if (text.find('[') != std::string::npos) return checked(text, "the coordinate system");
  if (text.ends_with(".prj") || text.ends_with(".wkt")) return checked(read_file(text), text);
  refuse("'" + text +
         "' is no coordinate system: give EPSG:25832 and the like, or a file of well-known text (.prj, .wkt)");
}

}  // namespace vantage
