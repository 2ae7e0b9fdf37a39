// SPDX-License-Identifier: Apache-2.0
// Valid IFC of kinds that web-ifc leaves to its caller or reads otherwise than the standard means.
import assert from "node:assert/strict";
import { test } from "node:test";
import { readBack } from "./read_back.mjs";
import { list, real, StepText } from "./step_text.mjs";

const near = (value, wanted, by, what = "") => assert.ok(Math.abs(value - wanted) <= by, `${what} ${value} is not ${wanted} within ${by}`);
const spans = ({ min, max }, low, high, by = 1e-4) => {
  for (let i = 0; i < 3; ++i) near(min[i], low[i], by, `from ${"xyz"[i]}`), near(max[i], high[i], by, `to ${"xyz"[i]}`);
};
const told = ({ notes }, ...words) => assert.ok(notes.some((note) => words.every((word) => note.includes(word))), `${words.join(", ")} in ${JSON.stringify(notes)}`);
// One product of an item.
const single = (options, item, more) => {
  const t = new StepText(options), made = item(t);
  t.product("IFCBUILDINGELEMENTPROXY", "thing", t.shape([t.representation([made].flat())]), more?.(t));
  return readBack(t.text());
};
const thing = (found) => { assert.deepEqual(found.notes, []); return found.products.get("thing"); };

test("only the body of a product stands on the site", () => {
  for (const name of ["Clearance", "FootPrint", "Axis", "Box", "Annotation", "Reference", "CoG", "Profile", "Lighting"]) {
    const t = new StepText();
    const other = t.add("IFCSHAPEREPRESENTATION", t.subcontext(name), name === "Reference" ? "$" : `'${name}'`, "'SweptSolid'", list([t.box([2, 2, 2], [5, 0, 0])]));
    t.product("IFCBUILDINGELEMENTPROXY", "thing", t.shape([other, t.representation([t.box([1, 1, 1])])]));
    const found = thing(readBack(t.text()));
    near(found.volume, 1, 1e-6, name);
    spans(found, [0, 0, 0], [1, 1, 1]);
  }
});

test("a body under another name is read, and a product without one is told", () => {
  for (const name of ["Body-Fallback", "Facetation", null, "Tessellation"]) {
    const t = new StepText();
    t.product("IFCBUILDINGELEMENTPROXY", "thing", t.shape([t.representation([t.box([1, 1, 1])], name)]));
    near(thing(readBack(t.text())).volume, 1, 1e-6, name);
  }
  const t = new StepText();
  t.product("IFCWALL", "thing", t.shape([t.representation([t.box([1, 1, 1])])]));
  t.product("IFCBUILDINGELEMENTPROXY", "air", t.shape([t.representation([t.box([1, 1, 1])], "Clearance")]));
  const found = readBack(t.text());
  assert.equal(found.products.has("air"), false);
  told(found, "no body", "IfcBuildingElementProxy air 0Made", "Clearance");
});

test("a body of drawings gives way to one of the model", () => {
  for (const both of [true, false]) {
    const t = new StepText(), plan = t.add("IFCGEOMETRICREPRESENTATIONSUBCONTEXT", "'Body'", "'Plan'", "*", "*", "*", "*", t.context, "$", ".PLAN_VIEW.", "$");
    const flat = t.representation([t.box([2, 2, 2])], "Body", "SweptSolid", plan), body = t.representation([t.box([1, 1, 1])], "Body", "SweptSolid", t.subcontext("Body"));
    t.product("IFCBUILDINGELEMENTPROXY", "thing", t.shape(both ? [flat, body] : [flat]));
    near(readBack(t.text()).products.get("thing").volume, both ? 1 : 8, 1e-6);
  }
});

test("a clearance is not cut out of a wall", () => {
  const t = new StepText();
  const wall = t.product("IFCWALL", "thing", t.shape([t.representation([t.box([4, 0.2, 3])])]));
  const hole = t.representation([t.box([1, 0.4, 2], [1, -0.1, 0])]), free = t.representation([t.box([4, 4, 3], [0, -2, 0])], "Clearance");
  t.open(wall, t.product("IFCOPENINGELEMENT", "hole", t.shape([hole, free]), { stands: false }));
  near(thing(readBack(t.text())).volume, 4 * 0.2 * 3 - 1 * 0.2 * 2, 1e-4);
});

test("directions have no length", () => {
  const square = (t) => t.add("IFCRECTANGLEPROFILEDEF", ".AREA.", "$", t.flat([0, 0], [0, 7]), t.len(1), t.len(2));
  for (const long of [2, 0.01, 300]) {
    spans(thing(single({ unit: "millimetre" }, (t) => t.extruded(square(t), 3, t.axes(), [0, 0, long]))), [-1, -0.5, 0], [1, 0.5, 3]);
    // Leaning: the depth is along the direction.
    spans(thing(single({}, (t) => t.extruded(square(t), 5, t.axes(), [0, 3 * long, 4 * long]))), [-1, -0.5, 0], [1, 3.5, 4]);
    const turned = thing(single({}, (t) => t.extruded(square(t), 3, t.axes([1, 2, 3], [0, 0, long], [0, long, 0])))), lying = thing(single({}, (t) => t.box([1, 2, 3]), (t) => ({ place: t.place(t.axes([0, 0, 0], [long, 0, 0], [0, long, long])) })));
    spans(turned, [0.5, 1, 3], [1.5, 3, 6]);
    near(lying.volume, 6, 1e-5);
  }
});

test("indices of face sets go through PnIndex", () => {
  const points = (t) => t.add("IFCCARTESIANPOINTLIST3D", list([[9, 9, 9], [2, 0, 0], [0, 0, 0], [0, 0, 4], [0, 3, 0]].map((p) => t.lens(p))));
  const faces = [[1, 3, 2], [1, 2, 4], [2, 3, 4], [3, 1, 4]], pn = "(3,2,5,4)";
  for (const unit of ["metre", "foot"]) {
    const triangles = thing(single({ unit }, (t) => t.add("IFCTRIANGULATEDFACESET", points(t), "$", ".T.", list(faces.map((f) => list(f))), pn)));
    near(triangles.volume, 4, 1e-4);
    spans(triangles, [0, 0, 0], [2, 3, 4]);
    const polygons = thing(single({ unit }, (t) => t.add("IFCPOLYGONALFACESET", points(t), ".T.", list(faces.map((f) => t.add("IFCINDEXEDPOLYGONALFACE", list(f)))), pn)));
    near(polygons.volume, 4, 1e-4);
  }
});

