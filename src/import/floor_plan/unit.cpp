// SPDX-License-Identifier: Apache-2.0
#include "import/floor_plan/unit.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <optional>
#include <string_view>

#include "import/floor_plan/swings.hpp"
#include "import/program.hpp"

namespace vantage::floor_plan {
namespace {

struct Unit {
  const char* name;
  int code;  // of $INSUNITS
  double metres;
};
constexpr std::array kUnits{Unit{"m", 6, 1.0}, Unit{"cm", 5, 0.01}, Unit{"mm", 4, 0.001}, Unit{"in", 1, 0.0254},
                            Unit{"ft", 2, 0.3048}};
// Widths of doors. The ranges of any two of the units do not meet, so at most one fits.
constexpr double kNarrowestDoor = 0.65, kWidestDoor = 1.3;

const Unit* by_doors(double width) {
  for (const Unit& unit : kUnits)
    if (const double metres = width * unit.metres; metres >= kNarrowestDoor && metres <= kWidestDoor) return &unit;
  return nullptr;
}

// The median radius of swings: those of doors by name if there are any, else all.
std::optional<double> door_width(const Drawing& drawing) {
  for (const bool named : {true, false}) {
    std::vector<double> radii;
    for (const Arc& arc : drawing.arcs)
      if ((!named || arc.from.kind == Kind::door) && may_swing(arc)) radii.push_back(arc.radius());
    if (radii.empty()) continue;
    const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
    std::ranges::nth_element(radii, middle);
    return *middle;
  }
  return std::nullopt;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string sizes(const Drawing& drawing) {
  Point low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()}, high{-low.x, -low.y};
  for (const Line& line : drawing.lines)
    for (const Point& p : {line.a, line.b}) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  std::string out;
  for (const Unit& unit : kUnits)
    out += std::string(out.empty() ? "" : ", ") + unit.name + " (" + number((high.x - low.x) * unit.metres) + " x " +
           number((high.y - low.y) * unit.metres) + " m)";
  return out;
}

}  // namespace

Scale scale_of(const Drawing& drawing, const std::string& unit) {
  if (!unit.empty()) {
    for (const Unit& known : kUnits)
      if (unit == known.name) return {known.metres, std::string("unit ") + known.name + ", as given"};
    throw importer::Refused("the unit \"" + unit + "\" is not m, cm, mm, in or ft");
  }
  const auto width = door_width(drawing);
  const Unit* doors = width ? by_doors(*width) : nullptr;
  const auto stated = std::ranges::find(kUnits, drawing.unit_code, &Unit::code);
  if (stated == kUnits.end() && doors)
    return {doors->metres, std::string("unit ") + doors->name + ", as its doors are " + number(*width) + " wide"};
  if (stated == kUnits.end())
    throw importer::Refused(
        "the drawing's unit is not clear: its header ($INSUNITS) states none, and no door's swing tells "
        "it; give the setting unit: " +
        sizes(drawing));
  if (doors && doors != &*stated)
    throw importer::Refused(std::string("the drawing's unit is not clear: its header ($INSUNITS) states ") +
                            stated->name + ", but its doors are " + number(*width) + " wide, as in " + doors->name +
                            "; give the setting unit: " + sizes(drawing));
  return {stated->metres, std::string("unit ") + stated->name + ", by its header"};
}

}  // namespace vantage::floor_plan
