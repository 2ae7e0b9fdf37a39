// SPDX-License-Identifier: Apache-2.0
// Random valid IFC files, and the truth about them: each product's volume, box and area of glass, in metres.
import { ANGLES, list, real, StepText, UNITS } from "./step_text.mjs";

// The same numbers for the same seed everywhere.
export function random(seed) {
  let state = seed >>> 0;
  const next = () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let x = Math.imul(state ^ (state >>> 15), state | 1);
    x ^= x + Math.imul(x ^ (x >>> 7), x | 61);
    return ((x ^ (x >>> 14)) >>> 0) / 2 ** 32;
  };
  const between = (low, high) => low + (high - low) * next();
  return { next, between, whole: (low, high) => Math.floor(between(low, high + 1)), pick: (all) => all[Math.floor(next() * all.length)], chance: (share) => next() < share };
}

// Places: columns x, y, z and the origin.
const IDENTITY = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1], o: [0, 0, 0] };
const sum = (a, b, times = 1) => a.map((v, i) => v + times * b[i]);
const at = (m, p) => m.o.map((v, i) => v + m.x[i] * p[0] + m.y[i] * p[1] + m.z[i] * p[2]);
const product = (a, b) => { const turn = (v) => sum(at(a, v), a.o, -1); return { x: turn(b.x), y: turn(b.y), z: turn(b.z), o: at(a, b.o) }; };
const norm = (v) => { const l = Math.hypot(...v); return v.map((x) => x / l); };
const times = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

