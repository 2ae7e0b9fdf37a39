// SPDX-License-Identifier: Apache-2.0
// node points.mjs PROGRAM THREE_JS LOADER_JS: PLY as three.js reads it, whose floats hold no national coordinates. Ours are about an origin.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import vm from 'node:vm';

import { moved } from './glb.mjs';
import { readPly } from './ply.mjs';
import { at, read, vantage } from './vantage.mjs';

const [three, loader] = process.argv.slice(3);
for (const file of [three, loader]) vm.runInThisContext(fs.readFileSync(file, 'utf8'), file);

const place = [412345, 5698765, 112];
vantage('generate', 'four-walls', '-o', 'walls.glb');
fs.writeFileSync(at('far.glb'), moved(read('walls.glb'), place));
for (const [site, [east, north, up], origin] of [['walls.glb', [0, 0, 0], [0, 0, 0]], ['far.glb', place, [412000, 5699000, 0]]]) {
  const scan = ['scan', site, '--station', [east + 2.5, north + 2, up + 1.85].join(','), '--step', '0.8', '--engine', 'embree', '--outputs',
                'range,normal,reflectivity,ids,colour'];
  vantage(...scan, '-o', 'points.ply');
  vantage(...scan, '--ply-doubles', '-o', 'doubles.ply');
  const bytes = read('points.ply'), ply = readPly(bytes), doubles = readPly(read('doubles.ply'));
  const told = bytes.toString('latin1').match(/\ncomment origin (.*)\n/)[1];
  assert.deepEqual(told.split(' ').map(Number), origin);
  const { attributes } = new globalThis.THREE.PLYLoader().parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
  assert.ok(ply.x.length > 1000);
  const same = (attribute, columns, tolerance, scale = 1) => {
    assert.ok(attribute.array instanceof Float32Array);
    assert.equal(attribute.count, ply.x.length);
    columns.forEach((column, c) => column.forEach((value, k) => assert.ok(Math.abs(attribute.array[3 * k + c] - value / scale) <= tolerance, `${attribute.array[3 * k + c]} and ${value}`)));
  };
  same(attributes.position, [doubles.x, doubles.y, doubles.z].map((column, c) => column.map((value) => value - origin[c])), 3.1e-5);
  same(attributes.normal, [ply.nx, ply.ny, ply.nz], 1e-7);
  same(attributes.color, [ply.red, ply.green, ply.blue], 1e-6, 255);
  console.log(`${ply.x.length} points about ${told}`);
}
