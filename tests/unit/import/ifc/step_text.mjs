// SPDX-License-Identifier: Apache-2.0
// Writes IFC as STEP text, for tests: a project of one storey, to which products are added.

export const real = (v) => (Number.isInteger(v) ? `${v}.` : String(v).replace("e", "E"));
export const list = (all) => `(${all.join(",")})`;
const reals = (v) => list(v.map(real));

const SCHEMAS = { ifc2x3: "IFC2X3", ifc4: "IFC4", ifc4x3: "IFC4X3_ADD2" };

// Units of length by how a file states them, and how many metres they are.
export const UNITS = {
  metre: [1, (t) => t.si("LENGTHUNIT", null, "METRE")],
  centimetre: [0.01, (t) => t.si("LENGTHUNIT", "CENTI", "METRE")],
  millimetre: [0.001, (t) => t.si("LENGTHUNIT", "MILLI", "METRE")],
  foot: [0.3048, (t) => t.converted("LENGTHUNIT", "FOOT", 0.3048, t.si("LENGTHUNIT", null, "METRE"))],
  inch: [0.0254, (t) => t.converted("LENGTHUNIT", "INCH", 25.4, t.si("LENGTHUNIT", "MILLI", "METRE"))],
  foot_of_inches: [0.3048, (t) => t.converted("LENGTHUNIT", "FOOT", 12, UNITS.inch[1](t))],
  yard_of_feet: [0.9144, (t) => t.converted("LENGTHUNIT", "YARD", 3, UNITS.foot_of_inches[1](t))],
};
export const ANGLES = {
  radian: [1, (t) => t.si("PLANEANGLEUNIT", null, "RADIAN")],
  degree: [Math.PI / 180, (t) => t.converted("PLANEANGLEUNIT", "DEGREE", Math.PI / 180, t.si("PLANEANGLEUNIT", null, "RADIAN"))],
  grad: [Math.PI / 200, (t) => t.converted("PLANEANGLEUNIT", "GRAD", Math.PI / 200, t.si("PLANEANGLEUNIT", null, "RADIAN"))],
};

export class StepText {
  // `unit` and `angle`: keys of UNITS and ANGLES; null for a project without units. Lengths given to this class are in
  // metres, angles in radians.
  constructor({ schema = "ifc4", unit = "metre", angle = "radian" } = {}) {
    this.schema = schema;
    this.lines = [];
    this.guids = 0;
    this.products = [];
    this.metres = unit ? UNITS[unit][0] : 1;
    this.radians = ANGLES[angle][0];
    this.context = this.add("IFCGEOMETRICREPRESENTATIONCONTEXT", "$", "'Model'", 3, "1.E-05", this.axes(), "$");
    const units = unit ? this.add("IFCUNITASSIGNMENT", list([UNITS[unit][1](this), ANGLES[angle][1](this)])) : "$";
    this.project = this.add("IFCPROJECT", this.guid(), "$", "'made'", "$", "$", "$", "$", list([this.context]), units);
    this.sitePlace = this.place();
    const site = this.add("IFCSITE", this.guid(), "$", "'site'", "$", "$", this.sitePlace, "$", "$", ".ELEMENT.", "$", "$", "$", "$", "$");
    const building = this.add("IFCBUILDING", this.guid(), "$", "'house'", "$", "$", this.place(), "$", "$", ".ELEMENT.", "$", "$", "$");
    this.storey = this.add("IFCBUILDINGSTOREY", this.guid(), "$", "'ground'", "$", "$", this.place(), "$", "$", ".ELEMENT.", "0.");
    for (const [whole, part] of [[this.project, site], [site, building], [building, this.storey]])
      this.add("IFCRELAGGREGATES", this.guid(), "$", "$", "$", whole, list([part]));
  }

  add(type, ...args) {
    this.lines.push(`#${this.lines.length + 1}=${type}(${args.join(",")});`);
    return `#${this.lines.length}`;
  }
  guid() { return `'0Made${String(++this.guids).padStart(17, "0")}'`; }
  len(metres) { return real(metres / this.metres); }
  lens(all) { return list(all.map((v) => this.len(v))); }
  turn(radians) { return real(radians / this.radians); }
  si(kind, prefix, name) { return this.add("IFCSIUNIT", "*", `.${kind}.`, prefix ? `.${prefix}.` : "$", `.${name}.`); }
  converted(kind, name, factor, of) {
    const exponents = this.add("IFCDIMENSIONALEXPONENTS", ...(kind === "LENGTHUNIT" ? [1, 0, 0, 0, 0, 0, 0] : [0, 0, 0, 0, 0, 0, 0]));
    const measure = kind === "LENGTHUNIT" ? "IFCLENGTHMEASURE" : "IFCPLANEANGLEMEASURE";
    return this.add("IFCCONVERSIONBASEDUNIT", exponents, `.${kind}.`, `'${name}'`, this.add("IFCMEASUREWITHUNIT", `${measure}(${real(factor)})`, of));
  }