test("places on a grid", () => {
  const axis = (t, tag, a, b, same = ".T.") => t.add("IFCGRIDAXIS", `'${tag}'`, t.add("IFCPOLYLINE", list([t.point(a), t.point(b)])), same);
  const grid = (t, crossing, direction, schema) => {
    const a = axis(t, "A", [10, 0], [10, 20]), b = axis(t, "B", [16, 0], [16, 20]), one = axis(t, "1", [0, 5], [20, 5]);
    const at = t.place(t.axes([100, 0, 2]));
    t.add("IFCGRID", t.guid(), "$", "'g'", "$", "$", at, "$", list([a, b]), list([one]), "$", ...(schema === "ifc2x3" ? [] : ["$"]));
    const meet = (first, second, offsets) => t.add("IFCVIRTUALGRIDINTERSECTION", list([first, second]), list(offsets.map((v) => t.len(v))));
    const args = [meet(a, one, crossing), direction === "B" ? meet(b, one, [0, 0]) : direction ? t.direction(direction) : "$"];
    return t.add("IFCGRIDPLACEMENT", ...(schema === "ifc4x3" ? [at] : []), ...args);
  };
  const read = (crossing, direction, schema = "ifc4") => single({ schema, unit: "millimetre" }, (t) => t.box([1, 2, 3]), (t) => ({ place: grid(t, crossing, direction, schema) }));
  for (const schema of ["ifc2x3", "ifc4", "ifc4x3"]) spans(read([0, 0], "B", schema).products.get("thing"), [110, 5, 2], [111, 7, 5]);
  const unturned = read([0, 0], null);
  spans(unturned.products.get("thing"), [110, 5, 2], [111, 7, 5]);
  told(unturned, "keeps the grid's axes");
  // To the left of A is west, of 1 is north; the third distance is up.
  spans(read([2, 1, 4], "B").products.get("thing"), [108, 6 - 2 / 8, 6], [109.25, 8.1, 9], 0.4);
  spans(read([0, 0], [0, 5, 0]).products.get("thing"), [108, 5, 2], [110, 6, 5]);
});

test("transformation operators have upright axes and scales", () => {
  const mapped = (operator, options = {}) => thing(single(options, (t) => t.add("IFCMAPPEDITEM",
    t.add("IFCREPRESENTATIONMAP", t.axes(), t.representation([t.box([1, 2, 3])])), operator(t))));
  const three = (t, a, b, o, scale, c, more = []) => t.add(`IFCCARTESIANTRANSFORMATIONOPERATOR3D${more.length > 0 ? "NONUNIFORM" : ""}`, a ? t.direction(a) : "$", b ? t.direction(b) : "$", t.point(o), scale, c ? t.direction(c) : "$", ...more);
  spans(mapped((t) => three(t, [0, 2, 0], null, [0, 0, 0], "$", null)), [-2, 0, 0], [0, 1, 3]);      // turned; the second axis follows
  spans(mapped((t) => three(t, null, [0.3, 5, 0], [1, 1, 1], "2.", null)), [1, 1, 1], [3, 5, 7]);    // the second one is made upright
  spans(mapped((t) => three(t, [1, 0, 0], [0, 0, 1], [0, 0, 0], "$", [0, 1, 0])), [0, 0, 0], [1, 3, 2]);  // mirrored
  spans(mapped((t) => three(t, null, null, [0, 0, 0], "2.", null, ["$", "$"])), [0, 0, 0], [2, 4, 6]);   // other scales are the first one's
  spans(mapped((t) => three(t, null, null, [0, 0, 0], "2.", null, ["3.", "0.5"])), [0, 0, 0], [2, 6, 1.5]);
  near(mapped((t) => three(t, [1, 0, 0], [0, 0, 1], [0, 0, 0], "$", [0, 1, 0])).volume, 6, 1e-4, "mirrored faces keep their outside");
});

test("an item that a product has several times, mirrored or not, keeps its outside, and openings where they are", () => {
  const place = (t, map, mirrored, o) => t.add("IFCMAPPEDITEM", map, t.add("IFCCARTESIANTRANSFORMATIONOPERATOR3D", mirrored ? t.direction([-1, 0, 0]) : "$", "$", t.point(o), "$", "$"));
  for (const mirrored of [[true], [true, true, false], [false, true], [true, true, true], [false, false]]) {
    const found = single({ unit: "millimetre" }, (t) => {
      const map = t.add("IFCREPRESENTATIONMAP", t.axes(), t.representation([t.box([1, 2, 3])]));
      return mirrored.map((one, k) => place(t, map, one, [10 * k, 0, 0]));
    });
    near(thing(found).volume, 6 * mirrored.length, 1e-3, mirrored.join());
  }
  const t = new StepText(), box = t.box([4, 0.2, 3]), map = t.add("IFCREPRESENTATIONMAP", t.axes(), t.representation([box]));
  t.styled(box, t.style(0.5));
  const wall = t.product("IFCWALL", "thing", t.shape([t.representation([place(t, map, false, [0, 0, 0]), place(t, map, false, [0, 5, 0])], "Body", "MappedRepresentation")]));
  t.open(wall, t.product("IFCOPENINGELEMENT", "hole", t.shape([t.representation([t.box([1, 0.4, 2], [1, -0.1, 0])])]), { stands: false }));
  const found = thing(readBack(t.text()));
  near(found.volume, 2 * 2.4 - 0.4, 1e-3);
  near(found.glass, 2 * 2 * (4 * 0.2 + 4 * 3 + 0.2 * 3) - 4 + 2 * 2 * 0.2, 1e-2);
});

