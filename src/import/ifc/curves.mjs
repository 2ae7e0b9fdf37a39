// SPDX-License-Identifier: Apache-2.0
// Approximates curves by polylines within a chord error.
import { cross, dot, length, minus, placed, plus, unit, within } from "./axes.mjs";

export class Unread extends Error {}

const LEAST = 12;    // chords of a full circle, however small
const MOST = 20_000;  // of any arc: enough for a circle of 200 km

export class Curves {
  // `chord`: in the model's unit; `radians`: in the model's unit of angles.
  constructor(step, axes, chord, radians) {
    Object.assign(this, { step, axes, chord, radians, like: 0 });  // `like`: a radius whose chords smaller circles get
  }

  // Returns the number of chords for an angle in radians.
  chords(radius, angle) {
    const most = 2 * Math.acos(1 - this.chord / Math.max(radius, this.like, this.chord));
    const count = Math.max(1, Math.ceil(Math.abs(angle) / Math.min(most, 2 * Math.PI / LEAST) - 1e-9));
    if (!(count <= MOST)) throw new Unread("an arc with a radius beyond any site");
    return count;
  }

  // Returns points of three coordinates from the curve's start to its end. Throws Unread.
  points(ref) {
    const { step, axes } = this, id = ref.ref, type = step.type(id), args = step.args(id);
    switch (type) {
      case "IFCPOLYLINE": return args[0].map((point) => axes.point(point));
      case "IFCINDEXEDPOLYCURVE": return this.#indexed(args);
      case "IFCCOMPOSITECURVE": case "IFC2DCOMPOSITECURVE": case "IFCCOMPOSITECURVEONSURFACE": case "IFCBOUNDARYCURVE": case "IFCOUTERBOUNDARYCURVE":
        return joined(args[0].map((segment) => {
          if (!["IFCCOMPOSITECURVESEGMENT", "IFCREPARAMETRISEDCOMPOSITECURVESEGMENT"].includes(step.type(segment.ref))) throw new Unread(step.type(segment.ref));
          const [, same, parent] = step.args(segment.ref), points = this.points(parent);
          return same === false ? points.reverse() : points;
        }));
      case "IFCTRIMMEDCURVE": return this.#trimmed(args);
      case "IFCCIRCLE": return this.arc(axes.placement(args[0]), args[1], args[1], 0, 2 * Math.PI);
      case "IFCELLIPSE": return this.arc(axes.placement(args[0]), args[1], args[2], 0, 2 * Math.PI);
      case "IFCBSPLINECURVEWITHKNOTS": case "IFCRATIONALBSPLINECURVEWITHKNOTS": return this.#spline(args);
      case "IFCSURFACECURVE": case "IFCSEAMCURVE": case "IFCINTERSECTIONCURVE": return this.points(args[0]);
      default: throw new Unread(type || "a curve that is missing");
    }
  }

  // Returns an arc from one parameter to another, in either direction; both ends are exact.
  arc(axes, a, b, from, to) {
    const n = this.chords(Math.max(a, b), to - from), points = [];
    for (let i = 0; i <= n; ++i) {
      const t = from + (to - from) * i / n;
      points.push(placed(axes, [a * Math.cos(t), b * Math.sin(t)]));
    }
    return points;
  }

