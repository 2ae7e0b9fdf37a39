#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# loaders.gl 4.5.1 and LAS 1.2 at national coordinates, with a point that is marked as withheld.
# Guess before it was run: places keep their millimetres, and a withheld point of a building is of class 6.
# Seen: by default places and the header's box are floats, half a metre apart at a northing of 5 400 000 m; the class is the
# whole byte with its flags, 134 for 6.
# What vantage does: places are doubles from a local origin, and withheld points are left out.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init -y >/dev/null
npm install --silent --no-audit --no-fund --legacy-peer-deps @loaders.gl/core@4.5.4 @loaders.gl/las@4.5.1 >/dev/null
cat >read.mjs <<'JS'
import { parse } from "@loaders.gl/core";
import { LASLoader } from "@loaders.gl/las";
const points = [[500000.025, 5400000.225, 300.5], [500001.026, 5400001.027, 301.25]];
const origin = [500000, 5400000, 0], headerSize = 227, recordSize = 28;
const file = Buffer.alloc(headerSize + points.length * recordSize);
file.write("LASF", 0);
file.writeUInt8(1, 24), file.writeUInt8(2, 25);  // version
file.writeUInt16LE(1, 90), file.writeUInt16LE(2026, 92), file.writeUInt16LE(headerSize, 94), file.writeUInt32LE(headerSize, 96);
file.writeUInt8(1, 104), file.writeUInt16LE(recordSize, 105);
file.writeUInt32LE(points.length, 107), file.writeUInt32LE(points.length, 111);
for (let axis = 0; axis < 3; axis++) {
  file.writeDoubleLE(0.001, 131 + 8 * axis), file.writeDoubleLE(origin[axis], 155 + 8 * axis);
  file.writeDoubleLE(points[1][axis], 179 + 16 * axis), file.writeDoubleLE(points[0][axis], 187 + 16 * axis);
}
points.forEach((point, k) => {
  const at = headerSize + k * recordSize;
  point.forEach((value, axis) => file.writeInt32LE(Math.round((value - origin[axis]) / 0.001), at + 4 * axis));
  file.writeUInt8(0x09, at + 14);            // the first return of one
  file.writeUInt8(k ? 0x80 | 6 : 6, at + 15);  // a building; the second is withheld
});
const cloud = await parse(new Uint8Array(file).buffer, LASLoader, { worker: false });
const places = [...cloud.attributes.POSITION.value], classes = [...cloud.attributes.classification.value];
console.log(`northings ${points.map((point) => point[1])} are read as ${places[1]},${places[4]} of ${cloud.attributes.POSITION.value.constructor.name}`);
console.log(`classes 6,6 are read as ${classes}`);
process.exit(places[1] === Math.fround(points[0][1]) && places[4] === Math.fround(points[1][1]) && classes.join() === "6,134" ? 0 : 1);
JS
node read.mjs
