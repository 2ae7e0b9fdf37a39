// SPDX-License-Identifier: Apache-2.0
// node pcl.mjs PROGRAM: PLY as the Point Cloud Library reads it (Debian: pcl-tools), which writes what it read as text.
import assert from 'node:assert/strict';

import { readPly } from './ply.mjs';
import { read, run, vantage } from './vantage.mjs';

vantage('generate', 'four-walls', '-o', 'walls.glb');
vantage('scan', 'walls.glb', '--station', '2.5,2,1.85', '--station', '3.25,2.5,1.7', '--step', '0.8', '--engine', 'embree', '--outputs',
        'range,normal,reflectivity,ids,colour', '-o', 'points.ply');
run('pcl_ply2pcd', ['-format', '0', 'points.ply', 'points.pcd']);
const ply = readPly(read('points.ply'));
const lines = read('points.pcd').toString().trim().split('\n');
const data = lines.findIndex((line) => line.startsWith('DATA'));
const names = lines.find((line) => line.startsWith('FIELDS')).split(' ').slice(1);
const rows = lines.slice(data + 1).map((line) => line.split(' ').map(Number));
assert.ok(rows.length > 1000);
assert.equal(rows.length, ply.x.length);
// It writes eight digits.
for (const [name, ours] of [['x', 'x'], ['y', 'y'], ['z', 'z'], ['normal_x', 'nx'], ['normal_y', 'ny'], ['normal_z', 'nz'], ['reflectivity', 'reflectivity'],
                            ['range', 'range'], ['mesh', 'mesh'], ['primitive', 'primitive'], ['station', 'station']]) {
  const column = names.indexOf(name);
  assert.ok(column >= 0, `no ${name} among ${names}`);
  rows.forEach((row, k) => assert.ok(Math.abs(row[column] - ply[ours][k]) <= 1e-7 * Math.max(1, Math.abs(ply[ours][k])), `${name} of point ${k}: ${row[column]} and ${ply[ours][k]}`));
}
const colours = names.indexOf('rgb');
rows.forEach((row, k) => assert.equal(row[colours], (ply.red[k] << 16) | (ply.green[k] << 8) | ply.blue[k], `colour of point ${k}`));
console.log(`${rows.length} points with ${names.join(' ')}`);
