// SPDX-License-Identifier: Apache-2.0
// Reads one IFC file into a site: opens it, rewrites it for web-ifc, adds its products, and notes what is not read.
import { Building } from "./building.mjs";
import { geolocation } from "./geolocation.mjs";
import { Materials } from "./materials.mjs";
import { Plain } from "./plain.mjs";
import { Skins } from "./skins.mjs";
import { Step } from "./step.mjs";
import { doubt } from "./doubt.mjs";
import { stateLength, units } from "./units.mjs";

const CHORD_M = 0.005, CHORDS = 12, MOST_CHORDS = 400;
const LISTED = 10;  // products in a note
// Products that do not stand on the site.
const DRAWN = /^IFC(ANNOTATION|GRID|VIRTUALELEMENT|REFERENT|ALIGNMENT.*|LINEARPOSITIONINGELEMENT|STRUCTURAL.*|.*PORT)$/;

// Units that a user may give, in metres.
const METRES = { m: 1, cm: 0.01, mm: 0.001, in: 0.0254, ft: 0.3048 };

// A question that a person must answer, in one line.
export class Question extends Error {}

// `unit`: one of METRES, or none for the file's own. Returns what read() needs.
export function open(ifc, api, bytes, unit) {
  const mentions = (text) => bytes.includes(text);
  const schema = /FILE_SCHEMA\s*\(\s*\(\s*'([^']*)'/.exec(bytes.subarray(0, 65536).toString("latin1"))?.[1] ?? "";
  let model = api.OpenModel(bytes, { COORDINATE_TO_ORIGIN: false });
  if (model < 0) throw new Error(`its schema${schema ? `, ${schema},` : ""} is not known; IFC 2x3, IFC 4 and IFC 4.3 are read`);
  let step = new Step(ifc, api, model);
  const { length, angle } = units(step), metres = METRES[unit] ?? length?.value ?? null;
  // Circles left to web-ifc all get the same number of chords, chosen for the largest circle.
  const chords = metres === null ? CHORDS : largestChords(step, metres);
  if (chords > CHORDS) {
    api.CloseModel(model);
    model = api.OpenModel(bytes, { COORDINATE_TO_ORIGIN: false, CIRCLE_SEGMENTS: chords });
    step = new Step(ifc, api, model);
  }
  const types = typesOf(api, model);
  return { schema, step, metres: metres ?? 1, given: unit ?? null, length, angle, mentions, types, unknown: unknownEntities(step, bytes, types), located: attempt(() => geolocation(step, metres ?? 1, mentions), { crs: "", name: "", place: null, notes: ["its map conversion is damaged, and not applied"] }) };
}

function largestChords(step, metres) {
  const free = step.ids("IFCADVANCEDFACE", "IFCFACESURFACE", "IFCFIXEDREFERENCESWEPTAREASOLID", "IFCSURFACECURVESWEPTAREASOLID").length > 0;
  const radii = free ? step.ids("IFCCYLINDRICALSURFACE", "IFCCIRCLE").map((id) => step.args(id)[1] * metres) : [];
  const radius = radii.reduce((most, r) => (r > most ? r : most), 0);
  return radius > CHORD_M ? Math.min(MOST_CHORDS, Math.ceil(Math.PI / Math.acos(1 - CHORD_M / radius))) : CHORDS;
}

// Returns the length of a list of web-ifc, and frees the list.
function sizeOf(list) {
  const size = list.size();
  list.delete();
  return size;
}

// Returns {code, name, count} for each class of entity in a model, names in capitals.
const typesOf = (api, model) => api.GetIfcEntityList(model).map((code) => ({ code, count: sizeOf(api.GetLineIDsWithType(model, code)) }))
  .filter(({ count }) => count > 0).map((type) => ({ ...type, name: api.GetNameFromTypeCode(type.code).toUpperCase() }));

// Returns entities that the reader does not know, by name: their number, and the first ones.
function unknownEntities(step, bytes, types) {
  const BLOCK = 1 << 24, OVERLAP = 4096, found = new Map(), names = new Map(), { api, model } = step;
  if (types.reduce((sum, { count }) => sum + count, 0) === sizeOf(api.GetAllLines(model))) return found;
  for (let at = 0; at < bytes.length; at += BLOCK) {
    const text = bytes.latin1Slice(at, Math.min(bytes.length, at + BLOCK + OVERLAP));
    for (const match of text.matchAll(/#\d+\s*=\s*(IFC[A-Za-z0-9_]+)\s*\(/g)) {
      if (match.index >= BLOCK) break;
      const name = match[1];
      if (!names.has(name)) names.set(name, !step.api.GetNameFromTypeCode(step.ifc[name.toUpperCase()] ?? 0)?.startsWith("Ifc"));
      if (!names.get(name)) continue;
      const of = found.get(name) ?? { count: 0, products: [] };
      ++of.count;
      const [, guid, title] = /^\s*'([0-9A-Za-z_$]{22})'\s*,[^,]*,\s*(?:'([^']*)'|\$)/.exec(text.slice(match.index + match[0].length, match.index + 600)) ?? [];
      if (guid && of.products.length < LISTED) of.products.push([name, title, guid].filter(Boolean).join(" "));
      found.set(name, of);
    }
  }
  return found;
}