  #indexed([list, segments]) {
    const [raw] = this.step.args(list.ref), all = raw.map((p) => [...p, 0].slice(0, 3));
    if (!segments) return all;
    return joined(segments.map(({ typed, value }) => {
      const given = value.map((index) => all[index - 1]);
      if (given.some((point) => !point)) throw new Unread("IFCINDEXEDPOLYCURVE with an index beyond its points");
      return typed === this.step.ifc.IFCARCINDEX ? this.#through(...given) : given;
    }));
  }

  // Returns the arc through three points; chords if they lie on a line.
  #through(a, b, c) {
    const u = minus(b, a), v = minus(c, a), n = cross(u, v), nn = dot(n, n);
    if (!(nn > 1e-18 * dot(u, u) * dot(v, v))) return [a, b, c];
    const o = plus(a, plus(cross(v, n).map((x) => x * dot(u, u)), cross(u, n), -dot(v, v)).map((x) => x / (2 * nn)));
    const z = unit(n), x = unit(minus(a, o)), r = length(minus(a, o)), axes = { o, x, y: cross(z, x), z };
    const [cx, cy] = within(axes, c), end = Math.atan2(cy, cx);
    const points = this.arc(axes, r, r, 0, end > 0 ? end : end + 2 * Math.PI);
    points[0] = a, points[points.length - 1] = c;
    return points;
  }

  #trimmed([basis, first, second, same, preference]) {
    const { step, axes } = this, type = step.type(basis.ref), args = step.args(basis.ref);
    const point = (trim) => trim.find((one) => one?.ref), number = (trim) => trim.find((one) => one?.typed)?.value;
    // Returns a parameter of the basis curve, from the point if the file prefers it.
    const at = (trim, parameter) => {
      const p = point(trim), t = number(trim);
      return p && (preference === "CARTESIAN" || t === undefined) ? parameter(axes.point(p)) : t;
    };
    if (type === "IFCLINE") {
      const o = axes.point(args[0]), [direction, magnitude] = step.args(args[1].ref), d = axes.direction(direction).map((v) => v * magnitude);
      const along = (p) => dot(minus(p, o), d) / dot(d, d), on = (t) => plus(o, d, t);
      const ends = [on(at(first, along)), on(at(second, along))];
      return ends;  // from the first to the second, whatever the line's direction
    }
    if (type === "IFCCIRCLE" || type === "IFCELLIPSE") {
      const place = axes.placement(args[0]), a = args[1], b = type === "IFCCIRCLE" ? a : args[2];
      const angle = (p) => { const [x, y] = within(place, p); return Math.atan2(y / b, x / a); };
      const value = (trim) => { const p = point(trim); return p && (preference === "CARTESIAN" || number(trim) === undefined) ? angle(axes.point(p)) : number(trim) * this.radians; };
      const from = value(first);
      let to = value(second);
      const whole = 2 * Math.PI, turn = (v) => v - whole * Math.floor(v / whole + 1e-12);
      to = same === false ? from - (turn(from - to) || whole) : from + (turn(to - from) || whole);
      return this.arc(place, a, b, from, to);
    }
    // Cuts the polyline of the basis curve; parameters count its corners.
    const all = this.points(basis);
    if (type !== "IFCPOLYLINE" && (number(first) !== undefined && preference !== "CARTESIAN" || !point(first) || !point(second))) throw new Unread(`IFCTRIMMEDCURVE of ${type}`);
    const nearest = (p) => {
      let best = 0, far = Infinity;
      for (let i = 0; i + 1 < all.length; ++i) {
        const d = minus(all[i + 1], all[i]), t = Math.min(1, Math.max(0, dot(minus(p, all[i]), d) / (dot(d, d) || 1))), away = length(minus(p, plus(all[i], d, t)));
        if (away < far) far = away, best = i + t;
      }
      return best;
    };
    const from = at(first, nearest), to = at(second, nearest), [low, high] = [Math.min(from, to), Math.max(from, to)];
    const on = (t) => { const i = Math.min(Math.floor(t), all.length - 2); return plus(all[i], minus(all[i + 1], all[i]), t - i); };
    const points = [on(low), ...all.filter((_, i) => i > low && i < high), on(high)];
    return from <= to ? points : points.reverse();
  }

  #spline(args) {
    const [degree, controls, , , , multiplicities, values, , weights] = args;
    const knots = values.flatMap((value, i) => Array(multiplicities[i]).fill(value));
    const poles = controls.map((control, i) => { const w = weights?.[i] ?? 1; return [...this.axes.point(control).map((v) => v * w), w]; });
    if (knots.length !== poles.length + degree + 1) throw new Unread("a B-spline whose knots do not fit its points");
    const at = (t, span) => {  // de Boor
      const d = poles.slice(span - degree, span + 1);
      for (let r = 1; r <= degree; ++r)
        for (let j = degree; j >= r; --j) {
          const low = knots[j + span - degree], a = (t - low) / (knots[j + 1 + span - r] - low);
          d[j] = d[j].map((v, k) => (1 - a) * d[j - 1][k] + a * v);
        }
      return d[degree].slice(0, 3).map((v) => v / d[degree][3]);
    };
    const points = [];
    for (let span = degree; span < poles.length; ++span) {
      const from = knots[span], to = knots[span + 1];
      if (!(to > from)) continue;
      if (points.length === 0) points.push(at(from, span));
      const refine = (a, pa, b, pb, depth) => {
        const middle = (a + b) / 2, p = at(middle, span), quarters = [0.25, 0.75].map((s) => at(a + s * (b - a), span));
        const off = Math.max(away(p, pa, pb), ...quarters.map((q) => away(q, pa, pb)));
        if (depth > 12 || (depth > 0 && off <= this.chord)) return points.push(pb);
        refine(a, pa, middle, p, depth + 1);
        refine(middle, p, b, pb, depth + 1);
      };
      refine(from, points.at(-1), to, at(to, span), 0);
    }
    return points;
  }
}

const away = (p, a, b) => {
  const d = minus(b, a), t = Math.min(1, Math.max(0, dot(minus(p, a), d) / (dot(d, d) || 1)));
  return length(minus(p, plus(a, d, t)));
};

// Joins chains of points end to end, without the points that two of them share.
function joined(chains) {
  const all = [];
  for (const chain of chains)
    for (const point of chain)
      if (all.length === 0 || length(minus(point, all.at(-1))) > 1e-9 * (1 + length(point))) all.push(point);
  return all;
}
