// SPDX-License-Identifier: Apache-2.0
// Directions, placements and transformation operators, by the functions of the IFC schema (IfcBuildAxes, IfcBaseAxis).
// Directions are made unit vectors, and given axes are made perpendicular to each other.

// Vectors of any length. All else is built on these loops, which take half as long as functions of arrays.
export function dot(a, b) {
  let sum = 0;
  for (let i = 0; i < a.length; ++i) sum += a[i] * b[i];
  return sum;
}
export const minus = (a, b) => plus(a, b, -1);
export function plus(a, b, times = 1) {
  const sum = [];
  for (let i = 0; i < a.length; ++i) sum.push(a[i] + times * b[i]);
  return sum;
}
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (a) => Math.sqrt(dot(a, a));
export const unit = (a) => {
  const long = length(a);
  return long > 0 && Number.isFinite(long) ? a.map((v) => v / long) : null;
};
const rid = (v, axis) => plus(v, axis, -dot(v, axis));  // component of a vector perpendicular to an axis

export class Axes {
  constructor(step) {
    this.step = step;
    this.locals = new Map();
  }

  // Returns three coordinates, whatever the number in the file.
  point(ref) {
    const [values] = this.step.args(ref.ref);
    return [...values, 0, 0].slice(0, 3);
  }
  // Returns a unit vector; null if there is no direction.
  direction(ref) {
    return ref ? unit(this.point(ref)) : null;
  }

  // Returns the axes {o, x, y, z} of a placement in two or three dimensions or with one axis; identity for none.
  placement(ref) {
    if (!ref) return { o: [0, 0, 0], x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };
    const type = this.step.type(ref.ref), args = this.step.args(ref.ref);
    const o = this.point(args[0]);
    const z = (type !== "IFCAXIS2PLACEMENT2D" && this.direction(args[1])) || [0, 0, 1];
    const x = this.#firstAxis(z, type === "IFCAXIS2PLACEMENT2D" ? this.direction(args[1]) : type === "IFCAXIS2PLACEMENT3D" ? this.direction(args[2]) : null);
    return { o, x, y: cross(z, x), z };
  }

  // Returns the placement of a product in the model's coordinates, from its chain of local placements.
  local(ref) {
    if (!ref || this.step.type(ref.ref) !== "IFCLOCALPLACEMENT") return this.placement(null);
    if (this.locals.has(ref.ref)) return this.locals.get(ref.ref);
    const [parent, relative] = this.step.args(ref.ref);
    const place = parent ? composed(this.local(parent), this.placement(relative)) : this.placement(relative);
    this.locals.set(ref.ref, place);
    return place;
  }

  // Returns the placement of an IfcCartesianTransformationOperator, scales included.
  operator(id) {
    const type = this.step.type(id), args = this.step.args(id);
    const o = this.point(args[2]), scale = args[3] ?? 1;
    if (type.startsWith("IFCCARTESIANTRANSFORMATIONOPERATOR2D")) {
      const first = this.direction(args[0]), second = this.direction(args[1]);
      let x = first ?? (second ? [second[1], -second[0], 0] : [1, 0, 0]), y = [-x[1], x[0], 0];
      if (first && second && dot(second, y) < 0) y = y.map((v) => -v);
      const other = type.endsWith("NONUNIFORM") ? args[4] ?? scale : scale;
      return { o, x: x.map((v) => v * scale), y: y.map((v) => v * other), z: [0, 0, scale] };
    }
    const z = this.direction(args[4]) ?? [0, 0, 1];
    const x = this.#firstAxis(z, this.direction(args[0]));
    const y = unit(rid(rid(this.direction(args[1]) ?? [0, 1, 0], z), x)) ?? cross(z, x);
    const scales = type.endsWith("NONUNIFORM") ? [scale, args[5] ?? scale, args[6] ?? scale] : [scale, scale, scale];
    return { o, x: x.map((v) => v * scales[0]), y: y.map((v) => v * scales[1]), z: z.map((v) => v * scales[2]) };
  }

  #firstAxis(z, given) {
    const usual = Math.abs(z[0]) < 1 - 1e-12 ? [1, 0, 0] : [0, 1, 0];
    return unit(rid(given ?? usual, z)) ?? unit(rid(usual, z));
  }
}

// Returns placement b, given within a, in the coordinates of a's parent.
export const composed = (a, b) => {
  const turned = (v) => minus(placed(a, v), a.o);
  return { o: placed(a, b.o), x: turned(b.x), y: turned(b.y), z: turned(b.z) };
};
export const placed = ({ o, x, y, z }, p) => o.map((v, i) => v + x[i] * p[0] + y[i] * p[1] + z[i] * (p[2] ?? 0));
// Returns the coordinates of a point in orthonormal axes.
export const within = ({ o, x, y, z }, p) => [x, y, z].map((axis) => dot(minus(p, o), axis));
