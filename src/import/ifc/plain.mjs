// SPDX-License-Identifier: Apache-2.0
// Rewrites entities of an open model that web-ifc does not read, or not as the standard means, as entities of the same
// shape that it reads correctly. Must run before web-ifc makes any geometry. Reports what cannot be rewritten.
import { Axes, unit } from "./axes.mjs";
import { Bodies } from "./bodies.mjs";
import { Curves, Unread } from "./curves.mjs";
import { gridPlace } from "./grids.mjs";
import { Profiles } from "./profiles.mjs";
import { Solids } from "./solids.mjs";
import { enumeration, integer } from "./step.mjs";

const LINES = /^IFC(POLYLINE|.*CURVE|.*CURVEWITHKNOTS|CIRCLE|ELLIPSE|LINE|CLOTHOID|EDGE|.*POINT|TEXTLITERAL.*|ANNOTATIONFILLAREA|GEOMETRICCURVESET|PATH|VERTEX.*|.*DIMENSION.*|.*HATCHING)$/;
const AS_IT_IS = ["IFCPLANE", "IFCCYLINDRICALSURFACE", "IFCBSPLINESURFACEWITHKNOTS", "IFCRATIONALBSPLINESURFACEWITHKNOTS", "IFCSURFACEOFREVOLUTION", "IFCSURFACEOFLINEAREXTRUSION"];

// Largest error of a unit circle with eleven corners, which web-ifc makes of twelve.
const AS_ELEVEN = 1 - Math.cos(Math.PI / 11);

export class Plain {
  // `chord`: largest chord error of an arc, in the model's unit; `radians`: in its unit of angles.
  constructor(step, chord, radians) {
    this.step = step;
    this.axes = new Axes(step);
    this.curves = new Curves(step, this.axes, chord, radians);
    this.profiles = new Profiles(step, this.axes, this.curves);
    this.solids = new Solids(step, this.axes, this.curves, this.profiles);
    this.bodies = new Bodies(step);
    this.items = new Map();     // result for each item
    this.shapes = new Map();    // result for each product's shape
    this.cut = new Set();       // solids from which web-ifc cuts others
    this.solid = new Set();     // other closed solids
    this.copies = new Map();    // copied items, with their originals
    this.done = new Set();      // placements, profiles and operators
    this.ones = new Set();      // directions of length 1
    this.curved = step.ids("IFCADVANCEDFACE", "IFCFACESURFACE").length > 0;
    this.gridAxes = 0;          // products on a grid without a direction
    this.local = step.ids("IFCGRIDPLACEMENT", "IFCLINEARPLACEMENT").length === 0;  // all placements are local
  }

  // Rewrites a product. Returns {parts, problems, left}: lists of the geometries that web-ifc may give an item, what is
  // not read, and the names of representations that are no body.
  product(id, opened) {
    const [, , , , , placement, shape] = this.step.args(id);
    const problems = [];
    if (placement && !this.local) problems.push(...this.#placement(placement.ref));
    if (!shape) return { parts: [], problems, left: [] };
    if (!this.shapes.has(shape.ref)) this.shapes.set(shape.ref, this.#shape(shape.ref));
    const { parts, problems: more, left } = this.shapes.get(shape.ref);
    if (opened && new Set(parts.map(([one]) => one)).size < parts.length) parts.push(...this.#apart(this.step.args(shape.ref)[2]));
    return { parts, problems: [...problems, ...more], left };
  }

  // web-ifc cuts openings out of each place of a repeated item, and shows all cuts at each place. Every place but the
  // first therefore gets its own copy. Returns the parts of the copies.
  #apart(representations) {
    const { step } = this, seen = new Set(), parts = [];
    const copy = (id) => { const to = step.api.GetMaxExpressID(step.model) + 1; step.copy(id, to); return { ref: to }; };
    for (const { ref } of representations)
      for (const mapped of step.args(ref)[3] ?? []) {
        if (step.type(mapped.ref) !== "IFCMAPPEDITEM") continue;
        const [source] = step.args(mapped.ref);
        if (!seen.has(source.ref)) { seen.add(source.ref); continue; }
        const map = copy(source.ref), [, of] = step.args(source.ref), representation = copy(of.ref);
        const items = step.args(of.ref)[3].map((item) => { const own = copy(item.ref); this.copies.set(own.ref, item.ref); return own; });
        step.change(representation.ref, { 3: items });
        step.change(map.ref, { 1: representation });
        step.change(mapped.ref, { 0: map });
        parts.push(...items.map((item) => [item.ref]));
      }
    return parts;
  }

  // Gives copied items the styles of their originals.
  styleCopies() {
    if (this.copies.size === 0) return;
    const { step } = this, styles = new Map();
    for (const id of step.ids("IFCSTYLEDITEM")) { const [item, list] = step.args(id); if (item) styles.set(item.ref, list); }
    for (const [own, item] of this.copies) if (styles.has(item)) step.add("IFCSTYLEDITEM", [{ ref: own }, styles.get(item), null]);
  }

  #shape(id) {
    const all = this.step.args(id)[2] ?? [], { body, left } = this.bodies.of(all), made = { parts: [], problems: [], left };
    if (body.length < all.length) this.step.change(id, { 2: body });
    for (const representation of body) this.#representation(representation.ref, made);
    return made;
  }

  // Adds the parts and problems of a representation. Removes unread items, as web-ifc would drop others with them.
  #representation(id, { parts, problems }) {
    const items = this.step.args(id)[3] ?? [], read = [];
    for (const item of items) {
      const made = this.#item(item.ref);
      parts.push(...made.parts), problems.push(...made.problems);
      if (!made.lost) read.push(item);
    }
    if (read.length < items.length) this.step.change(id, { 3: read });
  }

