// SPDX-License-Identifier: Apache-2.0
// node import.mjs FILE: writes an IFC model to standard output, as GLB. Exit codes are those of sysexits.h: 65 if the
// model is at fault, 69 if web-ifc is not installed, each with a line that says so.
import fs from "node:fs";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";
import { Building } from "./building.mjs";

const [DATA, UNAVAILABLE, USAGE] = [65, 69, 64];

function fail(code, message) {
  fs.writeSync(2, `${message}\n`);
  process.exit(code);
}

if (process.argv.length !== 3) fail(USAGE, "usage: node import.mjs FILE >site.glb");
for (const talk of ["log", "info", "warn", "error", "debug"]) console[talk] = () => {};  // standard output is the GLB's

let ifc;
try {
  ifc = createRequire(import.meta.url)("web-ifc");
} catch {
  fail(UNAVAILABLE, `IFC is read by web-ifc, which is not installed; run npm ci in ${fileURLToPath(new URL(".", import.meta.url))} (setup.sh --ifc does)`);
}

try {
  const api = new ifc.IfcAPI();
  await api.Init();
  api.SetLogLevel(ifc.LogLevel.LOG_LEVEL_OFF);
  const model = api.OpenModel(fs.readFileSync(process.argv[2]), { COORDINATE_TO_ORIGIN: false });
  if (model < 0) throw new Error("its schema is not known; IFC 2x3 and IFC 4 are read");
  const glb = new Building(ifc, api, model).toGlb();
  for (let at = 0; at < glb.length;) at += fs.writeSync(1, glb, at);
} catch (error) {
  fail(DATA, `it cannot be read as IFC: ${error?.message ?? "web-ifc gives it up, as too large or damaged"}`.split("\n")[0]);
}
process.exit(0);
