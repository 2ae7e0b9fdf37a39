// SPDX-License-Identifier: Apache-2.0
// Finds where two axes of a grid meet.
import { cross, dot, length, minus, plus, unit } from "./axes.mjs";
import { Unread } from "./curves.mjs";

// Returns {parent, place, unturned} from an IfcGridPlacement's attributes: the parent placement, and {o, x, y, z}
// within it. `unturned`: no direction is given, so that the grid's axes hold.
export function gridPlace(step, axes, curves, args) {
  const [location, direction] = args.slice(-2), own = args.length > 2 ? args[0] : null;  // IFC 4.3 names the placement
  const [crossing] = step.args(location.ref);
  const grid = gridOf(step, crossing[0].ref);
  if (!grid && !own) throw new Unread("IFCGRIDPLACEMENT on axes of no grid");
  const o = meeting(step, curves, location.ref), up = [0, 0, 1];
  let x = null;
  if (direction) {
    const to = step.type(direction.ref) === "IFCDIRECTION" ? axes.point(direction) : minus(meeting(step, curves, direction.ref), o);
    x = unit([to[0], to[1], 0]);
    if (!x) throw new Unread("IFCGRIDPLACEMENT without a direction in its plane");
  }
  const along = x ?? [1, 0, 0];
  return { parent: own ?? step.args(grid)[5], place: { o, x: along, y: cross(up, along), z: up }, unturned: !x };
}

function gridOf(step, axis) {
  return step.ids("IFCGRID").find((id) => step.args(id).slice(7, 10).some((axes) => axes?.some(({ ref }) => ref === axis)));
}

// Returns the point of an IfcVirtualGridIntersection: axes are offset to their left, and the third distance is height.
function meeting(step, curves, id) {
  const [[first, second], distances] = step.args(id), [left = 0, other = 0, height = 0] = distances ?? [];
  const [a, b] = [[first, left], [second, other]].map(([axis, by]) => {
    const [, curve, same] = step.args(axis.ref);
    const points = line(step, curves, curve);
    return moved(same === false ? points.reverse() : points, by);
  });
  let best = null;
  for (let i = 0; i + 1 < a.length; ++i)
    for (let k = 0; k + 1 < b.length; ++k) {
      const d = minus(a[i + 1], a[i]), e = minus(b[k + 1], b[k]), n = d[0] * e[1] - d[1] * e[0], to = minus(b[k], a[i]);
      if (Math.abs(n) < 1e-12 * length(d) * length(e)) continue;
      const t = (to[0] * e[1] - to[1] * e[0]) / n, s = (to[0] * d[1] - to[1] * d[0]) / n;
      const beyond = Math.max(0, -t, t - 1) * length(d) + Math.max(0, -s, s - 1) * length(e);  // axes extend beyond ends
      if (!best || beyond < best.beyond) best = { beyond, point: plus(a[i], d, t) };
    }
  if (!best) throw new Unread("axes of a grid that do not meet");
  return [best.point[0], best.point[1], height];
}

// Returns the points of an axis; a line has no ends.
function line(step, curves, curve) {
  if (step.type(curve.ref) !== "IFCLINE") return curves.points(curve).map(([x, y]) => [x, y]);
  const [point, vector] = step.args(curve.ref), [direction] = step.args(vector.ref);
  const o = curves.axes.point(point).slice(0, 2), d = unit(curves.axes.point(direction).slice(0, 2));
  return [o, plus(o, d)];
}

function moved(points, by) {
  if (by === 0) return points;
  const normals = points.slice(1).map((point, i) => { const [x, y] = unit(minus(point, points[i])) ?? [1, 0]; return [-y, x]; });
  return points.map((point, i) => {
    const a = normals[Math.max(0, i - 1)], b = normals[Math.min(i, normals.length - 1)], middle = unit(plus(a, b)) ?? a;
    return plus(point, middle, by / Math.max(0.1, dot(middle, a)));
  });
}
