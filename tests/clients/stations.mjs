// SPDX-License-Identifier: Apache-2.0
// Stations as a crew gets them: GeoJSON and KML by other readers, with the coordinates that PROJ's own cs2cs finds; the
// drawing by a reader of DXF. All to 0.1 mm.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import fs from 'node:fs';
import DxfParser from 'dxf-parser';
import { XMLParser, XMLValidator } from 'fast-xml-parser';

import { moved } from './glb.mjs';
import { at, read, vantage } from './vantage.mjs';

const tenthOfMillimetre = 1e-4, inDegrees = 9e-10;
const same = (a, b, tolerance, what) => assert.ok(Math.abs(a - b) <= tolerance, `${what}: ${a} and ${b}`);
const samePoint = (p, q, what) => ['x', 'y', 'z'].forEach((axis, k) => same(p[axis] ?? 0, q[k], tenthOfMillimetre, what));

// Longitude and latitude of points of an EPSG code. cs2cs wants coordinates in the code's own order.
const northFirst = [31467];
function cs2cs(code, points) {
  const ordered = ([x, y]) => (northFirst.includes(code) ? [y, x] : [x, y]);
  const input = points.map((p) => ordered(p).map((v) => v.toFixed(6)).join(' ') + ' 0\n').join('');
  const done = spawnSync('cs2cs', ['-f', '%.12f', `EPSG:${code}`, 'EPSG:4326'], { input, encoding: 'utf8' });
  if (done.error) throw new Error(`cs2cs cannot be run: ${done.error.message} (Debian: proj-bin)`);
  assert.equal(done.status, 0, done.stderr);
  return done.stdout.trim().split('\n').map((line) => line.trim().split(/\s+/).map(Number)).map(([lat, lon]) => [lon, lat]);
}

function checkMap(geojson, kml, code, stations) {
  const collection = JSON.parse(geojson);
  assert.equal(collection.type, 'FeatureCollection');
  assert.deepEqual(collection.features.map((f) => f.properties.name), stations.map((s) => s.name));
  assert.equal(XMLValidator.validate(kml), true);
  const parser = new XMLParser({ parseTagValue: false, isArray: (name) => name === 'Placemark' });
  const placemarks = new Map(parser.parse(kml).kml.Document.Placemark.map((p) => [p.name, p.Point.coordinates]));
  const placed = stations.filter((s) => s.ground);
  assert.equal(placemarks.size, placed.length);
  const expected = cs2cs(code, placed.map((s) => s.ground));
  placed.forEach((s, k) => {
    const feature = collection.features.find((f) => f.properties.name === s.name);
    const inKml = placemarks.get(s.name).split(',').map(Number);
    for (const [lon, lat, z] of [feature.geometry.coordinates, inKml]) {
      same(lon, expected[k][0], inDegrees / Math.cos((lat * Math.PI) / 180), `longitude of ${s.name}`);
      same(lat, expected[k][1], inDegrees, `latitude of ${s.name}`);
      same(z, s.ground[2], tenthOfMillimetre, `height of ${s.name}`);
    }
    samePoint(feature.properties, s.position, `head of ${s.name}`);
    assert.equal(feature.properties.status, s.status);
  });
  collection.features.filter((f) => !f.geometry).forEach((f) => assert.equal(f.properties.status, 'hole'));
}

const ringArea = (ring) =>
  ring.reduce((sum, p, k) => {
    const q = ring[(k + 1) % ring.length], o = ring[0];
    return sum + ((p.x - o.x) * (q.y - o.y) - (q.x - o.x) * (p.y - o.y)) / 2;
  }, 0);