test("arcs are nowhere farther than 5 mm from their circle", () => {
  const circle = (t, r) => t.add("IFCCIRCLEPROFILEDEF", ".AREA.", "$", t.flat(), t.len(r));
  for (const unit of ["metre", "millimetre"])
    for (const [r, by] of [[10, 0.01], [0.3, 0.03], [0.02, 0.06], [60, 0.001]]) {
      const found = thing(single({ unit }, (t) => t.extruded(circle(t, r), 1)));
      near(found.volume / (Math.PI * r * r), 1, by, `a tank of ${r} m`);
      assert.ok(r - found.max[0] < 0.005 && r - found.max[1] < 0.0051);
    }
  // A quarter of a ring by composite, trimmed and indexed curves.
  const trimmed = (t, r, from, to, same) => t.add("IFCTRIMMEDCURVE", t.add("IFCCIRCLE", t.flat(), t.len(r)), `(IFCPARAMETERVALUE(${t.turn(from)}))`, `(IFCPARAMETERVALUE(${t.turn(to)}))`, same, ".PARAMETER.");
  const segment = (t, curve, same = ".T.") => t.add("IFCCOMPOSITECURVESEGMENT", ".CONTINUOUS.", same, curve);
  const straight = (t, a, b) => t.add("IFCPOLYLINE", list([t.point(a), t.point(b)]));
  const area = Math.PI * (20 ** 2 - 19 ** 2) / 4, closed = (t, curve) => t.extruded(t.add("IFCARBITRARYCLOSEDPROFILEDEF", ".AREA.", "$", curve), 2);
  for (const angle of ["radian", "degree", "grad"]) {
    const composite = thing(single({ angle, unit: "millimetre" }, (t) => closed(t, t.add("IFCCOMPOSITECURVE", list([segment(t, trimmed(t, 20, 0, Math.PI / 2, ".T.")),
      segment(t, straight(t, [0, 20], [0, 19])), segment(t, trimmed(t, 19, 0, Math.PI / 2, ".T."), ".F."), segment(t, straight(t, [19, 0], [20, 0]))]), ".F."))));
    near(composite.volume / (2 * area), 1, 0.005, `a bend by composite curves in ${angle}s`);
    spans(composite, [0, 0, 0], [20, 20, 2], 0.005);
  }
  const h = Math.SQRT1_2, indexed = thing(single({}, (t) => {
    const points = t.add("IFCCARTESIANPOINTLIST2D", list([[20, 0], [20 * h, 20 * h], [0, 20], [0, 19], [19 * h, 19 * h], [19, 0]].map((p) => t.lens(p))));
    return closed(t, t.add("IFCINDEXEDPOLYCURVE", points, "(IFCARCINDEX((1,2,3)),IFCLINEINDEX((3,4)),IFCARCINDEX((4,5,6)),IFCLINEINDEX((6,1)))", ".F."));
  }));
  near(indexed.volume / (2 * area), 1, 0.005);
  // Cut at points, on a circle that is turned and runs the other way.
  const cut = thing(single({}, (t) => {
    const arc = t.add("IFCTRIMMEDCURVE", t.add("IFCCIRCLE", t.flat([0, 0], [0, 1]), t.len(5)), list([t.point([-5, 0])]), list([t.point([5, 0])]), ".F.", ".CARTESIAN.");
    return closed(t, t.add("IFCCOMPOSITECURVE", list([segment(t, arc), segment(t, straight(t, [5, 0], [-5, 0]))]), ".F."));
  }));
  near(cut.volume / (Math.PI * 25), 1, 0.01);
  spans(cut, [-5, 0, 0], [5, 5, 2], 0.006);
});

test("profiles of all kinds", () => {
  const steel = (type, ...sizes) => (t) => t.add(type, ".AREA.", "$", t.flat([10, 0]), ...sizes.map((v) => (v === null ? "$" : t.len(v))));
  const fillet = (r) => (1 - Math.PI / 4) * r * r;  // of area in a corner
  const all = [
    ["IFCASYMMETRICISHAPEPROFILEDEF", [1, 1, 0.1, 0.1, null, 0.5, 0.2, null, null, null, null, null], 0.1 + 0.1 + 0.07, [9.5, -0.5], [10.5, 0.5]],
    ["IFCISHAPEPROFILEDEF", [0.4, 0.6, 0.02, 0.04, 0.03, null, null], 2 * 0.4 * 0.04 + 0.52 * 0.02 + 4 * fillet(0.03), [9.8, -0.3], [10.2, 0.3]],
    ["IFCTSHAPEPROFILEDEF", [0.6, 0.4, 0.05, 0.1, null, null, null, null, null], 0.4 * 0.1 + 0.5 * 0.05, [9.8, -0.3], [10.2, 0.3]],
    ["IFCUSHAPEPROFILEDEF", [0.6, 0.4, 0.05, 0.1, null, null, null], 0.6 * 0.05 + 2 * 0.35 * 0.1, [9.8, -0.3], [10.2, 0.3]],
    ["IFCLSHAPEPROFILEDEF", [0.6, 0.4, 0.05, null, null, null], 0.4 * 0.05 + 0.55 * 0.05, [9.8, -0.3], [10.2, 0.3]],
    ["IFCLSHAPEPROFILEDEF", [0.6, null, 0.05, 0.05, 0.02, null], 0.6 * 0.05 + 0.55 * 0.05 + fillet(0.05) - 2 * fillet(0.02), [9.7, -0.3], [10.3, 0.3]],
    ["IFCCSHAPEPROFILEDEF", [0.6, 0.4, 0.05, 0.15, null], 0.6 * 0.05 + 2 * 0.35 * 0.05 + 2 * 0.1 * 0.05, [9.8, -0.3], [10.2, 0.3]],
    ["IFCZSHAPEPROFILEDEF", [0.6, 0.4, 0.05, 0.1, null, null], 0.6 * 0.05 + 2 * 0.35 * 0.1, [10 - 0.375, -0.3], [10.375, 0.3]],
    ["IFCROUNDEDRECTANGLEPROFILEDEF", [4, 2, 0.5], 8 - 4 * fillet(0.5), [8, -1], [12, 1]],
    ["IFCRECTANGLEHOLLOWPROFILEDEF", [4, 2, 0.25, null, null], 8 - 3.5 * 1.5, [8, -1], [12, 1]],
    ["IFCCIRCLEHOLLOWPROFILEDEF", [5, 0.5], Math.PI * (25 - 4.5 ** 2), [5, -5], [15, 5]],
    ["IFCELLIPSEPROFILEDEF", [4, 2], Math.PI * 8, [6, -2], [14, 2]],
    ["IFCTRAPEZIUMPROFILEDEF", [4, 2, 2, 0.5], 6, [8, -1], [12, 1]],
  ];
  for (const unit of ["metre", "inch"])
    for (const [type, sizes, area, low, high] of all) {
      const found = thing(single({ unit }, (t) => t.extruded(steel(type, ...sizes)(t), 3)));
      near(found.volume / (3 * area), 1, 0.02, type);
      spans(found, [...low, 0], [...high, 3], 0.0051);
    }
});

