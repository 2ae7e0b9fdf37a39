#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# three 0.187.0 and loaders.gl 4.4.5, which pages show models with: does a PLY keep faces of five corners and more?
# Guess before it was run: a pentagon is three triangles.
# Seen: it is left out without a word; the triangle and the square beside it stay. CloudCompare 2.11.3 (Debian 12) leaves
# it out, too, and says that the mesh is not triangular.
# What vantage does: polygons of any number of corners are cut into triangles.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init -y >/dev/null
npm install --silent --no-audit --no-fund --legacy-peer-deps three@0.187.0 @loaders.gl/core@4.5.4 @loaders.gl/ply@4.4.5 >/dev/null
cat >faces.ply <<'PLY'
ply
format ascii 1.0
element vertex 12
property float x
property float y
property float z
element face 3
property list uchar int vertex_indices
end_header
0 0 0
2 0 0
0 2 0
10 0 0
12 0 0
12 2 0
10 2 0
20 0 0
24 0 0
25 3 0
22 5 0
19 3 0
3 0 1 2
4 3 4 5 6
5 7 8 9 10 11
PLY
cat >areas.mjs <<'JS'
// Areas of the triangles that each loader makes of the faces' 2, 4 and 21 m2, by where they stand.
import { readFileSync } from "node:fs";
import { PLYLoader } from "three/examples/jsm/loaders/PLYLoader.js";
import { parse } from "@loaders.gl/core";
import { PLYLoader as OfLoadersGl } from "@loaders.gl/ply";
function areas(positions, indices) {
  const sums = [0, 0, 0];
  for (let k = 0; k < indices.length; k += 3) {
    const [a, b, c] = [0, 1, 2].map((j) => [0, 1].map((axis) => positions[3 * indices[k + j] + axis]));
    const twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    sums[Math.floor((a[0] + b[0] + c[0]) / 3 / 9)] += twice / 2;
  }
  return sums.join(" ");
}
const given = new Uint8Array(readFileSync("faces.ply")).buffer;
const three = new PLYLoader().parse(given);
const loaders = await parse(given, OfLoadersGl, { worker: false });
const seen = {
  three: areas(three.attributes.position.array, three.index.array),
  "loaders.gl": areas(loaders.attributes.POSITION.value, loaders.indices.value),
};
for (const [name, sums] of Object.entries(seen)) console.log(`${name}: areas of triangle, square, pentagon ${sums} m2 (2 4 21 are given)`);
process.exit(Object.values(seen).every((sums) => sums === "2 4 0") ? 0 : 1);
JS
node areas.mjs