  point(p) { return this.add("IFCCARTESIANPOINT", this.lens(p)); }
  direction(d) { return this.add("IFCDIRECTION", reals(d)); }
  // Directions as they are given: their lengths are the test's.
  axes(o = [0, 0, 0], z = null, x = null) {
    return this.add("IFCAXIS2PLACEMENT3D", this.point(o), z ? this.direction(z) : "$", x ? this.direction(x) : "$");
  }
  flat(o = [0, 0], x = null) { return this.add("IFCAXIS2PLACEMENT2D", this.point(o), x ? this.direction(x) : "$"); }
  place(axes = this.axes(), above = "$") { return this.add("IFCLOCALPLACEMENT", above, axes); }

  box([x, y, z], corner = [0, 0, 0]) {
    const profile = this.add("IFCRECTANGLEPROFILEDEF", ".AREA.", "$", this.flat([x / 2, y / 2]), this.len(x), this.len(y));
    return this.extruded(profile, z, this.axes(corner));
  }
  extruded(profile, depth, position = this.axes(), direction = [0, 0, 1]) {
    return this.add("IFCEXTRUDEDAREASOLID", profile, position, this.direction(direction), this.len(depth));
  }
  representation(items, name = "Body", type = "SweptSolid", context = this.context) {
    return this.add("IFCSHAPEREPRESENTATION", context, name === null ? "$" : `'${name}'`, `'${type}'`, list(items));
  }
  subcontext(name) { return this.add("IFCGEOMETRICREPRESENTATIONSUBCONTEXT", `'${name}'`, "'Model'", "*", "*", "*", "*", this.context, "$", ".MODEL_VIEW.", "$"); }
  shape(representations) { return this.add("IFCPRODUCTDEFINITIONSHAPE", "$", "$", list(representations)); }
  // A product on the storey. `more`: attributes behind those of IfcElement.
  product(type, name, shape, { place = this.place(), more = null, stands = true } = {}) {
    const usual = { IFCWALL: "$", IFCSLAB: "$", IFCBUILDINGELEMENTPROXY: "$", IFCCOLUMN: "$", IFCWINDOW: "$,$,$,$,$", IFCDOOR: "$,$,$,$,$", IFCOPENINGELEMENT: "$", IFCFURNITURE: "$" };
    const old = { IFCWALL: "", IFCCOLUMN: "", IFCWINDOW: "$,$", IFCDOOR: "$,$", IFCOPENINGELEMENT: "" };
    const own = more ?? (this.schema === "ifc2x3" ? old[type] ?? usual[type] : usual[type]) ?? "$";
    const id = this.add(type, this.guid(), "$", `'${name}'`, "$", "$", place, shape, "$", ...(own === "" ? [] : [own]));
    if (stands) this.products.push(id);
    return id;
  }
  open(host, opening) { return this.add("IFCRELVOIDSELEMENT", this.guid(), "$", "$", "$", host, opening); }

  style(transparency, colour = [0.5, 0.5, 0.5]) {
    const rendering = this.add("IFCSURFACESTYLERENDERING", this.add("IFCCOLOURRGB", "$", ...colour.map(real)), real(transparency), "$", "$", "$", "$", "$", "$", ".NOTDEFINED.");
    const style = this.add("IFCSURFACESTYLE", "$", ".BOTH.", list([rendering]));
    return this.schema === "ifc2x3" ? this.add("IFCPRESENTATIONSTYLEASSIGNMENT", list([style])) : style;
  }
  styled(item, style) { return this.add("IFCSTYLEDITEM", item, list([style]), "$"); }
  material(name, transparency, category = null) {
    const material = this.add("IFCMATERIAL", `'${name}'`, ...(this.schema === "ifc2x3" ? [] : ["$", category ? `'${category}'` : "$"]));
    if (transparency === null) return material;
    const representation = this.add("IFCSTYLEDREPRESENTATION", this.context, "'Style'", "'Material'", list([this.styled("$", this.style(transparency))]));
    this.add("IFCMATERIALDEFINITIONREPRESENTATION", "$", "$", list([representation]), material);
    return material;
  }
  made(objects, material) { return this.add("IFCRELASSOCIATESMATERIAL", this.guid(), "$", "$", "$", list(objects), material); }

  text() {
    const stands = this.products.length > 0 ? [`#${this.lines.length + 1}=IFCRELCONTAINEDINSPATIALSTRUCTURE(${this.guid()},$,$,$,${list(this.products)},${this.storey});`] : [];
    return ["ISO-10303-21;", "HEADER;", "FILE_DESCRIPTION(('ViewDefinition [ReferenceView]'),'2;1');", "FILE_NAME('made.ifc','2026-01-01T00:00:00',(''),(''),'','','');",
      `FILE_SCHEMA(('${SCHEMAS[this.schema] ?? this.schema}'));`, "ENDSEC;", "DATA;", ...this.lines, ...stands, "ENDSEC;", "END-ISO-10303-21;", ""].join("\n");
  }
}