function checkDrawing(dxf, stations, links) {
  const { entities, tables } = new DxfParser().parseSync(dxf);
  const layers = Object.keys(tables.layer.layers);
  entities.forEach((e) => assert.ok(layers.includes(e.layer), `the layer ${e.layer} is in no table`));
  const of = (type) => entities.filter((e) => e.type === type);
  const placed = stations.filter((s) => s.ground);
  assert.equal(of('POINT').length, placed.length);
  placed.forEach((s, k) => {
    samePoint(of('POINT')[k].position, s.ground, s.name);
    samePoint(of('CIRCLE')[k].center, s.ground, s.name);
    assert.equal(of('TEXT')[k].text, s.name);
    const leftOut = ['clash', 'inside'].includes(s.status);
    assert.equal(of('POINT')[k].layer, leftOut ? 'STATIONS_LEFT_OUT' : 'STATIONS');
  });
  assert.equal(of('LINE').length, links.length);
  of('LINE').forEach((line, k) => {
    samePoint(line.vertices[0], links[k][0].ground, 'link');
    samePoint(line.vertices[1], links[k][1].ground, 'link');
  });
  const rings = of('POLYLINE');
  assert.ok(rings.length > 0);
  rings.forEach((ring) => assert.ok(ring.shape && ring.is3dPolyline && ring.vertices.length >= 3));
  return rings.map((ring) => ringArea(ring.vertices));
}

vantage('generate', 'four-walls', '-o', 'walls.glb');
for (const [code, place] of [[31467, [3_550_000.5, 5_400_000.25, 480]], [25832, [691_600.25, 5_334_760.5, 519.125]],
                             [32733, [261_878, 6_243_186, 12]]]) {
  fs.writeFileSync(at('site.glb'), moved(read('walls.glb'), place));
  const at3 = (...p) => p.map((v, k) => v + place[k]).join(',');
  const files = ['stations.geojson', 'stations.kml', 'stations.dxf'];
  // The third stands at a wall; the last has no ground.
  const out = vantage('evaluate', 'site.glb', '--station', at3(8, 0, 1.5), '--station', at3(8, 3, 1.5), '--station',
                      at3(5.3, 0, 1.5), '--station', 'u=5,v=5', '--engine', 'embree', '--step', '1', '--crs',
                      `EPSG:${code}`, '--json', ...files.flatMap((file) => ['--write-stations', file]));
  const { stations, scan_overlap_matrix: overlap } = JSON.parse(out);
  assert.equal(stations.length, 4);
  assert.equal(stations.filter((s) => !s.ground).length, 1);
  checkMap(read('stations.geojson').toString(), read('stations.kml').toString(), code, stations);
  const links = [];
  stations.forEach((a, i) =>
    stations.forEach((b, j) => {
      if (i < j && overlap[i][j] >= 0.3) links.push([a, b]);
    }));
  assert.ok(links.length > 0);
  const areas = checkDrawing(read('stations.dxf').toString(), stations, links);
  console.log(`EPSG:${code}: ${stations.length} stations, ${links.length} links, outlines of ${areas.map((a) => a.toFixed(2))} m²`);
}

// A plan's folder has them as well.
vantage('plan', 'site.glb', '--problem', 'coverage-overlap-fix', '--stations', '3', '--population', '6', '--iterations', '2',
        '--step', '2', '--engine', 'embree', '--crs', 'EPSG:32733', '-o', 'plan');
const header = read('plan/stations.csv').toString().split('\n')[0].split(',');
const planned = read('plan/stations.csv').toString().trim().split('\n').slice(1).map((line) => {
  const cell = Object.fromEntries(line.split(',').map((value, k) => [header[k], value]));
  const [x, y, z, ground] = ['x', 'y', 'z', 'ground_z'].map((name) => Number(cell[name]));
  return { name: cell.name, status: cell.status, position: [x, y, z], ground: [x, y, ground] };
});
assert.equal(planned.length, 3);
checkMap(read('plan/stations.geojson').toString(), read('plan/stations.kml').toString(), 32733, planned);
const matrix = read('plan/overlap.csv').toString().trim().split('\n').slice(1).map((line) => line.split(',').slice(1).map(Number));
checkDrawing(read('plan/stations.dxf').toString(), planned,
             [[0, 1], [0, 2], [1, 2]].filter(([i, j]) => matrix[i][j] >= 0.01).map(([i, j]) => [planned[i], planned[j]]));