test("derived, mirrored, composite and centre-line profiles", () => {
  const shifted = (t) => t.add("IFCRECTANGLEPROFILEDEF", ".AREA.", "$", t.flat([3, 0]), t.len(2), t.len(1));
  const ring = (t) => t.add("IFCCIRCLEHOLLOWPROFILEDEF", ".AREA.", "$", t.flat([3, 0]), t.len(1), t.len(0.2));
  spans(thing(single({}, (t) => t.extruded(t.add("IFCMIRROREDPROFILEDEF", ".AREA.", "$", shifted(t), "*", "$"), 1))), [-4, -0.5, 0], [-2, 0.5, 1]);
  const moved = (t, of) => t.add("IFCDERIVEDPROFILEDEF", ".AREA.", "$", of, t.add("IFCCARTESIANTRANSFORMATIONOPERATOR2D", t.direction([0, 4]), "$", t.point([1, 1]), "2."), "$");
  const derived = thing(single({ unit: "millimetre" }, (t) => t.extruded(moved(t, ring(t)), 1)));
  spans(derived, [-1, 5, 0], [3, 9, 1], 0.006);
  near(derived.volume / (Math.PI * (4 - 1.6 ** 2)), 1, 0.03);
  const both = thing(single({}, (t) => t.extruded(t.add("IFCCOMPOSITEPROFILEDEF", ".AREA.", "$", list([shifted(t), ring(t)]), "$"), 1)));
  spans(both, [2, -1, 0], [4, 1, 1], 0.006);
  const line = thing(single({}, (t) => t.extruded(t.add("IFCCENTERLINEPROFILEDEF", ".CURVE.", "$", t.add("IFCPOLYLINE", list([[0, 0], [4, 0], [4, 3]].map((p) => t.point(p)))), t.len(0.2)), 2)));
  near(line.volume, 2 * 0.2 * 7, 1e-3);
  spans(line, [0, -0.1, 0], [4.1, 3, 2]);
});

test("solids that web-ifc lacks or reads otherwise", () => {
  const at = (t) => t.axes([1, 2, 3], [0, 0, 2], [0, 3, 0]), turned = ([x, y, z]) => [1 - y, 2 + x, 3 + z];
  const solid = (type, sizes, volume, low, high, by = 0.006) => {
    for (const unit of ["metre", "foot"]) {
      const found = thing(single({ unit }, (t) => t.add("IFCCSGSOLID", t.add(type, at(t), ...sizes.map((v) => t.len(v)))))), [a, b] = [turned(low), turned(high)];
      spans(found, a.map((v, i) => Math.min(v, b[i])), a.map((v, i) => Math.max(v, b[i])), by);
      near(found.volume / volume, 1, 0.02, type);
    }
  };
  solid("IFCBLOCK", [1, 2, 3], 6, [0, 0, 0], [1, 2, 3]);
  solid("IFCRECTANGULARPYRAMID", [1, 2, 3], 2, [0, 0, 0], [1, 2, 3]);
  solid("IFCRIGHTCIRCULARCYLINDER", [3, 2], 12 * Math.PI, [-2, -2, 0], [2, 2, 3]);
  solid("IFCRIGHTCIRCULARCONE", [3, 2], 4 * Math.PI, [-2, -2, 0], [2, 2, 3]);
  solid("IFCSPHERE", [2], 32 * Math.PI / 3, [-2, -2, -2], [2, 2, 2], 0.03);
  // A quarter of a ring, a whole one, and one that turns the other way.
  const square = (t) => t.add("IFCRECTANGLEPROFILEDEF", ".AREA.", "$", t.flat([5, 1]), t.len(2), t.len(2));
  const spun = (angle, z, options) => thing(single(options, (t) => t.add("IFCREVOLVEDAREASOLID", square(t), t.axes(), t.add("IFCAXIS1PLACEMENT", t.point([0, 0, 0]), t.direction(z)), t.turn(angle))));
  for (const kind of ["radian", "degree", "grad"]) {
    const quarter = spun(Math.PI / 2, [0, 2, 0], { angle: kind });
    near(quarter.volume / (4 * 5 * Math.PI / 2), 1, 0.01);
    spans(quarter, [0, 0, -6], [6, 2, 0], 0.006);
  }
  spans(spun(Math.PI / 2, [0, -2, 0]), [0, 0, 0], [6, 2, 6], 0.006);
  near(spun(2 * Math.PI, [0, 1, 0], { unit: "millimetre" }).volume / (4 * 5 * 2 * Math.PI), 1, 0.01);
  // Tapered, and a pipe along a line with a corner.
  const taper = (t, from, to) => t.add("IFCEXTRUDEDAREASOLIDTAPERED", from, t.axes(), t.direction([0, 0, 3]), t.len(3), to);
  const rectangle = (t, x, y) => t.add("IFCRECTANGLEPROFILEDEF", ".AREA.", "$", t.flat(), t.len(x), t.len(y)), disc = (t, r) => t.add("IFCCIRCLEPROFILEDEF", ".AREA.", "$", t.flat(), t.len(r));
  near(thing(single({}, (t) => taper(t, rectangle(t, 4, 4), rectangle(t, 2, 2)))).volume, 28, 1e-3);
  near(thing(single({ unit: "millimetre" }, (t) => taper(t, disc(t, 4), disc(t, 2)))).volume / (28 * Math.PI), 1, 0.01);
  const pipe = thing(single({}, (t) => t.add("IFCSWEPTDISKSOLID", t.add("IFCPOLYLINE", list([[0, 0, 0], [4, 0, 0], [4, 0, 3]].map((p) => t.point(p)))), t.len(0.5), t.len(0.4), "$", "$")));
  near(pipe.volume / (Math.PI * (0.25 - 0.16) * 7), 1, 0.06);
  spans(pipe, [0, -0.5, -0.5], [4.5, 0.5, 3], 0.006);
  const bar = (start, end) => single({}, (t) => t.add("IFCSWEPTDISKSOLID", t.add("IFCPOLYLINE", list([[0, 0, 0], [4, 0, 0], [4, 0, 3]].map((p) => t.point(p)))), t.len(0.5), "$", start, end));
  thing(bar("0.", "2."));
  told(bar("0.", "1."), "IfcSweptDiskSolid of a part of its directrix", "IfcBuildingElementProxy thing 0Made");
});

