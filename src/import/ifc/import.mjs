// SPDX-License-Identifier: Apache-2.0
// node import.mjs [unit=m|cm|mm|in|ft] FILE...: writes IFC models of one site to standard output, as GLB. Exit codes of
// sysexits.h: 65 if a model is at fault, 69 if web-ifc is not installed, each with a line that says so.
import fs from "node:fs";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";
import v8 from "node:v8";
import { convert } from "./convert.mjs";
import { Question } from "./model.mjs";

const [DATA, UNAVAILABLE, USAGE] = [65, 69, 64];

function fail(code, message) {
  fs.writeSync(2, `${message}\n`);
  process.exit(code);
}

const settings = process.argv.slice(2).filter((word) => word.startsWith("unit="));
const files = process.argv.slice(2 + settings.length);
if (files.length === 0) fail(USAGE, "usage: node import.mjs [unit=UNIT] FILE... >site.glb");
// Delays optimisation of WebAssembly: most models are read sooner than web-ifc would be compiled again. For the same
// reason functions are optimised on their own, and little is inlined.
v8.setFlagsFromString("--wasm-tiering-budget=500000000");
v8.setFlagsFromString("--max-inlined-bytecode-size-cumulative=200");
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
  const glb = convert(ifc, api, files, settings.at(-1)?.slice("unit=".length));
  for (let at = 0; at < glb.length;) at += fs.writeSync(1, glb, at);
} catch (error) {
  const message = error instanceof Question ? error.message : `it cannot be read as IFC: ${error?.message ?? "web-ifc gives it up, as too large or damaged"}`;
  fail(DATA, message.split("\n")[0]);
}
process.exit(0);
