// SPDX-License-Identifier: Apache-2.0
// GDAL, which most programs for maps read with, finds the same stations in GeoJSON, KML and DXF.
import assert from 'node:assert/strict';
import fs from 'node:fs';

import { moved } from './glb.mjs';
import { at, read, run, vantage } from './vantage.mjs';

const place = [691_600.25, 5_334_760.5, 519.125];
vantage('generate', 'four-walls', '-o', 'walls.glb');
fs.writeFileSync(at('site.glb'), moved(read('walls.glb'), place));
fs.writeFileSync(at('stations.csv'), ['x,y,z,name', ...[[8, 0, 'Gate <K1> & "ü"'], [8, 3, 'P 2'], [5.3, 0, 'at the wall']].map(
  ([x, y, name]) => `${x + place[0]},${y + place[1]},${1.5 + place[2]},"${name.replaceAll('"', '""')}"`)].join('\n'));
const files = ['o.geojson', 'o.kml', 'o.dxf'];
const { stations } = JSON.parse(vantage('evaluate', 'site.glb', '--stations', 'stations.csv', '--engine', 'embree', '--step', '1', '--crs', 'EPSG:25832', '--json',
                                        ...files.flatMap((file) => ['--write-stations', file])));
assert.equal(stations.length, 3);

// Features as GDAL reads them, moved to a system by its code.
const features = (file, ...how) => JSON.parse(run('ogr2ogr', ['-f', 'GeoJSON', '-lco', 'COORDINATE_PRECISION=12', '/vsistdout/', file, ...how])).features;
const near = (p, q, what) => q.forEach((v, k) => assert.ok(Math.abs(p[k] - v) <= 2e-4, `${what}: ${p} and ${q}`));

for (const file of ['o.geojson', 'o.kml']) {
  const found = features(file, '-t_srs', 'EPSG:25832', '-lco', 'RFC7946=NO');
  assert.deepEqual(found.map((f) => f.properties.name ?? f.properties.Name), stations.map((s) => s.name));
  found.forEach((f, k) => near(f.geometry.coordinates, stations[k].ground, `${stations[k].name} in ${file}`));
}
const drawn = features('o.dxf');
const of = (kind, layer) => drawn.filter((f) => f.geometry?.type === kind && f.properties.Layer.startsWith(layer));
const texts = drawn.filter((f) => f.properties.Text);
const unescaped = (text) => text.replace(/\\U\+([0-9A-F]{4})/g, (_, code) => String.fromCharCode(parseInt(code, 16)));
assert.deepEqual(texts.map((f) => unescaped(f.properties.Text)), stations.map((s) => s.name));
const marks = of('Point', 'STATIONS');
assert.equal(marks.length, stations.length);
marks.forEach((f, k) => near(f.geometry.coordinates, stations[k].ground, `${stations[k].name} in the drawing`));
assert.ok(drawn.some((f) => ['LineString', 'Polygon'].includes(f.geometry?.type) && f.properties.Layer.includes('AREA')), 'the search area is drawn');
console.log(`${stations.length} stations, ${drawn.length} parts of the drawing`);
