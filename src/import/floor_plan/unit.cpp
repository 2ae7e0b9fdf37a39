// SPDX-License-Identifier: Apache-2.0
#include "import/floor_plan/unit.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include "import/floor_plan/grid.hpp"
#include "import/floor_plan/swings.hpp"
#include "import/program.hpp"

namespace vantage::floor_plan {
namespace {

struct Unit {
  const char* name;
  int code;  // of $INSUNITS
  double metres;
};
constexpr int kInch = 1;
constexpr std::array kUnits{Unit{"m", 6, 1.0}, Unit{"cm", 5, 0.01}, Unit{"mm", 4, 0.001}, Unit{"in", kInch, 0.0254},
                            Unit{"ft", 2, 0.3048}};
// That a header may state, too.
constexpr double kSurveyFoot_m = 1200.0 / 3937;
constexpr std::array kOtherUnits{Unit{"mi", 3, 1609.344},
                                 Unit{"km", 7, 1000},
                                 Unit{"microinch", 8, 2.54e-8},
                                 Unit{"mil", 9, 2.54e-5},
                                 Unit{"yd", 10, 0.9144},
                                 Unit{"angstrom", 11, 1e-10},
                                 Unit{"nm", 12, 1e-9},
                                 Unit{"micrometre", 13, 1e-6},
                                 Unit{"dm", 14, 0.1},
                                 Unit{"dam", 15, 10},
                                 Unit{"hm", 16, 100},
                                 Unit{"Gm", 17, 1e9},
                                 Unit{"US survey foot", 21, kSurveyFoot_m},
                                 Unit{"US survey inch", 22, kSurveyFoot_m / 12},
                                 Unit{"US survey yard", 23, 3 * kSurveyFoot_m},
                                 Unit{"US survey mile", 24, 5280 * kSurveyFoot_m}};
// Widths of doors. The ranges of any two of the units do not meet, so at most one fits.
constexpr double kNarrowestDoor = 0.65, kWidestDoor = 1.3;

bool fits(double door, const Unit& unit) {
  return door * unit.metres >= kNarrowestDoor && door * unit.metres <= kWidestDoor;
}

const Unit* by_doors(double width) {
  const auto found = std::ranges::find_if(kUnits, [&](const Unit& unit) { return fits(width, unit); });
  return found == kUnits.end() ? nullptr : &*found;
}

const Unit* by_code(int code) {
  for (const std::span<const Unit> units : {std::span<const Unit>(kUnits), std::span<const Unit>(kOtherUnits)})
    if (const auto found = std::ranges::find(units, code, &Unit::code); found != units.end()) return &*found;
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

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string sizes(const Drawing& drawing) {
  Point low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()}, high{-low.x, -low.y};
  const auto reach = [&](Point p) { low = lowest(low, p), high = highest(high, p); };
  for (const Line& line : drawing.lines) reach(line.a), reach(line.b);
  for (const Arc& arc : drawing.arcs) reach(arc.start), reach(arc.end());
  for (const Curve& curve : drawing.curves) std::ranges::for_each(curve.points, reach);
  for (const Area& area : drawing.areas)
    for (const auto& ring : area.rings) std::ranges::for_each(ring, reach);
  std::string out;
  for (const Unit& unit : kUnits)
    out += std::string(out.empty() ? "" : ", ") + unit.name + " (" + rounded((high.x - low.x) * unit.metres) + " x " +
           rounded((high.y - low.y) * unit.metres) + " m)";
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
  const Unit* stated = by_code(drawing.unit_code);
  const char* by = "its header ($INSUNITS)";
  if (!stated && drawing.in_inches) stated = by_code(kInch), by = "its header ($LUNITS, feet and inches)";
  if (!stated && doors)
    return {doors->metres, std::string("unit ") + doors->name + ", as its doors are " + rounded(*width) + " wide"};
  if (!stated)
    throw importer::Refused(
        "the drawing's unit is not clear: its header ($INSUNITS) states none, and no door's swing tells "
        "it; give the setting unit: " +
        sizes(drawing));
  if (doors && !fits(*width, *stated))
    throw importer::Refused(std::string("the drawing's unit is not clear: ") + by + " states " + stated->name +
                            ", but its doors are " + rounded(*width) + " wide, as in " + doors->name +
                            "; give the setting unit: " + sizes(drawing));
  return {stated->metres, std::string("unit ") + stated->name + ", by its header"};
}

}  // namespace vantage::floor_plan
