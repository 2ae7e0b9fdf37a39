// SPDX-License-Identifier: Apache-2.0
// node import.mjs [unit=m|cm|mm|in|ft] FILE...: writes IFC models of one site to standard output, as GLB. Exit codes are
// those of sysexits.h: 65 if a model is at fault, 69 if web-ifc is not installed, each with a line that says so.
import fs from "node:fs";
import path from "node:path";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";
import { Site } from "./building.mjs";
import { choices } from "./doubt.mjs";
import { identity } from "./matrix.mjs";
import { open, read } from "./model.mjs";

const [DATA, UNAVAILABLE, USAGE] = [65, 69, 64];

function fail(code, message) {
  fs.writeSync(2, `${message}\n`);
  process.exit(code);
}

const settings = process.argv.slice(2).filter((word) => word.startsWith("unit="));
const files = process.argv.slice(2 + settings.length);
if (files.length === 0) fail(USAGE, "usage: node import.mjs [unit=UNIT] FILE... >site.glb");
for (const talk of ["log", "info", "warn", "error", "debug"]) console[talk] = () => {};  // standard output is the GLB's

let ifc;
try {
  ifc = createRequire(import.meta.url)("web-ifc");
} catch {
  fail(UNAVAILABLE, `IFC is read by web-ifc, which is not installed; run npm ci in ${fileURLToPath(new URL(".", import.meta.url))} (setup.sh --ifc does)`);
}

// Where each file stands. Files without a map conversion stand as one with: they were drawn in its coordinates.
function places(models) {
  const notes = [], mapped = models.filter(({ located }) => located?.place), first = mapped[0];
  const crs = [...new Set(mapped.map(({ located }) => located.crs).filter(Boolean))];
  if (crs.length > 1) throw new Error(`its files are in different coordinate systems (${crs.join(", ")}); export them in one`);
  if (first && mapped.length < models.length)
    notes.push(`${models.filter((one) => !mapped.includes(one)).map(({ name }) => name).join(", ")} has no map conversion, and is placed by that of ${first.name}`);
  if (first) {
    const { crs: code, name, place } = first.located;
    const at = `${place[12].toFixed(2)} E, ${(-place[14]).toFixed(2)} N, ${place[13].toFixed(2)} m`;
    notes.push(`it stands on the map by its map conversion, its origin at ${at}` + (code ? ` in ${code.length > 40 ? name || "its coordinate system" : code}`
      : `; the coordinate system${name ? `, "${name}",` : ""} has no EPSG number: give the setting crs for maps`));
  }
  return { notes, crs: crs[0] ?? "", of: ({ located }) => located?.place ?? first?.located.place ?? identity() };
}

try {
  const api = new ifc.IfcAPI(), unit = settings.at(-1)?.slice("unit=".length);
  await api.Init();
  api.SetLogLevel(ifc.LogLevel.LOG_LEVEL_OFF);
  const models = files.map((file) => ({ name: path.basename(file), file, ...located(api, file, unit) }));
  const site = new Site(), { notes, crs, of } = places(models);
  site.crs = crs;
  for (const model of models) {
    const opened = files.length > 1 ? open(ifc, api, fs.readFileSync(model.file), unit) : model.opened;
    const found = read(site, opened, of(model));
    api.CloseModel(opened.step.model);
    const told = [...(model.located?.notes ?? []), ...found.notes];
    site.notes.push(...told.map((note) => (files.length > 1 ? `${model.name}: ${note}` : note)));
    if (site.shapes.size === 0) continue;
    if (!opened.length && !unit)
      throw new Error(`${files.length > 1 ? `${model.name}: ` : ""}it states no unit of length; give the setting unit: ${choices(site.extent, 1).join(", ")}`);
    if (found.doubt) throw new Error(`${files.length > 1 ? `${model.name}: ` : ""}${found.doubt}`);
  }
  site.notes.push(...notes);
  const glb = site.toGlb();
  for (let at = 0; at < glb.length;) at += fs.writeSync(1, glb, at);
} catch (error) {
  fail(DATA, `it cannot be read as IFC: ${error?.message ?? "web-ifc gives it up, as too large or damaged"}`.split("\n")[0]);
}
process.exit(0);

// A single file stays open; of several one at a time is.
function located(api, file, unit) {
  const opened = open(ifc, api, fs.readFileSync(file), unit);
  if (files.length > 1) api.CloseModel(opened.step.model);
  return { located: opened.located, opened: files.length > 1 ? null : opened };
}
