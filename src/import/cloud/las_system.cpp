// SPDX-License-Identifier: Apache-2.0
#include "import/cloud/las_system.hpp"

#include <cmath>
#include <map>
#include <optional>

#include "core/coordinate_reference.hpp"
#include "core/utf8.hpp"
#include "import/cloud/byte_file.hpp"
#include "import/program.hpp"

namespace vantage::importer {
namespace {

using Kind = CoordinateReference::Kind;

constexpr double kSameUnit = 1e-9;

std::string quoted(const std::string& name) { return name.empty() ? "its coordinate system" : "\"" + name + "\""; }

void refuse_unusable(const CoordinateReference& system) {
  const std::string which = to_utf8(quoted(system.name));
  if (system.kind == Kind::geographic)
    throw Refused("its coordinates are degrees of latitude and longitude (" + which +
                  "); project them to metres, e.g. UTM");
  if (system.kind == Kind::geocentric)
    throw Refused("its coordinates are counted from the middle of the earth (" + which +
                  "); project them to metres, e.g. UTM");
  if (system.has_lengths() && !system.has_usual_axes())
    throw Refused("the axes of " + which + " point " + system.first.direction + " and " + system.second.direction +
                  "; export it in a system with axes east and north, as EPSG:5514 for Krovak's");
}

bool metric(const Eigen::Vector3d& metres) {
  return (metres - Eigen::Vector3d::Ones()).cwiseAbs().maxCoeff() <= kSameUnit;
}

std::string factor_text(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g m", metres);
  return text;
}

// Notes what is converted, and that the file does not tell the unit of heights.
void tell(DeclaredSystem& out, bool heights_told) {
  if (metric(out.metres)) return;
  const bool same = std::abs(out.metres.x() - std::abs(out.metres.z())) <= kSameUnit;
  std::string note = "its coordinates are in units of " + factor_text(out.metres.x());
  if (!same) note += ", and its heights in units of " + factor_text(std::abs(out.metres.z()));
  note += "; they are taken as metres";
  if (!heights_told) note += ", heights too, of whose unit nothing is said";
  out.notes.push_back(note);
  if (out.metres.z() < 0) out.notes.emplace_back("its heights are depths, and are turned upwards");
}

// `told`: the text or code of the system in the file, which is kept if its lengths are metres.
DeclaredSystem system_of(const CoordinateReference& system, const std::string& told) {
  refuse_unusable(system);
  DeclaredSystem out;
  if (!system.has_lengths()) {
    out.notes.push_back("of " + to_utf8(quoted(system.name)) + " no lengths are known, and it is left out");
    return out;
  }
  out.unit = true;
  const double height = system.height ? system.height->factor : system.first.factor;
  const bool depth = system.height && system.height->direction == "down";
  out.metres = {system.first.factor, system.second.factor, depth ? -height : height};
  tell(out, system.height.has_value());
  if (system.kind == Kind::projected) out.text = to_utf8(metric(out.metres) && !told.empty() ? told : system.in_metres);
  return out;
}

}  // namespace

DeclaredSystem system_of_text(const std::string& text) {
  const auto system = read_coordinate_reference(text);
  if (!system) {
    DeclaredSystem out;
    if (!text.empty()) out.notes.emplace_back("the text of its coordinate system cannot be read, and is left out");
    return out;
  }
  const bool first_version = text.starts_with("PROJCS[") || text.starts_with("COMPD_CS[");
  return system_of(*system, first_version ? text : "");
}

DeclaredSystem system_of_keys(std::string_view directory, std::string_view doubles) {
  constexpr std::uint16_t kModel = 1024, kGeographic = 2048, kProjected = 3072, kUnit = 3076, kUnitSize = 3077,
                          kVertical = 4096, kVerticalUnit = 4099, kDoubles = 34736, kUserDefined = 32767;
  std::map<std::uint16_t, std::uint16_t> keys;
  std::map<std::uint16_t, double> sizes;
  for (std::size_t at = 8; at + 8 <= directory.size(); at += 8) {
    const char* entry = directory.data() + at;
    const auto key = value_at<std::uint16_t>(entry), where = value_at<std::uint16_t>(entry + 2),
               value = value_at<std::uint16_t>(entry + 6);
    if (where == 0) keys[key] = value;
    if (where == kDoubles && (std::size_t{value} + 1) * sizeof(double) <= doubles.size())
      sizes[key] = value_at<double>(doubles.data() + value * sizeof(double));
  }
  const auto code = [&](std::uint16_t key) -> int {
    const auto found = keys.find(key);
    return found == keys.end() || found->second == kUserDefined ? 0 : found->second;
  };
  // Returns the unit that a key names by its code or by its size.
  const auto unit = [&](std::uint16_t key, std::uint16_t size) -> std::optional<double> {
    if (const auto known = code(key) > 0 ? epsg_length_unit(code(key)) : std::nullopt) return known->metres;
    const auto given = sizes.find(size);
    if (given != sizes.end() && std::isfinite(given->second) && given->second > 0) return given->second;
    return {};
  };
  constexpr int kModelGeographic = 2, kModelGeocentric = 3;
  if (code(kModel) == kModelGeographic)
    throw Refused("its coordinates are degrees of latitude and longitude; project them to metres, e.g. UTM");
  if (code(kModel) == kModelGeocentric)
    throw Refused("its coordinates are counted from the middle of the earth; project them to metres, e.g. UTM");

  const std::string plan = code(kProjected) > 0 ? "EPSG:" + std::to_string(code(kProjected)) : "";
  std::optional<CoordinateReference> system;
  std::string told = plan;
  if (!plan.empty() && code(kVertical) > 0) {
    told = plan + "+" + std::to_string(code(kVertical));
    system = read_coordinate_reference(told);
  }
  if (!system && !plan.empty()) {
    told = plan;
    system = read_coordinate_reference(plan);
  }
  const auto horizontal = unit(kUnit, kUnitSize), vertical = unit(kVerticalUnit, 0);
  DeclaredSystem out;
  if (system) {
    refuse_unusable(*system);
    if (system->kind == Kind::projected) {
      out.unit = true;
      out.metres.setConstant(horizontal.value_or(system->first.factor));
      if (system->height) out.metres.z() = system->height->factor;
      if (vertical) out.metres.z() = *vertical;
      if (system->height && system->height->direction == "down") out.metres.z() *= -1;
      const bool as_defined = std::abs(system->first.factor - 1) <= kSameUnit &&
                              (!system->height || std::abs(system->height->factor - 1) <= kSameUnit);
      out.text = as_defined && out.metres.z() > 0 ? told : system->in_metres;
    }
  } else if (!plan.empty()) {
    out.notes.push_back("its coordinate system " + plan + " is not known, and is left out");
  } else if (code(kModel) == 0 && code(kGeographic) > 0 && !horizontal) {
    throw Refused("its coordinates are degrees of latitude and longitude; project them to metres, e.g. UTM");
  }
  if (!out.unit && horizontal) {
    out.unit = true;
    out.metres.setConstant(*horizontal);
    if (vertical) out.metres.z() = *vertical;
  }
  if (out.unit) tell(out, vertical || (system && system->height));
  return out;
}

}  // namespace vantage::importer
