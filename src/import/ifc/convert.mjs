// SPDX-License-Identifier: Apache-2.0
// Converts the IFC models of one site to one GLB.
import fs from "node:fs";
import path from "node:path";
import { Site } from "./building.mjs";
import { choices } from "./doubt.mjs";
import { identity } from "./matrix.mjs";
import { open, Question, read } from "./model.mjs";

// `unit`: m, cm, mm, in or ft, which replaces the files' own; or none. Throws Question for what a person must answer,
// and other errors for models at fault.
export function convert(ifc, api, files, unit) {
  const one = files.length === 1;
  // A single file stays open; several files are open one at a time.
  const models = files.map((file) => {
    const opened = open(ifc, api, fs.readFileSync(file), unit);
    if (!one) api.CloseModel(opened.step.model);
    return { name: path.basename(file), file, located: opened.located, opened: one ? opened : null };
  });
  const site = new Site(), { notes, crs, of } = places(models);
  site.crs = crs;
  const placed = models.map(of);
  if (models.some(({ located }) => located?.place)) site.place = placed.every((one) => one.every((v, i) => v === placed[0][i])) ? placed[0] : null;
  for (const model of models) {
    const opened = model.opened ?? open(ifc, api, fs.readFileSync(model.file), unit), about = one ? "" : `${model.name}: `;
    const found = read(site, opened, of(model));
    api.CloseModel(opened.step.model);
    site.notes.push(...[...(model.located?.notes ?? []), ...found.notes].map((note) => about + note));
    if (site.shapes.size === 0) continue;
    if (!opened.length && !unit) throw new Question(`${about}it states no unit of length; give the setting unit: ${choices(site.extent, 1).join(", ")}`);
    if (found.doubt) throw new Question(about + found.doubt);
  }
  site.notes.push(...notes);
  return site.toGlb();
}

// Returns {notes, crs, of}; `of` gives a file's place. Files without a map conversion take the first one that there is.
function places(models) {
  const notes = [], mapped = models.filter(({ located }) => located?.place), first = mapped[0];
  const crs = [...new Set(mapped.map(({ located }) => located.crs).filter(Boolean))];
  if (crs.length > 1) throw new Question(`its files are in different coordinate systems (${crs.join(", ")}); export them in one`);
  if (first && mapped.length < models.length)
    notes.push(`${models.filter((model) => !mapped.includes(model)).map(({ name }) => name).join(", ")}: without a map conversion, placed by that of ${first.name}`);
  if (first) {
    const { crs: code, feet, name, place } = first.located;
    const at = `${place[12].toFixed(2)} E, ${(-place[14]).toFixed(2)} N, ${place[13].toFixed(2)} m`;
    notes.push(`it stands on the map by its map conversion, its origin at ${at}` + (code ? ` in ${code.length > 40 ? name || "its coordinate system" : code}`
      : feet ? "" : `; the coordinate system${name ? `, "${name}",` : ""} has no EPSG number: give the setting crs for maps`));
  }
  return { notes, crs: crs[0] ?? "", of: ({ located }) => located?.place ?? first?.located.place ?? identity() };
}