// An upright or a turned frame, as axis and reference direction of any length; the reference may lean towards the axis.
function frame(r, upright) {
  const angle = r.between(0, 2 * Math.PI), z = upright ? [0, 0, 1] : norm([r.between(-1, 1), r.between(-1, 1), r.between(0.2, 1)]);
  const first = norm(times(Math.abs(z[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0], z)), second = times(z, first);
  const x = sum(first.map((v) => v * Math.cos(angle)), second, Math.sin(angle));
  const stretched = (v) => { const long = 10 ** r.between(-2, 2); return v.map((c) => c * long); };
  const given = { z: stretched(z), x: stretched(sum(x, z, r.between(-0.8, 0.8))) };
  return { place: { x, y: times(z, x), z, o: [0, 0, 0] }, axes: given };
}

// A placement of three dimensions: its entity and its place.
function position(t, r, far = 3, upright = false) {
  const o = [0, 1, 2].map(() => r.between(-far, far));
  if (r.chance(0.2)) return { id: t.axes(o), place: { ...IDENTITY, o } };
  const { place, axes } = frame(r, upright);
  return { id: t.axes(o, axes.z, axes.x), place: { ...place, o } };
}

const circle = (rx, ry = rx) => Array.from({ length: 720 }, (_, i) => [rx * Math.cos(Math.PI * i / 360), ry * Math.sin(Math.PI * i / 360)]);
const sphere = (a) => Array.from({ length: 181 }, (_, k) => Math.PI * k / 180).flatMap((e) => circle(a * Math.sin(e)).filter((_, i) => i % 3 === 0).map(([x, y]) => [x, y, a * Math.cos(e)]));
const rectangle = (w, h) => [[-w / 2, -h / 2], [w / 2, -h / 2], [w / 2, h / 2], [-w / 2, h / 2]];

// Profiles: entity, area and outline.
const PROFILES = {
  rectangle: (t, r) => { const [w, h] = [r.between(0.2, 3), r.between(0.2, 3)]; return { type: "IFCRECTANGLEPROFILEDEF", sizes: [w, h], area: w * h, outline: rectangle(w, h) }; },
  hollow: (t, r) => { const [w, h] = [r.between(1, 3), r.between(1, 3)], s = r.between(0.05, 0.3); return { type: "IFCRECTANGLEHOLLOWPROFILEDEF", sizes: [w, h, s, null, null], area: w * h - (w - 2 * s) * (h - 2 * s), outline: rectangle(w, h) }; },
  circle: (t, r) => { const a = r.between(0.1, 12); return { type: "IFCCIRCLEPROFILEDEF", sizes: [a], area: Math.PI * a * a, outline: circle(a) }; },
  pipe: (t, r) => { const a = r.between(0.5, 5), s = a * r.between(0.3, 0.5); return { type: "IFCCIRCLEHOLLOWPROFILEDEF", sizes: [a, s], area: Math.PI * (a * a - (a - s) ** 2), outline: circle(a) }; },
  ellipse: (t, r) => { const [a, b] = [r.between(0.3, 4), r.between(0.3, 4)]; return { type: "IFCELLIPSEPROFILEDEF", sizes: [a, b], area: Math.PI * a * b, outline: circle(a, b) }; },
  beam: (t, r) => {
    const [w, h, web, flange] = [r.between(0.3, 1), r.between(0.3, 1), r.between(0.02, 0.1), r.between(0.02, 0.1)];
    return { type: "IFCISHAPEPROFILEDEF", sizes: [w, h, web, flange, null, ...(t.schema === "ifc2x3" ? [] : [null, null])], area: 2 * w * flange + (h - 2 * flange) * web, outline: rectangle(w, h) };
  },
  angle: (t, r) => {
    const [h, w, s] = [r.between(0.3, 1), r.between(0.3, 1), r.between(0.02, 0.1)];
    return { type: "IFCLSHAPEPROFILEDEF", sizes: [h, w, s, null, null, null, ...(t.schema === "ifc2x3" ? [null, null] : [])], area: (w + h - s) * s, outline: rectangle(w, h).filter((_, i) => i !== 2).concat([[-w / 2 + s, h / 2], [w / 2, -h / 2 + s]]) };
  },
  polygon: (t, r) => {
    const n = r.whole(3, 9), corners = Array.from({ length: n }, (_, i) => { const a = 2 * Math.PI * (i + r.between(0, 0.7)) / n, far = r.between(0.5, 3); return [far * Math.cos(a), far * Math.sin(a)]; });
    const area = Math.abs(corners.reduce((all, [x, y], i) => { const [u, v] = corners[(i + 1) % n]; return all + x * v - u * y; }, 0)) / 2;
    const closed = [...(r.chance(0.5) ? corners : [...corners].reverse())];
    closed.push(closed[0]);
    const curve = t.schema === "ifc2x3" || r.chance(0.5) ? t.add("IFCPOLYLINE", list(closed.map((p) => t.point(p))))
      : t.add("IFCINDEXEDPOLYCURVE", t.add("IFCCARTESIANPOINTLIST2D", list(closed.map((p) => t.lens(p)))), "$", ".F.");
    return { id: t.add("IFCARBITRARYCLOSEDPROFILEDEF", ".AREA.", "$", curve), area, outline: corners };
  },
  // A half disc of a trimmed circle and a chord.
  half: (t, r) => {
    const a = r.between(0.5, 8), turn = r.chance(0.5), number = (v) => `(IFCPARAMETERVALUE(${t.turn(v)}))`;
    const arc = turn ? t.add("IFCTRIMMEDCURVE", t.add("IFCCIRCLE", t.flat(), t.len(a)), number(Math.PI), number(0), ".F.", ".PARAMETER.") : t.add("IFCTRIMMEDCURVE", t.add("IFCCIRCLE", t.flat([0, 0], [0, 2]), t.len(a)), number(-Math.PI / 2), number(Math.PI / 2), ".T.", ".PARAMETER.");
    const ends = turn ? [[a, 0], [-a, 0]] : [[-a, 0], [a, 0]], segment = (curve) => t.add("IFCCOMPOSITECURVESEGMENT", ".CONTINUOUS.", ".T.", curve);
    const curve = t.add("IFCCOMPOSITECURVE", list([segment(arc), segment(t.add("IFCPOLYLINE", list(ends.map((p) => t.point(p)))))]), ".F.");
    return { id: t.add("IFCARBITRARYCLOSEDPROFILEDEF", ".AREA.", "$", curve), area: Math.PI * a * a / 2, outline: circle(a).filter(([, y]) => y >= -1e-9) };
  },
};

// {id, area, outline}, moved by a position of two dimensions.
function profile(t, r, names = Object.keys(PROFILES)) {
  const made = PROFILES[r.pick(names)](t, r);
  if (made.id) return made;
  const o = [r.between(-2, 2), r.between(-2, 2)], angle = r.between(0, 2 * Math.PI), long = 10 ** r.between(-2, 2), turned = r.chance(0.6);
  const [c, s] = turned ? [Math.cos(angle), Math.sin(angle)] : [1, 0];
  const where = t.flat(o, turned ? [c * long, s * long] : null);
  return { id: t.add(made.type, ".AREA.", "$", where, ...made.sizes.map((v) => (v === null ? "$" : t.len(v)))), area: made.area, outline: made.outline.map(([x, y]) => [o[0] + c * x - s * y, o[1] + s * x + c * y]) };
}

const BOX = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
const corners = (size, o) => Array.from({ length: 8 }, (_, k) => [0, 1, 2].map((i) => o[i] + (k >> i & 1) * size[i]));

// Items: entity, volume, points that its box is around, and by how much circles may fall short of them.
const ITEMS = {
  extruded: (t, r) => {
    const { id, area, outline } = profile(t, r), { id: where, place } = position(t, r), depth = r.between(0.2, 5), long = 10 ** r.between(-2, 2);
    const lean = r.chance(0.3) ? [r.between(-0.5, 0.5), r.between(-0.5, 0.5), r.chance(0.3) ? -1 : 1] : [0, 0, 1], d = norm(lean).map((v) => v * depth);
    const points = outline.flatMap(([x, y]) => [[x, y, 0], [x + d[0], y + d[1], d[2]]]);
    return { id: t.extruded(id, depth, where, lean.map((v) => v * long)), volume: area * Math.abs(d[2]), points: points.map((p) => at(place, p)) };
  },
  revolved: (t, r) => {
    const [w, h, far] = [r.between(0.2, 1), r.between(0.2, 2), r.between(1, 8)], angle = r.chance(0.3) ? 2 * Math.PI : r.between(0.3, 6), { id: where, place } = position(t, r);
    const square = t.add("IFCRECTANGLEPROFILEDEF", ".AREA.", "$", t.flat([far, 0]), t.len(w), t.len(h)), axis = t.add("IFCAXIS1PLACEMENT", t.point([0, 0, 0]), t.direction([0, r.between(0.1, 9), 0]));
    const points = Array.from({ length: 721 }, (_, i) => angle * i / 720).flatMap((a) => [far - w / 2, far + w / 2].flatMap((x) => [-h / 2, h / 2].map((y) => [x * Math.cos(a), y, -x * Math.sin(a)])));
    return { id: t.add("IFCREVOLVEDAREASOLID", square, where, axis, t.turn(angle)), volume: w * h * far * angle, points: points.map((p) => at(place, p)) };
  },
  primitive: (t, r) => {
    const { id: where, place } = position(t, r), [a, b, c] = [0, 1, 2].map(() => r.between(0.2, 4)), solid = (type, ...sizes) => t.add("IFCCSGSOLID", t.add(type, where, ...sizes.map((v) => t.len(v))));
    const made = r.pick([
      () => ({ id: solid("IFCBLOCK", a, b, c), volume: a * b * c, points: corners([a, b, c], [0, 0, 0]) }),
      () => ({ id: solid("IFCRECTANGULARPYRAMID", a, b, c), volume: a * b * c / 3, points: [[0, 0, 0], [a, 0, 0], [0, b, 0], [a, b, 0], [a / 2, b / 2, c]] }),
      () => ({ id: solid("IFCRIGHTCIRCULARCYLINDER", b, a), volume: Math.PI * a * a * b, points: circle(a).flatMap(([x, y]) => [[x, y, 0], [x, y, b]]) }),
      () => ({ id: solid("IFCRIGHTCIRCULARCONE", b, a), volume: Math.PI * a * a * b / 3, points: [...circle(a).map(([x, y]) => [x, y, 0]), [0, 0, b]] }),
      () => ({ id: solid("IFCSPHERE", a), volume: 4 * Math.PI * a ** 3 / 3, points: sphere(a), loose: 3 }),
    ])();
    return { ...made, points: made.points.map((p) => at(place, p)) };
  },
  faces: (t, r) => {
    const size = [0, 1, 2].map(() => r.between(0.2, 3)), o = [0, 1, 2].map(() => r.between(-3, 3)), all = corners(size, o), volume = size[0] * size[1] * size[2];
    const kind = t.schema === "ifc2x3" ? "brep" : r.pick(["brep", "triangles", "polygons"]);
    if (kind === "brep") {
      const points = all.map((p) => t.point(p)), face = (loop) => t.add("IFCFACE", list([t.add("IFCFACEOUTERBOUND", t.add("IFCPOLYLOOP", list(loop.map((k) => points[k]))), ".T.")]));
      return { id: t.add("IFCFACETEDBREP", t.add("IFCCLOSEDSHELL", list(BOX.map(face)))), volume, points: all };
    }
    // Points in any order among others that nothing uses, found through PnIndex, or directly.
    const spare = r.whole(0, 3), order = all.map((p, k) => ({ p, k })).concat(Array.from({ length: spare }, () => ({ p: [0, 1, 2].map(() => r.between(-90, 90)), k: -1 })));
    for (let i = order.length - 1; i > 0; --i) { const j = r.whole(0, i); [order[i], order[j]] = [order[j], order[i]]; }
    const where = all.map((_, k) => order.findIndex((one) => one.k === k) + 1), through = r.chance(0.6), index = (k) => (through ? k + 1 : where[k]);
    const points = t.add("IFCCARTESIANPOINTLIST3D", list(order.map(({ p }) => t.lens(p)))), pn = through ? list(where) : "$";
    const id = kind === "triangles" ? t.add("IFCTRIANGULATEDFACESET", points, "$", ".T.", list(BOX.flatMap(([a, b, c, d]) => [[a, b, c], [a, c, d]]).map((f) => list(f.map(index)))), pn)
      : t.add("IFCPOLYGONALFACESET", points, ".T.", list(BOX.map((f) => t.add("IFCINDEXEDPOLYGONALFACE", list(f.map(index))))), pn);
    return { id, volume, points: all };
  },
  cut: (t, r) => {
    const size = [0, 1, 2].map(() => r.between(1, 3)), into = [0, 1, 2].map((i) => r.between(0.2, 0.8) * size[i]), whole = size[0] * size[1] * size[2];
    const other = t.box(size.map((v, i) => v - into[i] + 1), into), common = (size[0] - into[0]) * (size[1] - into[1]) * (size[2] - into[2]);
    const operator = r.pick(["DIFFERENCE", "INTERSECTION"]), id = t.add("IFCBOOLEANRESULT", `.${operator}.`, t.box(size), other);
    return operator === "DIFFERENCE" ? { id, volume: whole - common, points: [...corners(size, [0, 0, 0]).slice(0, 7), ...[0, 1, 2].map((i) => size.map((v, k) => (k === i ? into[k] : v)))] } : { id, volume: common, points: corners(size.map((v, i) => v - into[i]), into) };
  },
  bar: (t, r) => {
    const a = r.between(0.02, 0.4), line = [[0, 0, 0], [r.between(2, 4), 0, 0], [r.between(5, 6), r.between(2, 3), r.between(0, 1)]];
    const long = line.slice(1).reduce((all, p, i) => all + Math.hypot(...sum(p, line[i], -1)), 0), ball = (p) => sphere(1.2 * a).map((q) => sum(p, q));
    // The corner and the ends reach less far than balls around them.
    return { id: t.add("IFCSWEPTDISKSOLID", t.add("IFCPOLYLINE", list(line.map((p) => t.point(p)))), t.len(a), "$", "$", "$"), volume: Math.PI * a * a * long, points: line.flatMap(ball), short: 1.2 * a };
  },
};

// One site of a seed: {text, products, told, metres}. `told`: words that a note must have.
export function randomSite(seed) {
  const r = random(seed), schema = r.pick(["ifc2x3", "ifc4", "ifc4", "ifc4x3"]);
  const t = new StepText({ schema, unit: r.pick(Object.keys(UNITS)), angle: r.pick(Object.keys(ANGLES)) }), products = new Map(), told = [];
  const glass = t.material("glass", 0.6);
  // From the site to the map.
  let map = IDENTITY, crs = "";
  if (schema !== "ifc2x3" && r.chance(0.4)) {
    const angle = r.between(0, 2 * Math.PI), east = Math.round(r.between(3e5, 7e5)), north = Math.round(r.between(5e6, 6e6)), height = Math.round(r.between(0, 500));
    const system = t.add("IFCPROJECTEDCRS", "'EPSG:25833'", "$", "$", "$", "$", "$", t.si("LENGTHUNIT", null, "METRE")), long = r.between(0.5, 2);
    t.add("IFCMAPCONVERSION", t.context, system, ...[east, north, height, Math.cos(angle) * long, Math.sin(angle) * long, t.metres].map(real));
    map = { x: [Math.cos(angle), Math.sin(angle), 0], y: [-Math.sin(angle), Math.cos(angle), 0], z: [0, 0, 1], o: [east, north, height] };
    crs = "EPSG:25833";
  }
  for (let k = r.whole(3, 8); k > 0; --k) {
    const name = `p${k}`, items = [];
    if (r.chance(0.15)) {
      products.set(name, wall(t, r, name, map));
      continue;
    }
    for (let n = r.chance(0.3) ? 2 : 1; n > 0; --n) {
      const known = Object.keys(ITEMS).filter((kind) => !(t.schema === "ifc2x3" && kind === "none"));
      let item = ITEMS[r.pick(known)](t, r);
      if (r.chance(0.25)) item = mapped(t, r, item);
      items.push(item);
    }
    const representations = [t.representation(items.map(({ id }) => id))];
    for (let n = r.whole(0, 2); n > 0; --n) {
      const other = r.pick(["Clearance", "FootPrint", "Axis", "Box", "Annotation", "CoG"]);
      const drawn = other === "Axis" || other === "Annotation" ? t.add("IFCPOLYLINE", list([t.point([0, 0]), t.point([4, 0])])) : t.box([1, 2, 3], [r.between(4, 9), 0, 0]);
      representations.splice(r.whole(0, representations.length), 0, t.representation([drawn], other, other === "Axis" ? "Curve2D" : "SweptSolid"));
    }
    let place = IDENTITY, where = null;
    for (let n = r.whole(1, 3); n > 0; --n) {
      const { id, place: next } = position(t, r, 20, r.chance(0.7));
      where = t.place(id, where ?? "$"), place = product(place, next);
    }
    const shape = t.shape(representations), proxy = t.product("IFCBUILDINGELEMENTPROXY", name, shape, { place: where });
    const points = items.flatMap((item) => item.points).map((p) => at(product(map, place), p)), share = (key) => items.reduce((all, item) => Math.max(all, item[key] ?? 0), 0);
    const glazed = r.chance(0.2) ? pane(t, r, proxy, glass) : false;
    products.set(name, { volume: items.reduce((all, item) => all + item.volume, 0), glass: glazed, loose: Math.max(1, share("loose")), short: share("short"), ...around(points) });
  }
  return { text: t.text(), products, told, crs };
}

// A wall with an opening: through it, short of a face by a skin that is opened, or a niche.
function wall(t, r, name, map) {
  const [long, thick, high] = [r.between(3, 8), r.between(0.1, 0.4), r.between(2.5, 4)], [w, h] = [r.between(0.7, 1.5), r.between(1, 2)], from = [r.between(0.5, long - 2), r.pick([0, 0.3])];
  const short = r.pick([-0.1, -0.1, r.between(0.001, 0.009), thick * 0.6]), { id, place } = position(t, r, 20, true), where = t.place(id);
  const host = t.product("IFCWALL", name, t.shape([t.representation([t.box([long, thick, high])])]), { place: where });
  const hole = t.box([w, thick - short + 0.1, h], [from[0], -0.1, from[1]]);
  t.open(host, t.product("IFCOPENINGELEMENT", `hole of ${name}`, t.shape([t.representation([hole])]), { place: where, stands: false }));
  const depth = short > 0.01 ? thick - short : thick;
  return { volume: long * thick * high - w * depth * h, glass: false, loose: 1, short: 0, ...around(corners([long, thick, high], [0, 0, 0]).map((p) => at(product(map, place), p))) };
}

function around(points) {
  const min = [Infinity, Infinity, Infinity], max = [-Infinity, -Infinity, -Infinity];
  for (const p of points) for (let i = 0; i < 3; ++i) min[i] = Math.min(min[i], p[i]), max[i] = Math.max(max[i], p[i]);
  return { min, max };
}

// All of a product is glass, by its own material, its type's, or a set of one constituent.
function pane(t, r, product, glass) {
  if (t.schema === "ifc2x3" || r.chance(0.4)) { t.made([product], glass); return true; }
  if (r.chance(0.5)) { t.made([product], t.add("IFCMATERIALCONSTITUENTSET", "'set'", "$", list([t.add("IFCMATERIALCONSTITUENT", "'Glazing'", "$", glass, "$", "$")]))); return true; }
  const type = t.add("IFCBUILDINGELEMENTPROXYTYPE", t.guid(), "$", "'type'", "$", "$", "$", "$", "$", "$", ".NOTDEFINED.");
  t.add("IFCRELDEFINESBYTYPE", t.guid(), "$", "$", "$", list([product]), type);
  t.made([type], glass);
  return true;
}

// An item by a map and an operator: turned, mirrored, scaled, with axes that are given or not.
function mapped(t, r, item) {
  const scale = r.pick([1, 1, 0.5, 2]), o = [0, 1, 2].map(() => r.between(-3, 3));
  const angle = r.between(-1, 1), x = [Math.cos(angle), Math.sin(angle), 0], y = [-Math.sin(angle), Math.cos(angle), 0], z = [0, 0, r.chance(0.3) ? -1 : 1];
  const axis = (v) => { const long = 10 ** r.between(-2, 2); return t.direction(v.map((c) => c * long)); };
  const uneven = r.chance(0.2), second = uneven ? r.pick([0.5, 2]) : scale, third = uneven ? r.pick([0.5, 2]) : scale;
  const operator = t.add(uneven ? "IFCCARTESIANTRANSFORMATIONOPERATOR3DNONUNIFORM" : "IFCCARTESIANTRANSFORMATIONOPERATOR3D", axis(x), r.chance(0.5) ? axis(sum(y, x, 0.3)) : "$", t.point(o),
    scale === 1 && !uneven ? "$" : real(scale), z[2] < 0 || r.chance(0.5) ? axis(z) : "$", ...(uneven ? [real(second), real(third)] : []));
  const place = { x: x.map((v) => v * scale), y: y.map((v) => v * second), z: z.map((v) => v * third), o };
  const map = t.add("IFCREPRESENTATIONMAP", t.axes(), t.representation([item.id]));
  return { ...item, id: t.add("IFCMAPPEDITEM", map, operator), volume: item.volume * scale * second * third, points: item.points.map((p) => at(place, p)), loose: (item.loose ?? 1) * Math.max(scale, second, third), short: (item.short ?? 0) * Math.max(scale, second, third) };
}
