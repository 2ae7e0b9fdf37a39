// SPDX-License-Identifier: Apache-2.0
// Packages of npm read what vantage writes: node readers.mjs PROGRAM, after `npm ci` in this folder. three.js reads PLY and
// GLB, and proj4 the coordinate system of a LAS. Prints lines of the table of docs/formats.md.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import proj4 from 'proj4';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { PLYLoader } from 'three/examples/jsm/loaders/PLYLoader.js';

const program = path.resolve(process.argv[2]);
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'vantage-readers-'));
process.on('exit', () => fs.rmSync(folder, { recursive: true, force: true }));
const bytes = (name) => fs.readFileSync(path.join(folder, name));
const whole = (name) => { const b = bytes(name); return b.buffer.slice(b.byteOffset, b.byteOffset + b.length); };
function vantage(...args) {
  const done = spawnSync(program, args, { cwd: folder, encoding: 'utf8', maxBuffer: 1 << 26 });
  assert.equal(done.status, 0, done.stderr);
  return done.stdout;
}
globalThis.self ??= globalThis;

vantage('generate', 'four-walls', '-o', 'walls.glb');
const scan = (...rest) => vantage('scan', 'walls.glb', '--station', '5.6,2,1.7', '--step', '0.8', '--engine', 'embree', ...rest);

// The number of points is the one that the scan tells, and each lies within its range of the station.
const said = scan('--outputs', 'colour', '-o', 'points.ply');
const { attributes } = new PLYLoader().parse(whole('points.ply'));
assert.equal(attributes.position.count, Number(said.match(/: (\d+) points/)[1]));
assert.equal(attributes.color.count, attributes.position.count);
const farthest = Math.max(...Array.from({ length: attributes.position.count }, (_, k) =>
  Math.hypot(attributes.position.getX(k) - 5.6, attributes.position.getY(k) - 2, attributes.position.getZ(k) - 1.7)));
assert.ok(farthest > 2 && farthest < 20, `${farthest} m`);
console.log(`| PLY | three.js 0.180 PLYLoader | ${attributes.position.count} points |`);

let triangles = 0;
const { scene } = await new GLTFLoader().parseAsync(whole('walls.glb'), '');
scene.traverse(({ geometry }) => { triangles += geometry ? geometry.index.count / 3 : 0; });
const glb = bytes('walls.glb'), json = JSON.parse(glb.subarray(20, 20 + glb.readUInt32LE(12)));
assert.equal(triangles, json.meshes.flatMap(({ primitives }) => primitives).reduce((sum, { indices }) => sum + json.accessors[indices].count / 3, 0));
console.log(`| GLB | three.js 0.180 GLTFLoader | ${triangles} triangles |`);

// The text of a LAS's system, in its record 2112.
function system(...crs) {
  scan(...crs, '-o', 'points.las');
  const las = bytes('points.las'), records = las.readUInt32LE(100);
  for (let k = 0, at = las.readUInt16LE(94); k < records; ++k) {
    const size = las.readUInt16LE(at + 20);
    if (las.readUInt16LE(at + 18) === 2112) return las.toString('latin1', at + 54, at + 54 + size).replace(/\0+$/, '');
    at += 54 + size;
  }
  assert.fail('no system');
}
const place = proj4(system('--crs', 'EPSG:25832'), 'WGS84', [500_000, 5_400_000]);
[9, 48.7530].forEach((wanted, k) => assert.ok(Math.abs(place[k] - wanted) < 1e-3, `${place}`));
console.log('| LAS | proj4 2.22.0, system in plan | right |');
const compound = system('--crs', 'EPSG:25832+7837');
assert.match(compound, /^COMPD_CS/);
assert.throws(() => proj4(compound, 'WGS84', [500_000, 5_400_000]), 'proj4 reads COMPD_CS now: docs/formats.md and findings say otherwise');
console.log('| LAS | proj4 2.22.0, system with heights | an error, as docs/formats.md says |');