test("solids of solids", () => {
  const two = (operator, kind = "IFCBOOLEANRESULT") => thing(single({ unit: "millimetre" }, (t) => t.add(kind, `.${operator}.`, t.box([4, 4, 4]), t.box([4, 4, 6], [2, 2, -1]))));
  near(two("INTERSECTION").volume, 2 * 2 * 4, 1e-3);
  spans(two("INTERSECTION"), [2, 2, 0], [4, 4, 4], 1e-3);
  near(two("DIFFERENCE").volume, 64 - 16, 1e-3);
  near(two("UNION").volume, 64 + 96 - 16, 1e-3);
  const clipped = thing(single({}, (t) => t.add("IFCBOOLEANCLIPPINGRESULT", ".DIFFERENCE.", t.box([4, 4, 4]), t.add("IFCHALFSPACESOLID", t.add("IFCPLANE", t.axes([0, 0, 1], [0, 0, 5], [3, 0, 0])), ".F."))));
  spans(clipped, [0, 0, 0], [4, 4, 1], 1e-3);
  const cube = (t, size, corner, wound) => {
    const p = [0, 1, 2, 3, 4, 5, 6, 7].map((k) => t.point([0, 1, 2].map((i) => corner[i] + (k >> i & 1) * size)));
    const face = (loop) => t.add("IFCFACE", list([t.add("IFCFACEOUTERBOUND", t.add("IFCPOLYLOOP", list((wound ? loop : [...loop].reverse()).map((k) => p[k]))), ".T.")]));
    return t.add("IFCCLOSEDSHELL", list([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]].map(face)));
  };
  near(thing(single({}, (t) => t.add("IFCFACETEDBREPWITHVOIDS", cube(t, 4, [0, 0, 0], true), list([cube(t, 2, [1, 1, 1], false)])))).volume, 64 - 8, 1e-3);
});

test("what is not read is told by class, name and GlobalId, and takes nothing else with it", () => {
  const rail = (t) => t.extruded(t.add("IFCOPENCROSSPROFILEDEF", ".CURVE.", "$", ".T.", "(1.)", "(0.)", "$"), 3);
  const found = single({ schema: "ifc4x3" }, (t) => [t.box([1, 1, 1]), rail(t)]);
  near(found.products.get("thing").volume, 1, 1e-6);
  told(found, "1 product is incomplete", "IfcBuildingElementProxy thing 0Made", "IfcOpenCrossProfileDef");
  const t = new StepText();
  t.product("IFCWALL", "sound", t.shape([t.representation([t.box([1, 1, 1])])]));
  t.product("IFCWALL", "bad", t.shape([t.representation([t.extruded(t.add("IFCCIRCLEPROFILEDEF", ".AREA.", "$", t.flat(), "0."), 3)])]));
  t.add("IFCFLYINGBUTTRESS", t.guid(), "$", "'new'", "$", "$", t.place(), t.shape([t.representation([t.box([1, 1, 1])])]), "$");
  const other = readBack(t.text());
  assert.equal(other.products.size, 1);
  told(other, "left out", "IfcWall bad 0Made");
  told(other, "unknown to the reader", "IFCFLYINGBUTTRESS new 0Made");
});

const window = (t) => [t.box([1, 0.1, 0.1]), t.box([1, 0.02, 0.9], [0, 0.04, 0.1])], PANE = 2 * (0.9 + 0.9 * 0.02 + 0.02);
const glazed = (make, schema = "ifc4") => {
  const t = new StepText({ schema }), [frame, pane] = window(t), shape = t.shape([t.representation([frame, pane])]);
  const product = t.product("IFCWINDOW", "thing", shape);
  make(t, { product, shape, frame, pane });
  return readBack(t.text());
};
const aspects = (t, whole, parts) => {
  for (const [name, item] of parts) t.add("IFCSHAPEASPECT", list([t.representation([item])]), `'${name}'`, "$", ".U.", whole);
};
const constituents = (t, parts) => t.add("IFCMATERIALCONSTITUENTSET", "'set'", "$", list(parts.map(([name, material]) => t.add("IFCMATERIALCONSTITUENT", `'${name}'`, "$", material, "$", "$"))));

test("glass by constituents and shape aspects, of products and types", () => {
  const byProduct = glazed((t, { product, shape, frame, pane }) => {
    t.made([product], constituents(t, [["Framing", t.material("steel", 0)], ["Glazing", t.material("glass", 0.6)]]));
    aspects(t, shape, [["Framing", frame], ["Glazing", pane]]);
  });
  near(thing(byProduct).glass, PANE, 1e-4);
  const byType = glazed((t, { product, shape, frame, pane }) => {
    const type = t.add("IFCWINDOWTYPE", t.guid(), "$", "'type'", "$", "$", "$", "$", "$", "$", ".WINDOW.", "$", "$", "$");
    t.add("IFCRELDEFINESBYTYPE", t.guid(), "$", "$", "$", list([product]), type);
    t.made([type], constituents(t, [["Glazing", t.material("glass", 0.6)], ["Framing", t.material("wood", null)]]));
    aspects(t, shape, [["glazing", pane]]);
  });
  near(thing(byType).glass, PANE, 1e-4);
});

