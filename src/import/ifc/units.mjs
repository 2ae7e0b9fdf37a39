// SPDX-License-Identifier: Apache-2.0
// Lengths and angles of a model's unit assignment.
import { enumeration, measure } from "./step.mjs";

const PREFIXES = { EXA: 1e18, PETA: 1e15, TERA: 1e12, GIGA: 1e9, MEGA: 1e6, KILO: 1e3, HECTO: 1e2, DECA: 10, DECI: 0.1, CENTI: 0.01, MILLI: 1e-3,
  MICRO: 1e-6, NANO: 1e-9, PICO: 1e-12, FEMTO: 1e-15, ATTO: 1e-18 };

// Returns a unit in terms of the SI unit (metre, radian), and its name; null if the file does not tell. Conversions may
// be based on one another.
function size(step, ref, seen = new Set()) {
  if (!ref || seen.has(ref.ref)) return null;
  seen.add(ref.ref);
  const type = step.type(ref.ref), args = step.args(ref.ref);
  if (type === "IFCSIUNIT") {
    const [, kind, prefix, name] = args.length === 4 ? args : [null, ...args];  // the first attribute is derived: *
    if (!["METRE", "RADIAN"].includes(name)) return null;
    return { kind, value: prefix ? PREFIXES[prefix] : 1, name: `${prefix ?? ""}${name}`.toLowerCase() };
  }
  if (!type.startsWith("IFCCONVERSIONBASEDUNIT")) return null;
  const [kind, name, factor] = args.slice(-(type.endsWith("OFFSET") ? 4 : 3));
  const [value, base] = step.args(factor.ref), of = size(step, base, seen), number = typeof value === "number" ? value : value?.value;
  if (!of || !(number > 0)) return null;
  return { kind, value: number * of.value, name: String(name).toLowerCase() };
}

// Returns {length, angle}: each {value, name}; length is null if the project states none.
export function units(step) {
  const found = { length: null, angle: null };
  for (const project of step.ids("IFCPROJECT")) {
    const assignment = step.args(project)[8];
    for (const unit of assignment ? step.args(assignment.ref)[0] ?? [] : []) {
      const is = size(step, unit);
      if (is?.kind === "LENGTHUNIT") found.length ??= is;
      if (is?.kind === "PLANEANGLEUNIT") found.angle ??= is;
    }
  }
  found.angle ??= { value: 1, name: "radian" };
  return found;
}

export const metresOf = (step, ref) => size(step, ref)?.value ?? null;

// Makes the model declare a length in metres in the form that web-ifc reads.
export function stateLength(step, metres) {
  const project = step.ids("IFCPROJECT")[0];
  if (!project) return false;
  const metre = step.add("IFCSIUNIT", [null, enumeration("LENGTHUNIT"), null, enumeration("METRE")]);
  const exponents = step.add("IFCDIMENSIONALEXPONENTS", [1, 0, 0, 0, 0, 0, 0].map((value) => ({ type: 10, value })));
  const factor = step.add("IFCMEASUREWITHUNIT", [measure("IFCLENGTHMEASURE", metres), metre]);
  const unit = step.add("IFCCONVERSIONBASEDUNIT", [exponents, enumeration("LENGTHUNIT"), "LENGTH", factor]);
  step.change(project, { 8: step.add("IFCUNITASSIGNMENT", [[unit]]) });
  return true;
}
