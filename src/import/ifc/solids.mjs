// SPDX-License-Identifier: Apache-2.0
// Triangulates solids, seen from outside, that web-ifc does not read, or reads wrongly.
import { cross, dot, length, minus, placed, plus, unit } from "./axes.mjs";
import { Unread } from "./curves.mjs";
import { triangulated } from "./triangulate.mjs";

// Collects points and triangles.
class Faces {
  constructor() { this.points = []; this.triangles = []; }
  add(point) { return this.points.push(point) - 1; }
  ring(points) { return points.map((point) => this.add(point)); }
  face(a, b, c) { if (a !== b && b !== c && c !== a) this.triangles.push([a, b, c]); }
  // Adds the strip between two rings, b ahead of a; a ring runs anticlockwise seen from ahead.
  strip(a, b, closed = true) {
    for (let i = 0; i < a.length - (closed ? 0 : 1); ++i) {
      const j = (i + 1) % a.length;
      this.face(a[i], a[j], b[j]), this.face(a[i], b[j], b[i]);
    }
  }
  fan(tip, ring) { ring.forEach((point, i) => this.face(tip, point, ring[(i + 1) % ring.length])); }
}

const area = (ring) => ring.reduce((sum, [x, y], i) => { const [u, v] = ring[(i + 1) % ring.length]; return sum + x * v - u * y; }, 0) / 2;
const turned = (ring, sign) => (area(ring) * sign < 0 ? [...ring].reverse() : ring);

export class Solids {
  constructor(step, axes, curves, profiles) {
    Object.assign(this, { step, axes, curves, profiles });
  }

