// SPDX-License-Identifier: Apache-2.0
// Profiles as regions of a plane: an outer ring and holes, each a list of points [x, y] without a repeated end.
import { length, minus, placed, plus, unit } from "./axes.mjs";
import { Unread } from "./curves.mjs";

export class Profiles {
  constructor(step, axes, curves) {
    Object.assign(this, { step, axes, curves });
  }

  // Throws Unread.
  regions(ref) {
    const { step } = this, type = step.type(ref.ref), args = step.args(ref.ref);
    switch (type) {
      case "IFCARBITRARYCLOSEDPROFILEDEF": return [{ outer: this.#ring(args[2]), holes: [] }];
      case "IFCARBITRARYPROFILEDEFWITHVOIDS": return [{ outer: this.#ring(args[2]), holes: args[3].map((hole) => this.#ring(hole)) }];
      case "IFCCENTERLINEPROFILEDEF": return [{ outer: thickened(this.#flat(args[2]), args[3] / 2), holes: [] }];
      case "IFCCOMPOSITEPROFILEDEF": return args[2].flatMap((part) => this.regions(part));
      case "IFCDERIVEDPROFILEDEF": return this.#moved(this.regions(args[2]), this.axes.operator(args[3].ref));
      case "IFCMIRROREDPROFILEDEF": return this.#moved(this.regions(args[2]), { o: [0, 0, 0], x: [-1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] });
      default: return this.#moved([this.#shape(type, args.slice(3))], this.axes.placement(args[2]));
    }
  }

  #moved(regions, place) {
    const move = (ring) => ring.map((point) => placed(place, point).slice(0, 2));
    return regions.map(({ outer, holes }) => ({ outer: move(outer), holes: holes.map(move) }));
  }
  #flat(curve) {
    return this.curves.points(curve).map(([x, y]) => [x, y]);
  }
  #ring(curve) {
    const ring = this.#flat(curve), near = (a, b) => length(minus(a, b)) <= 1e-9 * (1 + length(a));
    while (ring.length > 1 && near(ring[0], ring.at(-1))) ring.pop();
    if (ring.length < 3) throw new Unread("a profile without an area");
    return ring;
  }

  // Returns a parametrised profile around its own origin.
  #shape(type, a) {
    const solid = (...corners) => ({ outer: this.#rounded(corners), holes: [] });
    const box = (w, h, r = 0) => this.#rounded([[-w / 2, -h / 2, r], [w / 2, -h / 2, r], [w / 2, h / 2, r], [-w / 2, h / 2, r]]);
    const circle = (r, s = r) => this.curves.arc({ o: [0, 0, 0], x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] }, r, s, 0, 2 * Math.PI).slice(0, -1).map(([x, y]) => [x, y]);
    // Reads a sloped face as level if the error is below the chord error; else throws Unread.
    const even = (slope, long) => { if (slope && Math.abs(Math.tan(slope * this.curves.radians)) * long / 2 > this.curves.chord) throw new Unread(`${type} with a slope`); };
    switch (type) {
      case "IFCRECTANGLEPROFILEDEF": return { outer: box(a[0], a[1]), holes: [] };
      case "IFCROUNDEDRECTANGLEPROFILEDEF": return { outer: box(a[0], a[1], a[2]), holes: [] };
      case "IFCRECTANGLEHOLLOWPROFILEDEF": return { outer: box(a[0], a[1], a[4] ?? 0), holes: [box(a[0] - 2 * a[2], a[1] - 2 * a[2], a[3] ?? 0)] };
      case "IFCCIRCLEPROFILEDEF": return { outer: circle(a[0]), holes: [] };
      case "IFCCIRCLEHOLLOWPROFILEDEF": return { outer: circle(a[0]), holes: [circle(a[0] - a[1])] };
      case "IFCELLIPSEPROFILEDEF": return { outer: circle(a[0], a[1]), holes: [] };
      case "IFCTRAPEZIUMPROFILEDEF": {
        const [bottom, top, h, offset] = a, x = -bottom / 2 + offset;
        return solid([-bottom / 2, -h / 2], [bottom / 2, -h / 2], [x + top, h / 2], [x, h / 2]);
      }
      case "IFCISHAPEPROFILEDEF": {
        const [w, h, web, flange, fillet, edge, slope] = a;
        even(slope, (w - web) / 2);
        return solid(...girder(w, w, h, web, flange, flange, fillet, fillet, edge, edge));
      }
      case "IFCASYMMETRICISHAPEPROFILEDEF": {
        const [w, h, web, flange, fillet, top, topFlange, topFillet, edge, slope, topEdge, topSlope] = a;
        even(slope, (w - web) / 2), even(topSlope, (top - web) / 2);
        return solid(...girder(w, top, h, web, flange, topFlange ?? flange, fillet, topFillet ?? fillet, a.length > 9 ? edge : 0, topEdge));
      }
      case "IFCLSHAPEPROFILEDEF": {
        const [h, given, t, fillet, edge, slope] = a, w = given ?? h, x = -w / 2, y = -h / 2;
        even(slope, Math.max(w, h));
        return solid([x, y], [-x, y], [-x, y + t, edge], [x + t, y + t, fillet], [x + t, -y, edge], [x, -y]);
      }
      case "IFCTSHAPEPROFILEDEF": {
        const [h, w, web, flange, fillet, edge, webEdge, webSlope, slope] = a, y = h / 2, under = y - flange;
        even(webSlope, h), even(slope, (w - web) / 2);
        return solid([-web / 2, -y, webEdge], [web / 2, -y, webEdge], [web / 2, under, fillet], [w / 2, under, edge], [w / 2, y], [-w / 2, y], [-w / 2, under, edge], [-web / 2, under, fillet]);
      }
      case "IFCUSHAPEPROFILEDEF": {
        const [h, w, web, flange, fillet, edge, slope] = a, x = -w / 2, y = h / 2;
        even(slope, w - web);
        return solid([x, -y], [-x, -y], [-x, -y + flange, edge], [x + web, -y + flange, fillet], [x + web, y - flange, fillet], [-x, y - flange, edge], [-x, y], [x, y]);
      }
      case "IFCCSHAPEPROFILEDEF": {
        const [h, w, t, girth, inner] = a, x = -w / 2, y = h / 2, outer = inner ? inner + t : 0;
        return solid([x, -y, outer], [-x, -y, outer], [-x, -y + girth], [-x - t, -y + girth], [-x - t, -y + t, inner], [x + t, -y + t, inner],
          [x + t, y - t, inner], [-x - t, y - t, inner], [-x - t, y - girth], [-x, y - girth], [-x, y, outer], [x, y, outer]);
      }
      case "IFCZSHAPEPROFILEDEF": {
        const [h, w, web, flange, fillet, edge] = a, y = h / 2, x = w - web / 2, s = web / 2;
        return solid([-s, -y], [x, -y], [x, -y + flange, edge], [s, -y + flange, fillet], [s, y], [-x, y], [-x, y - flange, edge], [-s, y - flange, fillet]);
      }
      default: throw new Unread(type || "a profile that is missing");
    }
  }

  // Replaces corners [x, y, radius] that have a radius by arcs that touch both their edges.
  #rounded(corners) {
    return corners.flatMap(([x, y, radius], i) => {
      const here = [x, y];
      if (!(radius > 0)) return [here];
      const before = corners.at(i - 1).slice(0, 2), after = corners[(i + 1) % corners.length].slice(0, 2);
      const u = unit(minus(before, here)), v = unit(minus(after, here));
      if (!u || !v) return [here];
      const half = Math.acos(Math.min(1, Math.max(-1, u[0] * v[0] + u[1] * v[1]))) / 2, to = radius / Math.tan(half);
      const middle = unit(plus(u, v));
      if (!middle || !(to > 0)) return [here];
      const centre = plus(here, middle, radius / Math.sin(half)), start = minus(plus(here, u, to), centre), end = minus(plus(here, v, to), centre);
      const from = Math.atan2(start[1], start[0]);
      let turn = Math.atan2(end[1], end[0]) - from;
      turn -= 2 * Math.PI * Math.round(turn / (2 * Math.PI));
      return this.curves.arc({ o: [...centre, 0], x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] }, radius, radius, from, from + turn).map((p) => p.slice(0, 2));
    });
  }
}

function girder(bottom, top, h, web, low, high, fillet, topFillet, edge, topEdge) {
  const [b, t, s, y] = [bottom / 2, top / 2, web / 2, h / 2];
  return [[-b, -y], [b, -y], [b, -y + low, edge], [s, -y + low, fillet], [s, y - high, topFillet], [t, y - high, topEdge], [t, y], [-t, y],
    [-t, y - high, topEdge], [-s, y - high, topFillet], [-s, -y + low, fillet], [-b, -y + low, edge]];
}

// Returns the band around a line, with mitred corners.
function thickened(line, half) {
  const side = (sign) => line.map((here, i) => {
    const along = [line[i - 1] && unit(minus(here, line[i - 1])), line[i + 1] && unit(minus(line[i + 1], here))].filter(Boolean);
    if (along.length === 0) throw new Unread("a centre line without a length");
    const normals = along.map(([x, y]) => [-y * sign, x * sign]), middle = unit(plus(normals[0], normals.at(-1))) ?? normals[0];
    const cosine = Math.max(0.1, middle[0] * normals[0][0] + middle[1] * normals[0][1]);
    return plus(here, middle, half / cosine);
  });
  return [...side(-1), ...side(1).reverse()];
}