  // Returns {parts, problems, lost}. A lost item must not reach web-ifc.
  #item(id) {
    const known = this.items.get(id);
    if (known) return known;
    const made = { parts: [], problems: [], lost: false }, type = this.step.type(id);
    this.items.set(id, made);
    try {
      Object.assign(made, this.#read(id, type));
      if (/SOLID|IFCBLOCK|IFCSPHERE|IFCRIGHT|IFCRECTANGULARPYRAMID|BREP/.test(type)) this.solid.add(id);
    } catch (error) {
      if (!(error instanceof Unread) && !(error instanceof TypeError)) throw error;
      Object.assign(made, { parts: [], problems: [`${shown(this.step, error instanceof Unread ? error.message : this.step.type(id))} is not read`], lost: true });
    }
    return made;
  }

  #read(id, type) {
    const { step } = this, args = step.args(id), whole = { parts: [[id]], problems: [], lost: false };
    switch (type) {
      case "IFCMAPPEDITEM": {
        this.#operator(args[1].ref);
        const [, representation] = step.args(args[0].ref), made = { parts: [], problems: [], lost: false };
        this.#representation(representation.ref, made);
        return made;
      }
      case "IFCBOOLEANRESULT": case "IFCBOOLEANCLIPPINGRESULT": return this.#boolean(id, args);
      case "IFCCSGSOLID": {
        const root = this.#item(args[0].ref);
        if (root.lost) throw new Unread(`a part of IFCCSGSOLID (${root.problems[0]})`);
        step.copy(args[0].ref, id);
        return { ...whole, problems: root.problems };
      }
      case "IFCHALFSPACESOLID": case "IFCBOXEDHALFSPACE":
        if (step.type(args[0].ref) !== "IFCPLANE") throw new Unread(`${type} on ${step.type(args[0].ref)}`);
        if (type === "IFCBOXEDHALFSPACE") step.write(id, "IFCHALFSPACESOLID", [args[0], enumeration(args[1] ? "T" : "F")]);
        return whole;
      case "IFCPOLYGONALBOUNDEDHALFSPACE":
        if (step.type(args[0].ref) !== "IFCPLANE") throw new Unread(`${type} on ${step.type(args[0].ref)}`);
        if (!this.#straight(args[3].ref)) step.change(id, { 3: this.#line(this.curves.points(args[3]).map((p) => p.slice(0, 2))) });
        return whole;
      case "IFCEXTRUDEDAREASOLID": {
        this.#profile(args[0].ref);
        if (this.ones.has(args[2].ref)) return whole;
        const direction = this.axes.point(args[2]), one = unit(direction);
        if (!one) throw new Unread("IFCEXTRUDEDAREASOLID along no direction");
        if (one.some((v, i) => Math.abs(v - direction[i]) > 1e-12)) step.change(id, { 2: step.add("IFCDIRECTION", [one]) });
        else this.ones.add(args[2].ref);
        return whole;
      }
      case "IFCEXTRUDEDAREASOLIDTAPERED": case "IFCREVOLVEDAREASOLID": case "IFCSWEPTDISKSOLID": case "IFCSWEPTDISKSOLIDPOLYGONAL": case "IFCBLOCK": case "IFCSPHERE":
      case "IFCRIGHTCIRCULARCYLINDER": case "IFCRIGHTCIRCULARCONE": case "IFCRECTANGULARPYRAMID": {
        const { points, triangles, told } = this.solids.of(id);
        this.#faces(id, points, triangles);
        return { ...whole, problems: told ? [shown(step, told)] : [] };
      }
      case "IFCTRIANGULATEDFACESET": case "IFCTRIANGULATEDIRREGULARNETWORK": this.#indexed(id, args, 4); return whole;
      case "IFCPOLYGONALFACESET": this.#indexed(id, args, 3); return whole;
      case "IFCFACETEDBREP": case "IFCFACETEDBREPWITHVOIDS": return whole;
      case "IFCADVANCEDBREP": case "IFCADVANCEDBREPWITHVOIDS": return { ...whole, problems: this.#surfaces([args[0], ...(args[1] ?? [])]) };
      case "IFCSHELLBASEDSURFACEMODEL": case "IFCFACEBASEDSURFACEMODEL":
        return { parts: args[0].map((shell) => [id, shell.ref]), problems: this.#surfaces(args[0]), lost: false };
      case "IFCFACESURFACE": return whole;
      case "IFCGEOMETRICSET": {
        const made = args[0].map((item) => this.#item(item.ref)), read = args[0].filter((_, i) => !made[i].lost);
        if (read.length < args[0].length) step.change(id, { 0: read });
        return { parts: made.flatMap(({ parts }) => parts), problems: made.flatMap(({ problems }) => problems), lost: read.length === 0 };
      }
      case "IFCSURFACECURVESWEPTAREASOLID": case "IFCFIXEDREFERENCESWEPTAREASOLID":
        this.#profile(args[0].ref);
        return { ...whole, problems: [`${shown(this.step, type)} is read roughly`] };
      case "IFCSECTIONEDSOLIDHORIZONTAL": case "IFCSECTIONEDSURFACE":
        return { ...whole, problems: [`${shown(this.step, type)} is read as surfaces without ends`] };
      case "IFCBOUNDINGBOX": return { parts: [], problems: [], lost: true };
      default:
        if (LINES.test(type)) return { parts: [], problems: [], lost: true };  // no surface
        throw new Unread(type || "an entity that the reader lacks");
    }
  }

  #boolean(id, [, first, second]) {
    const { step } = this, a = this.#item(first.ref), b = this.#item(second.ref);
    if (a.lost) throw new Unread(`the first operand of ${step.type(id)} (${a.problems[0] ?? "without a surface"})`);
    const problems = [...a.problems, ...b.problems];
    if (b.lost) {
      // Half of a solid is better than none.
      step.copy(first.ref, id);
      return { parts: [[id]], problems: [...problems, `${shown(this.step, step.type(id))} is read without its second operand`] };
    }
    if (!this.#isOpen(first.ref)) this.cut.add(id);
    return { parts: [[id]], problems, lost: false };
  }
  #isOpen(id) {
    return /SURFACEMODEL|FACESET|GEOMETRICSET/.test(this.step.type(id)) && !this.solid.has(id);
  }

  #faces(id, points, triangles) {
    const list = this.step.add("IFCCARTESIANPOINTLIST3D", [points]);
    this.step.write(id, "IFCTRIANGULATEDFACESET", [list, null, enumeration("T"), triangles.map((triangle) => triangle.map((i) => integer(i + 1))), null]);
  }

  // Indices of a face set may refer to a second list of indices.
  #indexed(id, args, place) {
    const through = args[place];
    if (!Array.isArray(through)) return;
    if (Array.isArray(through[0])) return this.step.change(id, { [place]: null });  // of normals, in the first edition of IFC 4
    const [points] = this.step.args(args[0].ref);
    if (through.some((i) => !points[i - 1])) throw new Unread(`${this.step.type(id)} with an index beyond its points`);
    this.step.change(id, { 0: this.step.add("IFCCARTESIANPOINTLIST3D", [through.map((i) => points[i - 1])]), [place]: null });
  }

