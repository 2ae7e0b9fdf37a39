// SPDX-License-Identifier: Apache-2.0
// node points.mjs PROGRAM THREE_JS LOADER_JS: PLY as three.js reads it, with singles for our doubles.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import vm from 'node:vm';

import { readPly } from './ply.mjs';
import { read, vantage } from './vantage.mjs';

const [three, loader] = process.argv.slice(3);
for (const file of [three, loader]) vm.runInThisContext(fs.readFileSync(file, 'utf8'), file);

vantage('generate', 'four-walls', '-o', 'walls.glb');
vantage('scan', 'walls.glb', '--station', '2.5,2,1.85', '--step', '0.8', '--engine', 'embree', '--outputs', 'range,normal,reflectivity,ids,colour', '-o', 'points.ply');
const bytes = read('points.ply'), ply = readPly(bytes);
const { attributes } = new globalThis.THREE.PLYLoader().parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
assert.ok(ply.x.length > 1000);
const same = (attribute, columns, tolerance, scale = 1) => {
  assert.equal(attribute.count, ply.x.length);
  columns.forEach((column, c) => column.forEach((value, k) => assert.ok(Math.abs(attribute.array[3 * k + c] - value / scale) <= tolerance, `${attribute.array[3 * k + c]} and ${value}`)));
};
same(attributes.position, [ply.x, ply.y, ply.z], 1e-6);
same(attributes.normal, [ply.nx, ply.ny, ply.nz], 1e-7);
same(attributes.color, [ply.red, ply.green, ply.blue], 1e-6, 255);
console.log(`${ply.x.length} points`);
