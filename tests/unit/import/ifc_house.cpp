// SPDX-License-Identifier: Apache-2.0
#include "ifc_house.hpp"

#include <vector>

#include "core/text.hpp"

namespace vantage::test {
namespace {

class StepText {
 public:
  explicit StepText(const IfcHouse& house) : house_(house) {
    const std::string metre = add(std::string("IFCSIUNIT(*,.LENGTHUNIT.,") +
                                  (house.unit == IfcUnit::millimetre ? ".MILLI." : "$") + ",.METRE.)");
    std::string length = metre;
    if (house.unit == IfcUnit::foot)
      length = add("IFCCONVERSIONBASEDUNIT(" + add("IFCDIMENSIONALEXPONENTS(1,0,0,0,0,0,0)") + ",.LENGTHUNIT.,'FOOT'," +
                   add("IFCMEASUREWITHUNIT(IFCLENGTHMEASURE(0.3048)," + metre + ")") + ")");
    const std::string angle = add("IFCSIUNIT(*,.PLANEANGLEUNIT.,$,.RADIAN.)");
    context_ = add("IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-05," + axes({}) + ",$)");
    project_ = add("IFCPROJECT(" + guid() + ",$,'Two rooms',$,$,$,$,(" + context_ + ")," +
                   add("IFCUNITASSIGNMENT((" + length + "," + angle + "))") + ")");
    up_ = add("IFCDIRECTION((0.,0.,1.))");
    site_placement_ = add("IFCLOCALPLACEMENT($," + axes(house.site_m) + ")");
    const std::string site =
        add("IFCSITE(" + guid() + ",$,'Meadow',$,$," + site_placement_ + ",$,$,.ELEMENT.,$,$,$,$,$)");
    const std::string building = add("IFCBUILDING(" + guid() + ",$,'House',$,$," + place({}) + ",$,$,.ELEMENT.,$,$,$)");
    storey_ = add("IFCBUILDINGSTOREY(" + guid() + ",$,'Ground floor',$,$," + place({}) + ",$,$,.ELEMENT.,0.)");
    aggregate(project_, {site});
    aggregate(site, {building});
    aggregate(building, {storey_});
  }