// Returns a default if a damaged part of a model throws an error.
function attempt(make, instead) {
  try {
    return make();
  } catch (error) {
    if (!(error instanceof TypeError) && !(error instanceof RangeError)) throw error;
    return instead;
  }
}

const several = (count, one, many = `${one}s`) => `${count} ${count === 1 ? one : many}`;
const listed = (all) => all.slice(0, LISTED).join("; ") + (all.length > LISTED ? `; and ${all.length - LISTED} more` : "");

// Adds an open model. `place` transforms it to the site. Returns its notes.
export function read(site, { schema, step, metres, given, length, angle, types, unknown }, place) {
  const { api, model } = step;
  if (given || !length || length.value !== 1) stateLength(step, metres);
  const plain = new Plain(step, CHORD_M / metres, angle.value);
  const products = step.ids(...types.filter(({ code, name }) => api.IsIfcElement(code) && !DRAWN.test(name)).map(({ name }) => name));
  const analysis = step.kinds("IFCSTRUCTURALITEM").filter((id) => step.args(id)[6]).length;
  const opened = new Set(step.ids("IFCRELVOIDSELEMENT").map((id) => step.args(id)[4]?.ref));
  const damaged = [], part = (name) => { damaged.push(name); return null; };
  const made = new Map(products.map((id) => [id, attempt(() => plain.product(id, opened.has(id)), { parts: [[id]], problems: ["its shape is damaged"], left: [] })]));
  const materials = new Materials(step);
  if (attempt(() => materials.apply() ?? true, null) === null) part("materials");
  plain.styleCopies();
  const skins = attempt(() => new Skins(step, plain.axes, plain.solids, metres).mend(), null) ?? part("openings") ?? [];

  const building = new Building(site, step, opened, place), incomplete = [], lost = [], bodiless = [];
  for (const id of products) {
    if (!building.hasBody(id)) continue;
    const { parts, problems, left } = made.get(id), isClosed = (one) => plain.cut.has(one) || (opened.has(id) && plain.solid.has(one));
    const added = parts.length > 0 ? building.add(id, parts, isClosed) : { empty: 0, open: 0 };
    if (!added) continue;
    const { empty, open: holes } = added, why = [...new Set(problems)];
    if (empty > 0) why.push(parts.length === 1 ? "no surface could be made of it" : `no surface could be made of ${empty} of its ${parts.length} items`);
    if (holes > 0) why.push("its surface has a hole where something was cut out of it");
    const nothing = empty === parts.length;
    if (why.length > 0) (nothing ? lost : incomplete).push(`${step.label(id)} (${why.join(", ")})`);
    else if (nothing && left.length > 0 && !spatial(step.type(id))) bodiless.push(`${step.label(id)} (${[...new Set(left)].join(", ")})`);
  }
  if (attempt(() => building.addRooms() ?? true, null) === null) part("rooms");
  const notes = [], label = (id) => step.label(id);
  const note = (all, one, many, what) => { if (all.length > 0) notes.push(`${all.length} ${all.length === 1 ? one : many} ${what}: ${listed(all)}`); };
  note(lost, "product has", "products have", "a shape of which no surface could be made, and are left out".replace("are", lost.length === 1 ? "is" : "are"));
  note(incomplete, "product is", "products are", "incomplete or not sure");
  for (const name of damaged) notes.push(`its ${name} are damaged, and not read whole`);
  const strange = [...unknown].map(([name, { count, products: some }]) => `${count} ${name}${some.length > 0 ? ` (${listed(some)})` : ""}`);
  note(strange, "class of entities is", "classes of entities are", "unknown to the reader of IFC and left out");
  note(bodiless, "product has", "products have", "no body, only what is drawn beside one, and no surface");
  note(skins.filter(({ opened }) => opened).map(skinText(step)), "opening left", "openings left", "a skin of up to 1 cm in front of a face, which was opened");
  note(skins.filter(({ opened }) => !opened).map(skinText(step)), "opening leaves", "openings leave", "a skin that closes it");
  note(materials.guessed.map(label), "product has", "products have", "a material of the category glass without a style, and is taken as glass");
  note(materials.unsaid.map(label), "product is", "products are", "of glass and other materials without saying which part is glass, and opaque");
  note(building.twice.map(label), "product is", "products are", "in another file of the site, too, and read once");
  if (/^IFC4X(1|2|3_RC\d|2SCGL)$/i.test(schema)) notes.push(`its schema, ${schema}, is a draft of IFC 4.3 and read as that; entities that have changed since are read wrongly`);
  if (analysis > 0) notes.push(`${several(analysis, "member")} of a structural analysis ${analysis === 1 ? "is no body and is" : "are no bodies and are"} left out`);
  if (plain.gridAxes > 0) notes.push(`${several(plain.gridAxes, "placement")} on a grid without a direction ${plain.gridAxes === 1 ? "keeps" : "keep"} the grid's axes`);
  return { notes, doubt: given || !length ? null : attempt(() => doubt(step, site.extent, length, metres), null) };
}

const spatial = (type) => /^IFC(SITE|BUILDING|BUILDINGSTOREY|SPACE|PROJECT|.*ZONE|FACILITY.*|.*SPATIAL.*|ROAD|RAILWAY|BRIDGE|MARINEFACILITY)$/.test(type);
const skinText = (step) => ({ opening, host, skin_m: skin }) => `${step.label(opening)} in ${step.label(host)}, ${(skin * 1000).toFixed(1)} mm`;
