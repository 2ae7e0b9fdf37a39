// SPDX-License-Identifier: Apache-2.0
// node cloudcompare.mjs PROGRAM: PLY as CloudCompare and Open3D read it (Debian: cloudcompare, python3-open3d), which write
// what they read as text: places, at national coordinates too, and colours.
import assert from 'node:assert/strict';
import fs from 'node:fs';

import { moved } from './glb.mjs';
import { readPly } from './ply.mjs';
import { at, read, run, vantage } from './vantage.mjs';

process.env.QT_QPA_PLATFORM = 'offscreen';
const rows = (name) => read(name).toString().trim().split('\n').map((line) => line.trim().split(/\s+/).map(Number));

vantage('generate', 'four-walls', '-o', 'walls.glb');
const place = [412345, 5698765, 112];
fs.writeFileSync(at('far.glb'), moved(read('walls.glb'), place));
for (const [site, [east, north, up]] of [['walls.glb', [0, 0, 0]], ['far.glb', place]])
  for (const doubles of [[], ['--ply-doubles']]) {
    vantage('scan', site, '--station', [east + 5.6, north + 2, up + 1.7].join(','), '--step', '0.8', '--engine', 'embree', '--outputs', 'colour,reflectivity',
            ...doubles, '-o', 'points.ply');
    const ply = readPly(read('points.ply')), count = ply.x.length;
    assert.ok(count > 1000);
    const same = (who, found, colour) => {
      assert.equal(found.length, count, who);
      found.forEach((row, k) => {
        ['x', 'y', 'z'].forEach((axis, c) => assert.ok(Math.abs(row[c] - ply[axis][k]) <= 1e-4, `${who}: ${axis} of point ${k}: ${row[c]} and ${ply[axis][k]}`));
        ['red', 'green', 'blue'].forEach((channel, c) => assert.ok(Math.abs(colour(row[3 + c]) - ply[channel][k]) <= 1, `${who}: ${channel} of point ${k}`));
      });
    };
    run('CloudCompare', ['-SILENT', '-NO_TIMESTAMP', '-AUTO_SAVE', 'OFF', '-C_EXPORT_FMT', 'ASC', '-PREC', '6', '-O', '-GLOBAL_SHIFT', 'AUTO', 'points.ply', '-SAVE_CLOUDS']);
    same('CloudCompare', rows('points.asc'), (v) => v);
    run('/usr/bin/python3', ['-c', 'import open3d; open3d.io.write_point_cloud("points.xyzrgb", open3d.io.read_point_cloud("points.ply"))']);
    same('Open3D', rows('points.xyzrgb'), (v) => 255 * v);
    console.log(`${site} ${doubles}: ${count} points`);
  }