test("glass by shape aspects of a type's map, and aspects that show nothing", () => {
  const t = new StepText({ unit: "millimetre" }), [frame, pane] = window(t), map = t.add("IFCREPRESENTATIONMAP", t.axes(), t.representation([frame, pane]));
  const windows = [0, 5].map((x, k) => {
    const item = t.add("IFCMAPPEDITEM", map, t.add("IFCCARTESIANTRANSFORMATIONOPERATOR3D", "$", "$", t.point([0, 0, 0]), "$", "$"));
    return t.product("IFCWINDOW", `w${k}`, t.shape([t.representation([item], "Body", "MappedRepresentation")]), { place: t.place(t.axes([x, 0, 0])) });
  });
  const type = t.add("IFCWINDOWTYPE", t.guid(), "$", "'type'", "$", "$", "$", list([map]), "$", "$", ".WINDOW.", "$", "$", "$");
  t.add("IFCRELDEFINESBYTYPE", t.guid(), "$", "$", "$", list(windows), type);
  t.made([type], constituents(t, [["Framing", t.material("steel", 0)], ["Glazing", t.material("glass", 0.6)]]));
  aspects(t, map, [["Framing", frame], ["Glazing", pane]]);
  const found = readBack(t.text());
  assert.deepEqual(found.notes, []);
  for (const name of ["w0", "w1"]) near(found.products.get(name).glass, PANE, 1e-3);
  // An aspect with a pane of its own, which is not in the body.
  const beside = glazed((u, { product, shape }) => {
    u.made([product], constituents(u, [["Framing", u.material("steel", 0)], ["Glazing", u.material("glass", 0.6)]]));
    aspects(u, shape, [["Glazing", u.box([1, 0.02, 0.9], [0, 0.04, 0.1])]]);
  });
  told(beside, "without saying which part is glass", "IfcWindow thing 0Made");
});

test("glass by single materials, layers, lists, categories and colour maps", () => {
  const all = PANE + 2 * (0.1 + 0.1 + 0.01);
  near(thing(glazed((t, { product }) => t.made([product], t.material("glass", 0.7)), "ifc2x3")).glass, all, 1e-4);
  const layers = (t, materials) => t.add("IFCMATERIALLAYERSET", list(materials.map((m) => t.add("IFCMATERIALLAYER", m, t.len(0.01), ".F.", "$", "$", "$", "$"))), "$", "$");
  near(thing(glazed((t, { product }) => t.made([product], layers(t, [t.material("pane", 0.7), "$", t.material("pane 2", 0.7)])))).glass, all, 1e-4);
  const panel = glazed((t, { product }) => t.made([product], layers(t, [t.material("pane", 0.7), t.material("wool", null)])));
  near(panel.products.get("thing").glass, 0, 0);
  told(panel, "glass and other materials", "IfcWindow thing 0Made");
  const listed = glazed((t, { product }) => t.made([product], t.add("IFCMATERIALLIST", list([t.material("wood", 0), t.material("glass", 0.6)]))), "ifc2x3");
  near(listed.products.get("thing").glass, 0, 0);
  told(listed, "without saying which part is glass");
  const category = glazed((t, { product }) => t.made([product], t.material("clear", null, "glass")));
  near(category.products.get("thing").glass, all, 1e-4);
  told(category, "category glass", "IfcWindow thing 0Made");
  const t = new StepText(), points = t.add("IFCCARTESIANPOINTLIST3D", list([[0, 0, 0], [1, 0, 0], [0, 0, 1]].map((p) => t.lens(p))));
  const pane = t.add("IFCTRIANGULATEDFACESET", points, "$", ".F.", "((1,2,3))", "$");
  t.product("IFCWINDOW", "thing", t.shape([t.representation([pane])]));
  t.add("IFCINDEXEDCOLOURMAP", pane, "0.3", t.add("IFCCOLOURRGBLIST", "((0.1,0.2,0.3))"), "(1)");
  near(thing(readBack(t.text())).glass, 0.5, 1e-4);
});

test("a style of an item goes before materials", () => {
  const found = glazed((t, { product, frame, pane }) => {
    t.styled(frame, t.style(0)), t.styled(pane, t.style(0.5));
    t.made([product], t.material("glass", 0.6));
  });
  near(thing(found).glass, PANE, 1e-4);
});

const house = (options, scale = 1) => {
  const t = new StepText(options);
  for (const [name, corner, size] of [["s", [0, 0, 0], [8, 0.2, 2.8]], ["n", [0, 5.8, 0], [8, 0.2, 2.8]], ["w", [0, 0.2, 0], [0.2, 5.6, 2.8]], ["e", [7.8, 0.2, 0], [0.2, 5.6, 2.8]]])
    t.product("IFCWALL", name, t.shape([t.representation([t.box(size.map((v) => v * scale), corner.map((v) => v * scale))])]));
  return t.text();
};

