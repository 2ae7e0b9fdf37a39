// SPDX-License-Identifier: Apache-2.0
#include "import/floor_plan/unit.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "core/rounded.hpp"
#include "import/floor_plan/dxf.hpp"
#include "import/floor_plan/grid.hpp"
#include "import/floor_plan/swings.hpp"
#include "import/program.hpp"

namespace vantage::floor_plan {
namespace {

constexpr int kInch = 1;
const std::array kUnits{*unit_of_code(6), *unit_of_code(5), *unit_of_code(4), *unit_of_code(kInch), *unit_of_code(2)};
// Widths of doors. Ranges of different units do not overlap, so that at most one unit fits.
constexpr double kNarrowestDoor = 0.65, kWidestDoor = 1.3;

bool fits(double door, const DxfUnit& unit) {
  return door * unit.metres >= kNarrowestDoor && door * unit.metres <= kWidestDoor;
}

const DxfUnit* by_doors(double width) {
  const auto found = std::ranges::find_if(kUnits, [&](const DxfUnit& unit) { return fits(width, unit); });
  return found == kUnits.end() ? nullptr : &*found;
}

// Returns the median radius of swings: of doors by name if there are any, else of all.
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

std::string sizes(const Drawing& drawing) {
  Point low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()}, high{-low.x, -low.y};
  const auto reach = [&](Point p) { low = lowest(low, p), high = highest(high, p); };
  for (const Line& line : drawing.lines) reach(line.a), reach(line.b);
  for (const Arc& arc : drawing.arcs) reach(arc.start), reach(arc.end());
  for (const Curve& curve : drawing.curves) std::ranges::for_each(curve.points, reach);
  for (const Area& area : drawing.areas)
    for (const auto& ring : area.rings) std::ranges::for_each(ring, reach);
  std::string out;
  for (const DxfUnit& unit : kUnits)
    out += std::string(out.empty() ? "" : ", ") + unit.name + " (" + rounded((high.x - low.x) * unit.metres) + " x " +
           rounded((high.y - low.y) * unit.metres) + " m)";
  return out;
}

}  // namespace

Scale scale_of(const Drawing& drawing, const std::string& unit) {
  if (!unit.empty()) {
    for (const DxfUnit& known : kUnits)
      if (unit == known.name) return {known.metres, std::string("unit ") + known.name + ", as given"};
    throw importer::Refused("the unit \"" + unit + "\" is not m, cm, mm, in or ft");
  }
  const auto width = door_width(drawing);
  const DxfUnit* doors = width ? by_doors(*width) : nullptr;
  const DxfUnit* stated = unit_of_code(drawing.unit_code);
  const char* by = "its header ($INSUNITS)";
  if (!stated && drawing.in_inches) stated = unit_of_code(kInch), by = "its header ($LUNITS, feet and inches)";
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
  const bool sure = width && fits(*width, *stated);
  return {stated->metres, std::string("unit ") + stated->name + ", by its header", sure, sure ? "" : sizes(drawing)};
}

void doubt_unit(const Scale& scale, const std::vector<WallFace>& faces) {
  // Returns true if, scaled by `factor`, most lines are those of walls with a room between them.
  const auto suits = [&](double factor) {
    constexpr double kRoom_m2 = 6;
    double walls_m = 0, others_m = 0;
    bool room = false;
    for (const WallFace& face : faces) {
      const double wide = factor * face.wide_m();
      if (wide >= kThinnestWall_m && wide <= kThickestWall_m) walls_m += face.perimeter_m;
      if (wide <= kThickestWall_m) continue;
      others_m += face.perimeter_m;
      room = room || factor * factor * face.area_m2 >= kRoom_m2;
    }
    return room && walls_m >= others_m;
  };
  if (scale.sure || suits(1)) return;
  for (const DxfUnit& unit : kUnits)
    if (suits(unit.metres / scale.metres))
      throw importer::Refused("the drawing's unit is not clear (" + scale.note +
                              "): its walls and rooms are those of a " + "building in " + unit.name +
                              "; give the setting unit: " + scale.sizes);
}

}  // namespace vantage::floor_plan
