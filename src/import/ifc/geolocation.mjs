// SPDX-License-Identifier: Apache-2.0
// Place of a model on a map: IfcMapConversion and its like, and the property sets that replace them in IFC 2x3.
import { metresOf } from "./units.mjs";

const value = (one) => (typeof one === "object" && one ? one.value : one);

// Returns null, or {crs, feet, name, place, notes}. `crs` is EPSG:N, well-known text or "", which it also is if it counts in `feet`. `place` takes the
// model, in metres with Y up, to the map; null if the conversion is empty. `metres`: in the model's unit.
export function geolocation(step, metres, mentions) {
  const given = conversion(step, mentions);
  if (!given) return null;
  const { east, north, height, abscissa, ordinate, scale, factors, target } = given, notes = [];
  const name = target.name ?? "", crs = target.text || code(name) || code(target.description ?? "");
  if (![east, north].every(Number.isFinite)) return { crs, name, place: null, notes: ["its map conversion has no numbers, and is not applied"] };
  if (east === 0 && north === 0) return { crs, name, place: null, notes: ["its map conversion has the origin of the map, as programs write that know none; it is not applied"] };
  // A scale equal to the model's unit gives metres; else map coordinates are in the map's unit, or the model's.
  let unit = target.unit ?? (Math.abs(scale / metres - 1) < 0.1 ? 1 : metres);
  if (!target.unit && unit < 0.5 && Math.hypot(east, north) * unit < 20_000 && Math.hypot(east, north) >= 20_000) {
    unit = 1;
    notes.push("its map conversion has no unit of the map; easting and northing are taken as metres");
  }
  // The site is in metres, so a system in feet no longer fits its coordinates. Millimetres belong to the file, since
  // systems count in metres or feet.
  const metric = Math.abs(Math.log10(unit) - Math.round(Math.log10(unit))) < 1e-9;
  if (crs && !metric) notes.push(`its coordinate system${name ? `, "${name}",` : ""} counts in units of ${unit} m, and the site is in metres: it is not used for maps`);
  let grow = scale * unit / metres;
  if (Math.abs(grow - 1) > 0.05) {
    notes.push(`its map conversion would make the site ${grow.toPrecision(3)} times as large by its scale, which is not applied`);
    grow = 1;
  }
  const long = Math.hypot(abscissa, ordinate) || 1, [c, s] = [abscissa / long, ordinate / long], [fx, fy, fz] = factors.map((f) => f * grow);
  // (x, y, z) becomes (x, z, -y) with Y up.
  const place = [c * fx, 0, -s * fx, 0, 0, fz, 0, 0, s * fy, 0, c * fy, 0, east * unit, height * unit, -north * unit, 1];
  return { crs: metric ? crs : "", feet: Boolean(crs) && !metric, name, place, notes };
}

const code = (text) => {
  const found = /EPSG\D{0,6}(\d{4,6})/i.exec(text) ?? /^\s*(\d{4,5})\s*$/.exec(text);
  return found ? `EPSG:${found[1]}` : "";
};

function conversion(step, mentions) {
  const [id] = step.ids("IFCMAPCONVERSION", "IFCMAPCONVERSIONSCALED", "IFCRIGIDOPERATION");
  if (id) {
    const [, target, east, north, height, abscissa, ordinate, scale, ...factors] = step.args(id), rigid = step.type(id) === "IFCRIGIDOPERATION";
    return { east: value(east), north: value(north), height: value(height) ?? 0, abscissa: rigid ? 1 : abscissa ?? 1, ordinate: rigid ? 0 : ordinate ?? 0,
      scale: rigid ? 1 : scale ?? 1, factors: factors.length === 3 ? factors.map((f) => f ?? 1) : [1, 1, 1], target: system(step, target.ref) };
  }
  if (!mentions("ePSet_MapConversion")) return null;
  const sets = new Map();
  for (const set of step.ids("IFCPROPERTYSET")) {
    const [, , name, , properties] = step.args(set);
    if (!/^epset_(mapconversion|projectedcrs)$/i.test(name ?? "")) continue;
    sets.set(name.toLowerCase(), new Map(properties.map((one) => step.args(one.ref)).map(([key, , nominal]) => [key.toLowerCase(), value(nominal)])));
  }
  const map = sets.get("epset_mapconversion"), crs = sets.get("epset_projectedcrs");
  if (!map) return null;
  const number = (key, usual) => { const found = Number(map.get(key) ?? usual); return Number.isFinite(found) ? found : usual; };
  return { east: number("eastings", NaN), north: number("northings", NaN), height: number("orthogonalheight", 0), abscissa: number("xaxisabscissa", 1),
    ordinate: number("xaxisordinate", 0), scale: number("scale", 1), factors: [1, 1, 1],
    target: { name: crs?.get("name"), description: crs?.get("description"), unit: /^metre|^meter|^m$/i.test(crs?.get("mapunit") ?? "") ? 1 : undefined } };
}

function system(step, id) {
  const [name, description, , , , , unit] = step.args(id);
  const text = step.ids("IFCWELLKNOWNTEXT").map((one) => step.args(one)).find(([, of]) => of?.ref === id)?.[0];
  return { name, description, text, unit: unit?.ref ? metresOf(step, unit) ?? undefined : undefined };
}
