// SPDX-License-Identifier: Apache-2.0
// LAS files as another reader sees them: its points are those of our PLY to 0.1 mm, and GDAL knows the coordinate system.
import assert from 'node:assert/strict';
import { Las } from 'copc';

import { readPly } from './ply.mjs';
import { at, read, run, vantage } from './vantage.mjs';

vantage('generate', 'four-walls', '-o', 'walls.glb');
const scan = ['scan', 'walls.glb', '--station', '2.5,2,1.85', '--station', '3.25,2.5,1.7', '--step', '0.8', '--engine', 'embree'];
vantage(...scan, '--outputs', 'reflectivity,colour', '--ply-doubles', '-o', 'points.ply');
const ply = readPly(read('points.ply'));
assert.ok(ply.x.length > 1000);

for (const [crs, named] of [[[], 'LOCAL_CS["survey frame"'], [['--crs', 'EPSG:25832'], 'PROJCS["ETRS89 / UTM zone 32N"']]) {
  // The intensity is there though nobody asked for it.
  vantage(...scan, ...crs, '--outputs', 'colour', '-o', 'points.las');
  const bytes = read('points.las');
  const header = Las.Header.parse(bytes);
  assert.deepEqual([header.minorVersion, header.pointDataRecordFormat, header.pointCount], [4, 7, ply.x.length]);
  assert.equal(header.globalEncoding & 16, 16, 'formats from 6 on have their system as well-known text');
  const vlrs = await Las.Vlr.walk(at('points.las'), header);
  const text = Buffer.from(await Las.Vlr.fetch(at('points.las'), Las.Vlr.at(vlrs, 'LASF_Projection', 2112))).toString();
  assert.equal(text.indexOf('\0'), text.length - 1);
  const system = text.slice(0, -1);
  assert.ok(system.startsWith(named), system);
  const said = run('gdalsrsinfo', ['-V', '-o', 'wkt1', system]);
  assert.match(said, /Validate Succeeds/);
  assert.ok(said.includes(named), said);
  const view = Las.View.create(bytes.subarray(header.pointDataOffset), header);
  assert.equal(view.pointCount, ply.x.length);
  const get = Object.fromEntries(['X', 'Y', 'Z', 'Intensity', 'Red', 'Green', 'Blue', 'PointSourceId', 'ReturnNumber'].map((name) => [name, view.getter(name)]));
  for (let k = 0; k < view.pointCount; ++k) {
    for (const axis of ['x', 'y', 'z']) assert.ok(Math.abs(get[axis.toUpperCase()](k) - ply[axis][k]) <= 0.5001e-4, `${axis} of point ${k}`);
    assert.deepEqual([get.Red(k), get.Green(k), get.Blue(k)], [ply.red[k], ply.green[k], ply.blue[k]].map((channel) => channel * 257));
    assert.equal(get.Intensity(k), Math.round(ply.reflectivity[k] * 65535));
    assert.deepEqual([get.PointSourceId(k), get.ReturnNumber(k)], [ply.station[k], 1]);
  }
  console.log(`${view.pointCount} points, ${system.slice(0, 40)}…`);
}