  std::string add(const std::string& entity) {
    lines_ += "#" + number(++count_) + "=" + entity + ";\n";
    return "#" + number(count_);
  }
  // IfcGloballyUniqueId: 22 letters, different each time.
  std::string guid() {
    std::string digits = number(++guids_);
    return "'0Vantage" + std::string(14 - digits.size(), '0') + digits + "'";
  }
  void aggregate(const std::string& whole, const std::vector<std::string>& parts) {
    add("IFCRELAGGREGATES(" + guid() + ",$,$,$," + whole + "," + list(parts) + ")");
  }
  // A solid from a corner on, in metres.
  std::string box(const Vec3& size, const std::string& style = "") {
    const std::string middle =
        add("IFCAXIS2PLACEMENT2D(" + add("IFCCARTESIANPOINT((" + length(size.x / 2) + "," + length(size.y / 2) + "))") +
            ",$)");
    const std::string profile =
        add("IFCRECTANGLEPROFILEDEF(.AREA.,$," + middle + "," + length(size.x) + "," + length(size.y) + ")");
    std::string solid =
        add("IFCEXTRUDEDAREASOLID(" + profile + "," + axes({}) + "," + up_ + "," + length(size.z) + ")");
    if (!style.empty()) add("IFCSTYLEDITEM(" + solid + ",(" + style + "),$)");
    return solid;
  }
  std::string shape(const std::vector<std::string>& solids) {
    return add("IFCPRODUCTDEFINITIONSHAPE($,$,(" +
               add("IFCSHAPEREPRESENTATION(" + context_ + ",'Body','SweptSolid'," + list(solids) + ")") + "))");
  }
  // A shape that several products have.
  std::string map(const std::string& solid) {
    return add("IFCREPRESENTATIONMAP(" + axes({}) + "," +
               add("IFCSHAPEREPRESENTATION(" + context_ + ",'Body','SweptSolid',(" + solid + "))") + ")");
  }
  std::string shape_of(const std::string& map) {
    const std::string in_place =
        add("IFCCARTESIANTRANSFORMATIONOPERATOR3D($,$," + add("IFCCARTESIANPOINT((0.,0.,0.))") + ",$,$)");
    return add("IFCPRODUCTDEFINITIONSHAPE($,$,(" +
               add("IFCSHAPEREPRESENTATION(" + context_ + ",'Body','MappedRepresentation',(" +
                   add("IFCMAPPEDITEM(" + map + "," + in_place + ")") + "))") +
               "))");
  }
  std::string style(double red, double green, double blue, double transparency) {
    const std::string colour = add("IFCCOLOURRGB($," + real(red) + "," + real(green) + "," + real(blue) + ")");
    const std::string rendering =
        add("IFCSURFACESTYLERENDERING(" + colour + "," + real(transparency) + ",$,$,$,$,$,$,.NOTDEFINED.)");
    return add("IFCPRESENTATIONSTYLEASSIGNMENT((" + add("IFCSURFACESTYLE($,.BOTH.,(" + rendering + "))") + "))");
  }
  // A product whose eight first attributes are those of IfcElement; `more` are its own in IFC 4, and in IFC 2x3.
  std::string element(const std::string& type, const std::string& name, const Vec3& corner, const std::string& form,
                      const std::string& more4, const std::string& more2x3 = "") {
    return add(type + "(" + guid() + ",$,'" + name + "',$,$," + place(corner) + "," + form + ",$" +
               (is4() ? more4 : more2x3) + ")");
  }
  std::string space(const std::string& number_of_room, const std::string& name, const Vec3& corner, const Vec3& size) {
    return add("IFCSPACE(" + guid() + ",$,'" + number_of_room + "',$,$," + place(corner) + "," + shape({box(size)}) +
               ",'" + name + "',.ELEMENT.," + (is4() ? "$" : ".INTERNAL.") + ",$)");
  }
  void contain(const std::vector<std::string>& elements) {
    add("IFCRELCONTAINEDINSPATIALSTRUCTURE(" + guid() + ",$,$,$," + list(elements) + "," + storey_ + ")");
  }
  // An opening of a wall, in the house's coordinates, and what fills it.
  void open(const std::string& wall, const Vec3& corner, const Vec3& size, const std::string& filling) {
    const std::string opening = element("IFCOPENINGELEMENT", "hole", corner, shape({box(size)}), ",.OPENING.");
    add("IFCRELVOIDSELEMENT(" + guid() + ",$,$,$," + wall + "," + opening + ")");
    add("IFCRELFILLSELEMENT(" + guid() + ",$,$,$," + opening + "," + filling + ")");
  }
  bool is4() const { return house_.version == IfcVersion::ifc4; }
  const std::string& storey() const { return storey_; }

  std::string text() const {
    return std::string("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('ViewDefinition [CoordinationView]'),'2;1');\n") +
           "FILE_NAME('house.ifc','2026-01-01T00:00:00',(''),(''),'','','');\nFILE_SCHEMA(('" +
           (is4() ? "IFC4" : "IFC2X3") + "'));\nENDSEC;\nDATA;\n" + lines_ + "ENDSEC;\nEND-ISO-10303-21;\n";
  }

 private:
  static std::string real(double value) {
    const std::string text = fixed(value, 6);
    return text;
  }
  std::string length(double metres) const {
    const double unit = house_.unit == IfcUnit::metre ? 1 : house_.unit == IfcUnit::millimetre ? 0.001 : 0.3048;
    return real(metres / unit);
  }
  std::string axes(const Vec3& at) {
    return add("IFCAXIS2PLACEMENT3D(" +
               add("IFCCARTESIANPOINT((" + length(at.x) + "," + length(at.y) + "," + length(at.z) + "))") + ",$,$)");
  }
  std::string place(const Vec3& at) { return add("IFCLOCALPLACEMENT(" + site_placement_ + "," + axes(at) + ")"); }
  static std::string list(const std::vector<std::string>& entities) {
    std::string out;
    for (const std::string& entity : entities) out += (out.empty() ? "(" : ",") + entity;
    return out + ")";
  }