test("units: conversions of conversions; none is asked; one in which no person fits is doubted", () => {
  for (const unit of ["metre", "centimetre", "millimetre", "foot", "inch", "foot_of_inches", "yard_of_feet"])
    for (const schema of ["ifc2x3", "ifc4"]) spans(readBack(house({ unit, schema })).products.get("e"), [7.8, 0.2, 0], [8, 5.8, 2.8], 1e-3);
  assert.throws(() => readBack(house({ unit: null }, 1000)), /states no unit.*the setting unit.*mm for millimetres \(8.00 x 6.00 x 2.80 m\)/);
  spans(readBack(house({ unit: null }, 1000), "mm").products.get("e"), [7.8, 0.2, 0], [8, 5.8, 2.8], 1e-3);
  assert.throws(() => readBack(house({ unit: "millimetre" }, 0.001)), /doubtful: it says millimetre.*no person fits; give the setting unit: m for metres \(8.00/);
  assert.throws(() => readBack(house({ unit: "inch" }, 0.0254)), /doubtful: it says inch/);
  assert.throws(() => readBack(house({ unit: "metre" }, 1000)), /doubtful: it says metre/);
  spans(readBack(house({ unit: "millimetre" }, 0.001), "m").products.get("e"), [7.8, 0.2, 0], [8, 5.8, 2.8], 1e-3);
  assert.doesNotThrow(() => readBack(house({ unit: "metre" }, 1)));
});

test("openings that leave a skin", () => {
  const wall = (gap, { type = "IFCOPENINGELEMENT", turned = false, predefined = ".OPENING." } = {}) => {
    const t = new StepText({ unit: "millimetre" }), place = turned ? t.place(t.axes([3, 2, 0], [0, 0, 1], [0.6, 0.8, 0])) : t.place();
    const host = t.product("IFCWALL", "thing", t.shape([t.representation([t.box([4, 0.2, 3])])]), { place });
    t.open(host, t.product(type, "door", t.shape([t.representation([t.box([1, 0.2 - gap + 0.1, 2.1], [1, -0.1, 0])])]), { place, stands: false, more: predefined }));
    return readBack(t.text());
  };
  const whole = 4 * 0.2 * 3, open = whole - 0.2 * 2.1;
  for (const turned of [false, true]) {
    const through = wall(-0.1, { turned });
    near(through.products.get("thing").volume, open, 1e-3);
    assert.deepEqual(through.notes, []);
    const thin = wall(0.004, { turned });
    near(thin.products.get("thing").volume, open, 1e-3, "the skin is opened");
    told(thin, "skin", "IfcOpeningElement door 0Made", "IfcWall thing 0Made", "4.0 mm");
    const thick = wall(0.03, { turned });
    near(thick.products.get("thing").volume, whole - 0.17 * 2.1, 1e-3);
    told(thick, "leaves a skin that closes it", "30.0 mm");
  }
  assert.deepEqual(wall(0.004, { predefined: ".RECESS." }).notes, []);
  assert.deepEqual(wall(0.1).notes, [], "a niche");
});

test("an opening is cut out of its own wall alone, though walls share a shape", () => {
  const t = new StepText(), map = t.add("IFCREPRESENTATIONMAP", t.axes(), t.representation([t.box([4, 0.2, 3])]));
  const shape = () => t.shape([t.representation([t.add("IFCMAPPEDITEM", map, t.add("IFCCARTESIANTRANSFORMATIONOPERATOR3D", "$", "$", t.point([0, 0, 0]), "$", "$"))], "Body", "MappedRepresentation")]);
  const wall = t.product("IFCWALL", "open", shape());
  t.product("IFCWALL", "closed", shape(), { place: t.place(t.axes([0, 5, 0])) });
  t.open(wall, t.product("IFCOPENINGELEMENT", "door", t.shape([t.representation([t.box([1, 0.4, 2], [1, -0.1, 0])])]), { stands: false }));
  const { products } = readBack(t.text());
  near(products.get("open").volume, 2.4 - 0.4, 1e-3);
  near(products.get("closed").volume, 2.4, 1e-3);
});

test("openings leave the surface of their wall and add their reveals", () => {
  const t = new StepText(), wall = t.product("IFCWALL", "wall", t.shape([t.representation([t.box([10, 0.2, 3])])]));
  // Each reaches out of the wall, which has its middle between y = 0 and 0.2.
  const open = (size, corner) => t.open(wall, t.product("IFCOPENINGELEMENT", "opening", t.shape([t.representation([t.box(size, corner)])]), { stands: false }));
  for (let k = 0; k < 6; ++k) open([0.8, 0.4, 1.2], [0.5 + 1.2 * k, -0.1, 0.9]);
  open([1, 0.4, 2.1], [8.5, -0.1, 0]);
  const is = readBack(t.text()).products.get("wall");
  near(is.volume, 0.2 * (30 - 6 * 0.96 - 2.1), 1e-3);
  near(is.area, 2 * (30 + 2 + 0.6) - 6 * (2 * 0.96 - 4 * 0.2) - (2 * 2.1 - 5.2 * 0.2) - 0.2, 1e-3);
});

const mapped = (t, numbers, { name = "EPSG:25832", unit = "$", type = "IFCMAPCONVERSION" } = {}) =>
  t.add(type, t.context, t.add("IFCPROJECTEDCRS", `'${name}'`, "$", "$", "$", "$", "$", unit), ...numbers.map((v) => (v === null ? "$" : real(v))));

test("map conversions place the site in their coordinate system", () => {
  for (const unit of ["metre", "millimetre", "foot"]) {
    const t = new StepText({ unit });
    t.product("IFCWALL", "thing", t.shape([t.representation([t.box([4, 0.2, 3])])]));
    mapped(t, [500_000, 5_400_000, 120, 0, 1, t.metres], { unit: t.si("LENGTHUNIT", null, "METRE") });
    const found = readBack(t.text());
    assert.equal(found.crs, "EPSG:25832");
    told(found, "500000.00 E, 5400000.00 N, 120.00 m", "EPSG:25832");
    spans(found.products.get("thing"), [499_999.8, 5_400_000, 120], [500_000, 5_400_004, 123], 1e-3);
    // A quarter turn: the model's x, of 4 m, runs north. Lengths are the model's, in metres, of (x, z, −y).
    [0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 500_000, 120, -5_400_000, 1].forEach((v, i) => near(found.place[i], v, 1e-6));
  }
  const empty = new StepText();
  empty.product("IFCWALL", "thing", empty.shape([empty.representation([empty.box([4, 0.2, 3])])]));
  mapped(empty, [0, 0, 0, null, null, null]);
  const found = readBack(empty.text());
  assert.equal(found.crs, "");
  assert.equal(found.place, undefined, "the model's coordinates are the site's");
  told(found, "not applied");
  spans(found.products.get("thing"), [0, 0, 0], [4, 0.2, 3]);
  const named = new StepText();
  named.product("IFCWALL", "thing", named.shape([named.representation([named.box([4, 0.2, 3])])]));
  mapped(named, [1000, 2000, 0, null, null, null], { name: "our own" });
  told(readBack(named.text()), "our own", "give the setting crs");
});

test("a map conversion without a unit of the map counts in the model's", () => {
  for (const [unit, crs] of [["millimetre", "EPSG:25832"], ["foot", ""]]) {
    const t = new StepText({ unit });
    t.product("IFCWALL", "thing", t.shape([t.representation([t.box([4, 0.2, 3])])]));
    mapped(t, [500_000 / t.metres, 5_400_000 / t.metres, 120 / t.metres, null, null, null]);
    const found = readBack(t.text());
    assert.equal(found.crs, crs);
    told(found, "500000.00 E, 5400000.00 N, 120.00 m");
    spans(found.products.get("thing"), [500_000, 5_400_000, 120], [500_004, 5_400_000.2, 123], 1e-3);
  }
});

test("property sets of IFC 2x3 stand for a map conversion", () => {
  const t = new StepText({ schema: "ifc2x3", unit: "millimetre" });
  t.product("IFCWALL", "thing", t.shape([t.representation([t.box([4, 0.2, 3])])]));
  const set = (name, values) => t.add("IFCPROPERTYSET", t.guid(), "$", `'${name}'`, "$", list(Object.entries(values).map(([key, value]) => t.add("IFCPROPERTYSINGLEVALUE", `'${key}'`, "$", value, "$"))));
  for (const one of [set("ePSet_MapConversion", { Eastings: "IFCLENGTHMEASURE(500000.)", Northings: "IFCLENGTHMEASURE(5400000.)", OrthogonalHeight: "IFCLENGTHMEASURE(10.)", Scale: "IFCREAL(0.001)" }),
    set("ePSet_ProjectedCRS", { Name: "IFCLABEL('EPSG:31467')" })]) t.add("IFCRELDEFINESBYPROPERTIES", t.guid(), "$", "$", "$", list([t.storey]), one);
  const found = readBack(t.text());
  assert.equal(found.crs, "EPSG:31467");
  spans(found.products.get("thing"), [500_000, 5_400_000, 10], [500_004, 5_400_000.2, 13], 1e-3);
});

test("rooms stand where their site is", () => {
  const t = new StepText();
  t.product("IFCWALL", "thing", t.shape([t.representation([t.box([4, 0.2, 3])])]));
  const space = t.add("IFCSPACE", t.guid(), "$", "'101'", "$", "$", t.place(), t.shape([t.representation([t.box([4, 5, 3])]), t.representation([t.box([9, 9, 1])], "FootPrint")]), "'Office'", ".ELEMENT.", "$", "$");
  t.add("IFCRELAGGREGATES", t.guid(), "$", "$", "$", t.storey, list([space]));
  mapped(t, [1000, 2000, 10, null, null, null]);
  const [low, high] = readBack(t.text()).rooms.get("101");
  for (const [corner, wanted] of [[low, [1000, 10, -2005]], [high, [1004, 13, -2000]]]) corner.forEach((v, i) => near(v, wanted[i], 1e-3));
});

test("products of one file may share a GlobalId, which some programs do not keep unique", () => {
  const t = new StepText();
  for (const [name, x] of [["first", 0], ["second", 3]]) t.product("IFCBUILDINGELEMENTPROXY", name, t.shape([t.representation([t.box([1, 1, 1], [x, 0, 0])])]));
  const [first, second] = [...t.text().matchAll(/IFCBUILDINGELEMENTPROXY\('([^']*)'/g)].map(([, guid]) => guid);
  const found = readBack(t.text().replace(second, first));
  spans(found.products.get("first"), [0, 0, 0], [1, 1, 1]);
  spans(found.products.get("second"), [3, 0, 0], [4, 1, 1]);
  assert.deepEqual(found.notes, []);
});

test("a model without any surface says what it has instead", () => {
  const t = new StepText(), plane = t.add("IFCPLANE", t.axes());
  t.product("IFCBUILDINGELEMENTPROXY", "thing", t.shape([t.representation([t.add("IFCRECTANGULARTRIMMEDSURFACE", plane, "0.", "0.", "1.", "1.", ".T.", ".T.")])]));
  assert.throws(() => readBack(t.text()), /no product with a shape .*IfcBuildingElementProxy thing .*IfcRectangularTrimmedSurface is not read/);
});

test("several files are one site", () => {
  const part = (unit, name, corner, conversion) => {
    const t = new StepText({ unit });
    t.guids = corner[0] * 1000;  // of another program
    t.product("IFCWALL", name, t.shape([t.representation([t.box([4, 0.2, 3], corner)])]));
    if (conversion) mapped(t, [...conversion, 0, null, null, t.metres], { unit: t.si("LENGTHUNIT", null, "METRE") });
    return t.text();
  };
  const plain = readBack([part("metre", "one", [0, 0, 0]), part("millimetre", "two", [10, 0, 0])]);
  spans(plain.products.get("one"), [0, 0, 0], [4, 0.2, 3], 1e-3);
  spans(plain.products.get("two"), [10, 0, 0], [14, 0.2, 3], 1e-3);
  const placed = readBack([part("metre", "one", [0, 0, 0], [500_000, 5_400_000]), part("millimetre", "two", [10, 0, 0], [500_100, 5_400_000])]);
  spans(placed.products.get("two"), [500_110, 5_400_000, 0], [500_114, 5_400_000.2, 3], 1e-3);
  const half = readBack([part("metre", "one", [0, 0, 0], [500_000, 5_400_000]), part("millimetre", "two", [10, 0, 0])]);
  spans(half.products.get("two"), [500_010, 5_400_000, 0], [500_014, 5_400_000.2, 3], 1e-3);
  told(half, "b.ifc: without a map conversion");
  const twice = readBack([part("metre", "one", [0, 0, 0]), part("metre", "one", [0, 0, 0])]);
  told(twice, "b.ifc", "in another file of the site, too", "IfcWall one 0Made");
});