  #straight(id) {
    const type = this.step.type(id);
    if (type === "IFCPOLYLINE") return true;
    const segments = type === "IFCINDEXEDPOLYCURVE" ? this.step.args(id)[1] : [{}];
    return !segments || segments.every(({ typed }) => typed === this.step.ifc.IFCLINEINDEX);
  }
  #line(points) {
    return this.step.add("IFCINDEXEDPOLYCURVE", [this.step.add("IFCCARTESIANPOINTLIST2D", [points]), null, null]);
  }

  #profile(id) {
    if (this.done.has(id)) return;
    const { step } = this, type = step.type(id);
    if (!this.#isPlain(id, type)) {
      const args = step.args(id);
      const ring = (points) => this.#line([...points, points[0]]);
      const area = enumeration(args[0]), one = ({ outer, holes }) =>
        holes.length > 0 ? ["IFCARBITRARYPROFILEDEFWITHVOIDS", [area, null, ring(outer), holes.map(ring)]] : ["IFCARBITRARYCLOSEDPROFILEDEF", [area, null, ring(outer)]];
      const regions = this.profiles.regions({ ref: id });
      step.write(id, ...(regions.length === 1 ? one(regions[0]) : ["IFCCOMPOSITEPROFILEDEF", [area, null, regions.map((region) => step.add(...one(region))), null]]));
    }
    this.done.add(id);
  }

  #isPlain(profile, type) {
    if (type === "IFCRECTANGLEPROFILEDEF") return true;
    const args = this.step.args(profile);
    if (type === "IFCCIRCLEPROFILEDEF") return args[3] > 0 && args[3] < this.curves.chord / AS_ELEVEN;
    return type.startsWith("IFCARBITRARY") && this.#straight(args[2].ref) && (args[3] ?? []).every((hole) => this.#straight(hole.ref));
  }

  #operator(id) {
    if (this.done.has(id)) return;
    this.done.add(id);
    const { step } = this, args = step.args(id), { x, y, z } = this.axes.operator(id), places = [0, 1, 4], usual = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    const type = step.type(id), three = type.endsWith("3DNONUNIFORM"), read = places.map((place, i) => this.axes.direction(args[place]) ?? usual[i]);
    const scales = [args[3] ?? 1, three ? args[5] ?? 1 : args[3] ?? 1, three ? args[6] ?? 1 : args[3] ?? 1];
    const meant = [x, y, z];
    if (!type.includes("3D") || meant.every((axis, i) => axis.every((v, k) => Math.abs(v - read[i][k] * scales[i]) < 1e-9))) return;
    const lengths = meant.map((axis) => Math.hypot(...axis)), direction = (i) => step.add("IFCDIRECTION", [unit(meant[i])]);
    step.change(id, { 0: direction(0), 1: direction(1), 3: lengths[0], 4: direction(2), ...(three ? { 5: lengths[1], 6: lengths[2] } : {}) });
  }

  // Turns placements on a grid into local ones. Returns problems.
  #placement(id) {
    const problems = [], { step } = this;
    for (let at = id; at && !this.done.has(at);) {
      this.done.add(at);
      const type = step.type(at), args = step.args(at);
      if (type === "IFCGRIDPLACEMENT") {
        try {
          const { parent, place, unturned } = gridPlace(step, this.axes, this.curves, args);
          const point = step.add("IFCCARTESIANPOINT", [place.o]), axis = (v) => step.add("IFCDIRECTION", [v]);
          step.write(at, "IFCLOCALPLACEMENT", [parent, step.add("IFCAXIS2PLACEMENT3D", [point, axis(place.z), axis(place.x)])]);
          if (unturned) ++this.gridAxes;
          at = parent?.ref;
          continue;
        } catch (error) {
          if (!(error instanceof Unread)) throw error;
          problems.push(`its place on a grid is not read (${shown(this.step, error.message)})`);
          step.write(at, "IFCLOCALPLACEMENT", [null, this.#origin()]);
        }
        return problems;
      }
      if (type === "IFCLINEARPLACEMENT" && args[2]) step.write(at, "IFCLOCALPLACEMENT", [args[0], args[2]]);
      else if (type === "IFCLINEARPLACEMENT") problems.push("its place along an alignment is read roughly");
      at = args[0]?.ref;
    }
    return problems;
  }
  #origin() {
    return this.step.add("IFCAXIS2PLACEMENT3D", [this.step.add("IFCCARTESIANPOINT", [[0, 0, 0]]), null, null]);
  }

  // Returns the classes of curved surfaces, of faces in these shells, that web-ifc flattens.
  #surfaces(shells) {
    const { step } = this, flat = new Set();
    if (!this.curved) return [];
    for (const shell of shells)
      for (const face of step.args(shell.ref)[0] ?? [])
        if (step.type(face.ref) === "IFCADVANCEDFACE" || step.type(face.ref) === "IFCFACESURFACE") {
          const surface = step.type(step.args(face.ref)[1]?.ref ?? 0);
          if (!AS_IT_IS.includes(surface)) flat.add(surface);
        }
    return [...flat].map((surface) => `${shown(this.step, surface)} is read as flat`);
  }
}

// Writes classes in a text as people do: IfcSweptDiskSolid.
export const shown = (step, text) => text.replace(/\bIFC[A-Z0-9]+/g, (name) => (step.ifc[name] && step.api.GetNameFromTypeCode(step.ifc[name])) || name);
