// SPDX-License-Identifier: Apache-2.0
// Doubts a model's unit if no person fits into the model.

const UNITS = [["m", 1, "metres"], ["ft", 0.3048, "feet"], ["in", 0.0254, "inches"], ["cm", 0.01, "centimetres"], ["mm", 0.001, "millimetres"]];
// Plausible sizes in metres. Low walls alone may belong to a terrace.
const SITE = [0.5, 50_000], WALL = [1, 80], STOREY = [0.5, 25], DOOR = [1, 12], SMALL = 5;

const middle = (values) => values.sort((a, b) => a - b)[Math.floor(values.length / 2)];
const outside = (value, [low, high]) => value !== undefined && (value < low || value > high);
const text = (metres) => (metres >= 1 ? metres.toPrecision(3).replace(/e.*$/, (e) => `e${Number(e.slice(1))}`) : metres.toFixed(3));
export const sizes = (size) => `${size.map((v) => (v >= 1000 ? v.toFixed(0) : text(v))).join(" x ")} m`;

// Returns sizes in x, z and y: height last.
export const sizeOf = ({ min, max }) => [max[0] - min[0], max[2] - min[2], max[1] - min[1]];

// Returns texts of the model's size in each unit. `metres`: in its present unit; `wanted`: true for sizes to list.
export function choices(extent, metres, wanted = () => true) {
  const size = sizeOf(extent).map((v) => v / metres);
  return UNITS.map(([name, unit, plural]) => ({ name, plural, size: size.map((v) => v * unit) })).filter(({ size: found }) => wanted(found))
    .map(({ name, plural, size: found }) => `${name} for ${plural} (${sizes(found)})`);
}

// Returns a question, or null. Heights come from extruded walls and from doors' attributes.
export function doubt(step, extent, length, metres) {
  const size = sizeOf(extent), longest = Math.max(...size);
  const doors = step.ids("IFCDOOR", "IFCDOORSTANDARDCASE").map((id) => step.args(id)[8]).filter((v) => typeof v === "number" && v > 0).map((v) => v * metres);
  const walls = wallHeights(step).map((v) => v * metres), few = walls.length < 3;
  const highest = few ? undefined : Math.max(...walls), levels = step.ids("IFCBUILDINGSTOREY").map((id) => step.args(id)[9]).filter((v) => typeof v === "number").sort((a, b) => a - b);
  const storeys = levels.slice(1).map((v, i) => (v - levels[i]) * metres).filter((v) => v > 0);
  const wrong = outside(longest, SITE) || outside(middle(doors), DOOR) || (storeys.length > 1 && outside(middle(storeys), STOREY)) ||
    (!few && ((highest < WALL[0] && longest < SMALL) || middle(walls) > WALL[1]));
  if (!wrong) return null;
  const said = highest !== undefined ? `, with walls up to ${text(highest)} m high` : doors.length > 0 ? `, with doors ${text(middle(doors))} m high` : "";
  return `its unit is doubtful: it says ${length.name}, and the whole site would be ${sizes(size)}${said}, in which no person fits; give the setting unit: ` +
    choices(extent, metres, (found) => !outside(Math.max(...found), [2, 5000])).join(", ");
}

// Returns heights of extruded walls, as most are; a clipped wall counts by the solid before clipping.
function wallHeights(step) {
  const heights = [];
  for (const id of step.ids("IFCWALL", "IFCWALLSTANDARDCASE").slice(0, 200)) {
    const shape = step.args(id)[6];
    for (const representation of shape ? step.args(shape.ref)[2] ?? [] : [])
      for (const item of step.args(representation.ref)[3] ?? []) {
        let at = item.ref;
        for (let steps = 0; steps < 20 && /^IFCBOOLEAN/.test(step.type(at)); ++steps) at = step.args(at)[1].ref;
        if (step.type(at) === "IFCEXTRUDEDAREASOLID") heights.push(step.args(at)[3]);
      }
  }
  return heights;
}
