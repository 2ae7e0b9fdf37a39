#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# loaders.gl 4.4.2 and PCD: coordinates of type double, and a field of several numbers (COUNT 3) before x, y and z.
# Guess before it was run: both are read, as PCL reads them; doubles become floats.
# Seen: of doubles, the first half of their bytes is taken for a float, so that 500000.025 is 1.6e-23. In binary data COUNT
# is kept, in text it is not: y, z and the next column are taken for the place.
# What vantage does: SIZE, TYPE and COUNT of every field hold, in text and binary.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init -y >/dev/null
npm install --silent --no-audit --no-fund --legacy-peer-deps @loaders.gl/core@4.5.4 @loaders.gl/pcd@4.4.2 >/dev/null
cat >read.mjs <<'JS'
import { parse } from "@loaders.gl/core";
import { PCDLoader } from "@loaders.gl/pcd";
function header(fields, size, type, count, data) {
  return `# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS ${fields}\nSIZE ${size}\nTYPE ${type}\nCOUNT ${count}\n` +
    `WIDTH 1\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA ${data}\n`;
}
async function place(...parts) {
  const bytes = Buffer.concat(parts.map((part) => Buffer.from(part)));
  const cloud = await parse(new Uint8Array(bytes).buffer, PCDLoader, { worker: false });
  return [...cloud.attributes.POSITION.value].map((value) => Number(value.toPrecision(6))).join(" ");
}
const text = "0.1 0.2 0.9 1 2 3 7";  // a normal, the place, the intensity
const fields = ["normal x y z intensity", "4 4 4 4 4", "F F F F F", "3 1 1 1 1"];
const doubles = await place(header("x y z", "8 8 8", "F F F", "1 1 1", "binary"), new Uint8Array(new Float64Array([500000.025, 5400000.025, 300]).buffer));
const binary = await place(header(...fields, "binary"), new Uint8Array(new Float32Array(text.split(" ").map(Number)).buffer));
const ascii = await place(header(...fields, "ascii"), text + "\n");
console.log(`doubles 500000.025 5400000.025 300 are read as ${doubles}`);
console.log(`place 1 2 3 behind a normal: ${binary} in binary, ${ascii} in text`);
process.exit(doubles.startsWith("1.588") && binary === "1 2 3" && ascii !== "1 2 3" ? 0 : 1);
JS
node read.mjs