  const IfcHouse house_;
  std::string lines_, context_, project_, up_, site_placement_, storey_;
  std::size_t count_ = 0, guids_ = 0;
};

}  // namespace

std::string ifc_house(const IfcHouse& house) {
  StepText step(house);
  const std::string plaster = step.style(0.8, 0.8, 0.8, 0), glass = step.style(0.5, 0.6, 0.7, 0.8);
  std::vector<std::string> parts;
  const auto wall = [&](const std::string& name, const Vec3& corner, const Vec3& size) {
    return parts.emplace_back(
        step.element("IFCWALL", name, corner, step.shape({step.box(size, plaster)}), ",.SOLIDWALL."));
  };
  const auto slab = [&](const std::string& name, double z) {
    parts.push_back(
        step.element("IFCSLAB", name, {0, 0, z}, step.shape({step.box({8.6, 4.4, 0.2})}), ",.FLOOR.", ",.FLOOR."));
  };
  const auto door = [&](const std::string& name, const Vec3& corner, const Vec3& size) {
    return parts.emplace_back(
        step.element("IFCDOOR", name, corner, step.shape({step.box(size)}), ",$,$,.DOOR.,$,$", ",$,$"));
  };
  slab("floor", -0.2);
  slab("ceiling", 2.5);
  const std::string south = wall("south", {0, 0, 0}, {8.6, 0.2, 2.5});
  wall("north", {0, 4.2, 0}, {8.6, 0.2, 2.5});
  wall("west", {0, 0.2, 0}, {0.2, 4, 2.5});
  wall("east", {8.4, 0.2, 0}, {0.2, 4, 2.5});
  const std::string middle = wall("middle", {4.2, 0.2, 0}, {0.2, 4, 2.5});
  step.open(south, {1.5, -0.1, 0}, {1, 0.4, 2.1}, door("front", {1.5, 0.05, 0}, {1, 0.1, 2.1}));
  step.open(middle, {4.1, 1.7, 0}, {0.4, 0.9, 2.1}, door("inner", {4.25, 1.7, 0}, {0.1, 0.9, 2.1}));
  const std::string window = parts.emplace_back(
      step.element("IFCWINDOW", "view", {6, 0.05, 0.9},
                   step.shape({step.box({1.5, 0.1, 0.1}, plaster), step.box({1.5, 0.02, 1.2}, glass)}),
                   ",$,$,.WINDOW.,$,$", ",$,$"));
  step.open(south, {6, -0.1, 0.9}, {1.5, 0.4, 1.2}, window);
  const std::string map = step.map(step.box({0.8, 0.6, 2}));
  const std::string cupboard = step.is4() ? "IFCFURNITURE" : "IFCFURNISHINGELEMENT";
  for (const double x : {0.3, 2.3})
    parts.push_back(step.element(cupboard, "cupboard", {x, 3.5, 0}, step.shape_of(map), ",$"));
  const std::string stair = parts.emplace_back(
      step.element("IFCSTAIR", "stair", {0, 0, 0}, "$", ",.STRAIGHT_RUN_STAIR.", ",.STRAIGHT_RUN_STAIR."));
  step.aggregate(stair, {step.element("IFCSTAIRFLIGHT", "flight", {7, 3, 0}, step.shape({step.box({1, 1, 0.17})}),
                                      ",$,$,$,$,$", ",$,$,$,$")});
  step.contain(parts);
  step.aggregate(step.storey(), {step.space("1", "Kitchen", {0.2, 0.2, 0}, {4, 4, 2.5}),
                                 step.space("2", "Hall", {4.4, 0.2, 0}, {4, 4, 2.5})});
  return step.text();
}

}  // namespace vantage::test