  // Returns {points, triangles, told}, in the item's coordinates; `told`, if any, is a doubt to report. Throws Unread.
  of(id) {
    const { step, axes } = this, type = step.type(id), args = step.args(id), faces = new Faces();
    switch (type) {
      case "IFCBLOCK": {
        const [place, x, y, z] = args;
        this.#prism(faces, [{ outer: [[0, 0], [x, 0], [x, y], [0, y]], holes: [] }], axes.placement(place), z);
        break;
      }
      case "IFCRECTANGULARPYRAMID": {
        const [place, x, y, h] = args, at = axes.placement(place);
        const base = faces.ring([[0, 0], [x, 0], [x, y], [0, y]].map((p) => placed(at, p)));
        faces.face(base[0], base[2], base[1]), faces.face(base[0], base[3], base[2]);
        faces.fan(faces.add(placed(at, [x / 2, y / 2, h])), base);
        break;
      }
      case "IFCRIGHTCIRCULARCYLINDER": {
        const [place, h, r] = args;
        this.#prism(faces, [{ outer: this.#circle(r), holes: [] }], axes.placement(place), h);
        break;
      }
      case "IFCRIGHTCIRCULARCONE": {
        const [place, h, r] = args, at = axes.placement(place), base = faces.ring(this.#circle(r).map((p) => placed(at, p)));
        faces.fan(faces.add(placed(at, [0, 0, h])), base);
        faces.fan(faces.add(at.o), [...base].reverse());
        break;
      }
      case "IFCSPHERE": this.#sphere(faces, axes.placement(args[0]), args[1]); break;
      case "IFCEXTRUDEDAREASOLID": this.#tapered(faces, [...args, args[0]]); break;
      case "IFCREVOLVEDAREASOLID": this.#revolved(faces, args); break;
      case "IFCEXTRUDEDAREASOLIDTAPERED": this.#tapered(faces, args); break;
      case "IFCSWEPTDISKSOLID": case "IFCSWEPTDISKSOLIDPOLYGONAL": this.#disk(faces, args); break;
      default: throw new Unread(type);
    }
    return faces;
  }

  // Returns only the corners of an IfcExtrudedAreaSolid.
  corners(id) {
    const args = this.step.args(id), { from, low, high } = this.#ends([...args, args[0]]), flat = from.flatMap(({ outer, holes }) => [outer, ...holes].flat());
    return [...flat.map(low), ...flat.map(high)];
  }

  #circle(r) {
    return this.curves.arc({ o: [0, 0, 0], x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] }, r, r, 0, 2 * Math.PI).slice(0, -1).map((p) => p.slice(0, 2));
  }

  #cap(faces, region, low, high) {
    const { points, triangles } = triangulated(region);
    const all = [low, high].map((place) => points.map((p) => faces.add(place(p))));
    for (const [a, b, c] of triangles) faces.face(all[0][a], all[0][c], all[0][b]), faces.face(all[1][a], all[1][b], all[1][c]);
  }

  #prism(faces, regions, at, h) {
    for (const region of regions) {
      const low = (p) => placed(at, p), high = (p) => placed(at, [...p, h]);
      faces.strip(faces.ring(turned(region.outer, 1).map(low)), faces.ring(turned(region.outer, 1).map(high)));
      this.#cap(faces, region, low, high);
    }
  }

  #sphere(faces, at, r) {
    const around = this.curves.chords(r, 2 * Math.PI), up = Math.ceil(around / 2), circle = Array.from({ length: around }, (_, i) => 2 * Math.PI * i / around);
    const rings = Array.from({ length: up - 1 }, (_, k) => {
      const t = -Math.PI / 2 + Math.PI * (k + 1) / up;
      return faces.ring(circle.map((a) => placed(at, [r * Math.cos(t) * Math.cos(a), r * Math.cos(t) * Math.sin(a), r * Math.sin(t)])));
    });
    for (let k = 0; k + 1 < rings.length; ++k) faces.strip(rings[k], rings[k + 1]);
    faces.fan(faces.add(placed(at, [0, 0, r])), rings.at(-1));
    faces.fan(faces.add(placed(at, [0, 0, -r])), [...rings[0]].reverse());
  }

  #revolved(faces, [profile, position, axis, angle]) {
    const at = this.axes.placement(position), { o, z } = this.axes.placement(axis), turn = Math.min(angle * this.curves.radians, 2 * Math.PI);
    if (!(Math.abs(z[2]) < 1e-9 && Math.abs(o[2]) < 1e-9)) throw new Unread("IFCREVOLVEDAREASOLID around an axis out of its plane");
    const right = [z[1], -z[0], 0], whole = turn > 2 * Math.PI - 1e-6;
    for (const region of this.profiles.regions(profile)) {
      const rings = [region.outer, ...region.holes], far = rings[0].map((p) => dot(minus([...p, 0], o), right));
      if (Math.min(...far) < -1e-6 * (1 + Math.max(...far)) && Math.max(...far) > 1e-6) throw new Unread("IFCREVOLVEDAREASOLID whose axis crosses its profile");
      const side = Math.max(...far) > 1e-9 ? 1 : -1;  // side of the axis
      const n = this.curves.chords(Math.max(...far.map(Math.abs)), turn);
      const spun = (p, t) => {  // around the axis, anticlockwise seen against it
        const d = minus([...p, 0], o), along = dot(d, z), out = minus(d, z.map((v) => v * along)), across = cross(z, out);
        return placed(at, plus(o, plus(plus(z.map((v) => v * along), out, Math.cos(t)), across, Math.sin(t))));
      };
      rings.forEach((ring, k) => {
        // The ring runs anticlockwise seen from where the profile moves to.
        const points = turned(ring, (k === 0 ? 1 : -1) * -side);
        let before = faces.ring(points.map((p) => spun(p, 0)));
        const first = before;
        for (let i = 1; i <= n; ++i) {
          const next = whole && i === n ? first : faces.ring(points.map((p) => spun(p, turn * i / n)));
          faces.strip(before, next);
          before = next;
        }
      });
      if (whole) continue;
      const ends = [(p) => spun(p, 0), (p) => spun(p, turn)];
      this.#cap(faces, region, ...(side < 0 ? ends : ends.reverse()));
    }
  }

  // Returns the profiles of both ends, functions that place their points, and whether the second end is below.
  #ends([profile, position, direction, depth, end]) {
    const at = this.axes.placement(position), d = this.axes.direction(direction);
    // Circles of both ends get as many chords as the larger one.
    const radius = (one) => { const [, , , size] = this.step.args(one.ref); return typeof size === "number" ? size : 0; };
    this.curves.like = Math.max(0, radius(profile), radius(end));
    let from, to;
    try {
      from = this.profiles.regions(profile);
      to = end === profile ? from : this.profiles.regions(end);
    } finally {
      this.curves.like = 0;
    }
    const alike = from === to || from.length === to.length && from.every((one, i) => one.outer.length === to[i].outer.length && one.holes.length === to[i].holes.length && one.holes.every((hole, k) => hole.length === to[i].holes[k].length));
    if (!alike) throw new Unread("IFCEXTRUDEDAREASOLIDTAPERED between profiles of other corners");
    const low = (p) => placed(at, p), high = (p) => placed(at, plus([...p, 0], d, depth)), down = d[2] < 0;
    return { from, to, low, high, down };
  }

  #tapered(faces, args) {
    const { from, to, low, high, down } = this.#ends(args);
    from.forEach((region, i) => {
      [region.outer, ...region.holes].forEach((ring, k) => {
        const other = k === 0 ? to[i].outer : to[i].holes[k - 1], flip = (area(ring) < 0) !== (k > 0) !== down;
        const [a, b] = [ring, other].map((one) => (flip ? [...one].reverse() : one));
        faces.strip(faces.ring(a.map(low)), faces.ring(b.map(high)));
      });
      const cut = triangulated(region);
      for (const [{ points, triangles }, place, up] of [[cut, low, down], [to === from ? cut : triangulated(to[i]), high, !down]]) {
        const all = points.map((p) => faces.add(place(p)));
        for (const [a, b, c] of triangles) up ? faces.face(all[a], all[b], all[c]) : faces.face(all[a], all[c], all[b]);
      }
    });
  }

  // Adds a round bar or pipe along a line, mitred at its corners.
  #disk(faces, [directrix, radius, inner, start, end]) {
    if (start !== null && start !== 0 || end !== null && end !== undefined && !this.#isWhole(directrix, end)) faces.told = "IFCSWEPTDISKSOLID of a part of its directrix is read along all of it";
    const line = this.curves.points(directrix), close = length(minus(line[0], line.at(-1))) <= 1e-6 * radius + 1e-12;
    if (close) line.pop();
    const count = line.length, along = (i) => unit(minus(line[(i + 1) % count], line[i]));
    if (count < 2) throw new Unread("IFCSWEPTDISKSOLID along nothing");
    const segments = Array.from({ length: close ? count : count - 1 }, (_, i) => along(i));
    if (segments.some((d) => !d)) throw new Unread("IFCSWEPTDISKSOLID along a line that stands still");
    // Carries axes across the first segment on to the others, without twist.
    let x = unit(cross(segments[0], Math.abs(segments[0][2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));
    const frames = segments.map((d, i) => {
      if (i > 0) {
        const p = segments[i - 1], axis = cross(p, d), c = dot(p, d);
        if (c > -0.999999) x = plus(plus(x.map((v) => v * c), cross(axis, x)), axis, dot(axis, x) / (1 + c));
      }
      return { x, y: cross(d, x), d };
    });
    const around = this.curves.chords(radius, 2 * Math.PI);
    const rings = (r) => Array.from({ length: count }, (_, i) => {
      const before = close || i > 0 ? frames.at(i - 1) : frames[0], after = i < frames.length ? frames[i] : close ? frames[0] : before;
      const plane = unit(plus(before.d, after.d)) ?? after.d;  // plane of the mitre
      return faces.ring(Array.from({ length: around }, (_, k) => {
        const t = 2 * Math.PI * k / around, p = plus(before.x.map((v) => v * r * Math.cos(t)), before.y, r * Math.sin(t));
        const slide = -dot(p, plane) / Math.max(0.2, dot(before.d, plane));
        return plus(line[i], plus(p, before.d, slide));
      }));
    });
    const outer = rings(radius), hollow = inner > 0 ? rings(inner) : null;
    for (let i = 0; i + 1 < count; ++i) {
      faces.strip(outer[i], outer[i + 1]);
      if (hollow) faces.strip([...hollow[i]].reverse(), [...hollow[i + 1]].reverse());
    }
    if (close) {
      // The frame has turned on its way round, so the ring starts at the nearest point.
      const last = outer.at(-1), shifted = (ring, by) => ring.map((_, k) => ring[(k + by) % around]);
      const by = around === 0 ? 0 : last.reduce((best, _, k) => (length(minus(faces.points[outer[0][k]], faces.points[last[0]])) < length(minus(faces.points[outer[0][best]], faces.points[last[0]])) ? k : best), 0);
      faces.strip(last, shifted(outer[0], by));
      if (hollow) faces.strip([...hollow.at(-1)].reverse(), shifted(hollow[0], by).reverse());
      return;
    }
    for (const [ring, hole, ahead] of [[outer[0], hollow?.[0], false], [outer.at(-1), hollow?.at(-1), true]]) {
      const [a, b] = ahead ? [ring, hole] : [[...ring].reverse(), hole && [...hole].reverse()];
      if (b) faces.strip(a, b);
      else for (let k = 1; k + 1 < a.length; ++k) faces.face(a[0], a[k], a[k + 1]);
    }
  }

  // Returns true if a parameter is the end of the directrix.
  #isWhole(directrix, end) {
    const { step } = this, type = step.type(directrix.ref), args = step.args(directrix.ref);
    const last = type === "IFCPOLYLINE" ? args[0].length - 1 : type === "IFCCOMPOSITECURVE" ? args[0].length : type === "IFCINDEXEDPOLYCURVE" && args[1] ? args[1].length : NaN;
    return Math.abs(end - last) < 1e-9 || (end === 1 && Number.isNaN(last));
  }
}
