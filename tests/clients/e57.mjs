// SPDX-License-Identifier: Apache-2.0
// E57 files as another reader sees them: its points, with poses applied, are those of our PLY to 0.1 mm.
import assert from 'node:assert/strict';
import { XMLParser, XMLValidator } from 'fast-xml-parser';
import { convertE57 } from 'web-e57';

import { readPly } from './ply.mjs';
import { at, read, vantage } from './vantage.mjs';

const parser = new XMLParser({ ignoreAttributes: false, isArray: (name) => name === 'vectorChild' });
const text = (node) => (typeof node === 'object' ? node['#text'] : node);

vantage('generate', 'four-walls', '-o', 'walls.glb');
// The last looks into nothing: its scan is empty.
const heads = [[2.5, 2, 1.85], [3.25, 2.5, 1.7], [500, 500, 500]];
const stations = heads.flatMap((head) => ['--station', head.join(',')]);
for (const [heading, noise] of [['0', 'off'], ['217.25', 'rtc360']]) {
  const scan = ['scan', 'walls.glb', ...stations, '--step', '0.8', '--heading', heading, '--noise', noise, '--engine',
                'embree', '--outputs', 'colour,normal'];  // intensity comes unasked
  vantage(...scan, '-o', 'points.ply');
  vantage(...scan, '-o', 'points.e57');
  vantage(...scan, '-o', 'again.e57');
  assert.ok(read('points.e57').equals(read('again.e57')), 'equal runs give equal files');

  const ply = readPly(read('points.ply'));
  const bytes = new Uint8Array(read('points.e57'));
  const lines = convertE57(bytes, 'XYZ').trim().split('\n');
  assert.ok(ply.x.length > 1000);
  assert.equal(lines.length, ply.x.length);
  let worst = 0;
  lines.forEach((line, k) => {
    const [x, y, z, ...colour] = line.split(' ').map(Number);
    worst = Math.max(worst, Math.hypot(x - ply.x[k], y - ply.y[k], z - ply.z[k]));
    // The reader keeps channels as singles from 0 to 1 and cuts, so that it may be one lower.
    [ply.red[k], ply.green[k], ply.blue[k]].forEach((channel, c) => assert.ok(Math.abs(channel - colour[c]) <= 1));
  });
  assert.ok(worst < 1e-4, `${worst} m apart`);
  console.log(`heading ${heading}: ${lines.length} points, at most ${worst.toExponential(1)} m from the PLY's`);

  const xml = convertE57(bytes, 'XML');
  assert.equal(XMLValidator.validate(xml), true);
  const scans = parser.parse(xml).e57Root.data3D.vectorChild;
  assert.deepEqual(scans.map((s) => text(s.name)), ['S1', 'S2', 'S3']);
  assert.equal(new Set(scans.map((s) => text(s.guid))).size, 3);
  scans.forEach((s, k) => {
    const { translation, rotation } = s.pose;
    assert.deepEqual(['x', 'y', 'z'].map((axis) => text(translation[axis])), heads[k]);
    const turn = 2 * Math.atan2(text(rotation.z), text(rotation.w));
    assert.ok(Math.abs(Math.sin((turn - (Number(heading) * Math.PI) / 180) / 2)) < 1e-12);
    const records = ply.station.filter((station) => station === ply.station[0] + k).length;
    assert.equal(Number(s.points['@_recordCount']), records);
    assert.equal('cartesianBounds' in s, records > 0);
    assert.ok(['rowIndex', 'columnIndex', 'intensity', 'nor:normalX'].every((name) => name in s.points.prototype));
  });
  assert.equal(Number(scans[2].points['@_recordCount']), 0);
}
