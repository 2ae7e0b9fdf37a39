// SPDX-License-Identifier: Apache-2.0
// Mends openings that stop just before a face of their wall and leave a thin skin over a door or window.
import { composed, cross, dot, length, minus, placed, plus, unit } from "./axes.mjs";
import { Unread } from "./curves.mjs";

const TOLD_M = 0.05, OPENED_M = 0.01, NOTHING_M = 1e-4, BEYOND_M = 0.01;
const MANY = 500;  // faces; larger bodies are skipped

export class Skins {
  constructor(step, axes, solids, metres) {
    Object.assign(this, { step, axes, solids, metres });
    this.hosts = new Map();  // opened products: the bodies of all their places, the direction through these, the ends along it
    this.shapes = new Map(); // extrusions, by all entities that they consist of
  }

  // Opens skins of up to a centimetre. Returns {opening, host, skin_m, opened} of all skins, opened or left.
  mend() {
    const { step } = this, found = [];
    for (const id of step.ids("IFCRELVOIDSELEMENT")) {
      const [, , , , host, opening] = step.args(id);
      if (!host || !opening || this.#isRecess(opening.ref)) continue;
      if (!this.hosts.has(host.ref)) this.hosts.set(host.ref, { bodies: this.#bodies(host.ref, true) });
      // Openings are many and most reach through; corners suffice to see that.
      const wall = this.hosts.get(host.ref), hole = this.#bodies(opening.ref, false);
      if (wall.bodies.length === 0 || hole.length === 0) continue;
      wall.across ??= mainNormal(wall.bodies);
      wall.ends ??= ends(wall.bodies, wall.across);
      const { across, ends: [low, high] } = wall, [from, to] = ends(hole, across);
      const gaps = [from - low, high - to].map((gap) => gap * this.metres), skin = Math.max(...gaps);
      if (skin < NOTHING_M || skin > TOLD_M || (high - low) * this.metres < 2 * skin) continue;
      const whole = skin <= OPENED_M ? hole.map((body) => this.#body(body, true)) : [];
      const opened = skin <= OPENED_M && whole.every((body) => this.#stretch(body, across, gaps));
      found.push({ opening: opening.ref, host: host.ref, skin_m: skin, opened });
    }
    return found;
  }

  #isRecess(id) {
    const args = this.step.args(id);
    return [args[4], args[8]].some((type) => typeof type === "string" && /recess|niche/i.test(type));
  }

  // Returns {points, triangles, item, place, shared}, points in the model's coordinates; [] if the bodies are not simple.
  // Extrusions have triangles only with `whole`.
  #bodies(id, whole) {
    const { step, axes } = this, args = step.args(id), shape = args[6];
    if (!shape) return [];
    const bodies = [], at = axes.local(args[5]);
    const add = (item, place, shared) => {
      const type = step.type(item);
      if (type === "IFCBOOLEANRESULT" || type === "IFCBOOLEANCLIPPINGRESULT") return add(step.args(item)[1].ref, place, true);
      if (type === "IFCMAPPEDITEM") {
        const [source, target] = step.args(item), [origin, representation] = step.args(source.ref);
        const inner = composed(composed(place, axes.operator(target.ref)), axes.placement(origin));
        return step.args(representation.ref)[3].forEach((one) => add(one.ref, inner, true));
      }
      const body = this.#body({ item, place, shared }, whole);
      if (body) bodies.push(body);
    };
    try {
      for (const representation of step.args(shape.ref)[2] ?? []) for (const item of step.args(representation.ref)[3] ?? []) add(item.ref, at, false);
    } catch (error) {
      if (!(error instanceof Unread)) throw error;
      return [];
    }
    return bodies;
  }
  #body({ item, place, shared }, whole) {
    const made = this.#shape(item, whole);
    return made && { points: made.points.map((point) => placed(place, point)), triangles: made.triangles, closed: made.closed, item, place, shared };
  }

  #extrusion(item, whole) {
    const of = JSON.stringify([whole, this.step.args(item)]);
    let shape = this.shapes.get(of);
    if (!shape) this.shapes.set(of, shape = whole ? this.solids.of(item) : { points: this.solids.corners(item) });
    return shape;
  }
  #shape(item, whole) {
    const { step } = this, type = step.type(item);
    if (type === "IFCEXTRUDEDAREASOLID") return this.#extrusion(item, whole);
    if (type === "IFCTRIANGULATEDFACESET") {
      const [list, , , indices] = step.args(item);
      return indices.length > MANY ? null : { points: step.args(list.ref)[0], triangles: indices.map((face) => face.map((i) => i - 1)) };
    }
    if (type !== "IFCFACETEDBREP") return null;
    const faces = step.args(step.args(item)[0].ref)[0], points = [], triangles = [];
    if (faces.length > MANY) return null;
    for (const face of faces)
      for (const bound of step.args(face.ref)[0]) {
        const loop = step.args(step.args(bound.ref)[0].ref)[0], first = points.length;
        for (const point of loop) points.push(this.axes.point(point));
        for (let k = 2; k < loop.length; ++k) triangles.push([first, first + k - 1, first + k]);
      }
    return { points, triangles, closed: false };
  }

  // Moves the end of an opening through the face that it stops before. Returns false if others share the body.
  #stretch(body, across, gaps) {
    if (body.shared || body.closed === false) return false;
    const along = body.points.map((point) => dot(point, across)), [from, to] = ends([body], across), end = NOTHING_M / this.metres;
    const { place } = body, inside = (v) => [place.x, place.y, place.z].map((axis) => dot(v, axis));
    const points = body.points.map((point, i) => {
      const by = gaps[1] >= NOTHING_M && along[i] > to - end ? gaps[1] : gaps[0] >= NOTHING_M && along[i] < from + end ? -gaps[0] : 0;
      const moved = by === 0 ? point : plus(point, across, (by + Math.sign(by) * BEYOND_M) / this.metres);
      return inside(minus(moved, place.o));
    });
    const { step } = this, list = step.add("IFCCARTESIANPOINTLIST3D", [points]);
    step.write(body.item, "IFCTRIANGULATEDFACESET", [list, null, true, body.triangles.map((face) => face.map((i) => ({ type: 10, value: i + 1 }))), null]);
    return true;
  }
}

// Returns the range of bodies along a direction.
function ends(bodies, direction) {
  let low = Infinity, high = -Infinity;
  for (const { points } of bodies)
    for (const point of points) {
      const along = dot(point, direction);
      low = Math.min(low, along), high = Math.max(high, along);
    }
  return [low, high];
}

// Returns the direction, up to its sign, that most of the bodies' surface faces.
function mainNormal(bodies) {
  const sums = [];
  for (const { points, triangles } of bodies)
    for (const [a, b, c] of triangles) {
      const n = cross(minus(points[b], points[a]), minus(points[c], points[a])), area = length(n), one = unit(n);
      if (!one) continue;
      const known = sums.find((sum) => Math.abs(dot(sum.one, one)) > 0.9999);
      if (known) known.area += area;
      else sums.push({ one, area });
    }
  return sums.reduce((best, sum) => (sum.area > best.area ? sum : best), { one: [0, 0, 1], area: 0 }).one;
}
