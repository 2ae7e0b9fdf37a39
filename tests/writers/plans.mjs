// SPDX-License-Identifier: Apache-2.0
// Floor plans that programs by others write are read as the plan that these were given: node plans.mjs PROGRAM, after
// `npm ci` in this folder, with GDAL's ogr2ogr. Each writer gets each content. Prints the table of docs/formats.md.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import * as tarikjabiri from '@tarikjabiri/dxf';
import DxfDrawing from 'dxf-writer';

const program = path.resolve(process.argv[2]);
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'vantage-plans-'));
process.on('exit', () => fs.rmSync(folder, { recursive: true, force: true }));
process.env.XDG_CACHE_HOME = path.join(folder, 'cache');

// Walls of 0.2 m around 6 x 4 m, and a partition from (4.4, 0) to (4.5, 4); the door is at (2.8, 0).
const OUTSIDE = [[[2.8, 0], [0, 0], [0, 4], [6, 4], [6, 0], [3.7, 0], [3.7, -0.2]],
  [[2.8, 0], [2.8, -0.2], [-0.2, -0.2], [-0.2, 4.2], [6.2, 4.2], [6.2, -0.2], [3.7, -0.2]]];
const SIDES = [[[4.4, 0], [4.4, 4]], [[4.5, 4], [4.5, 0]]];
const PILLAR = [[1, 1], [1.5, 1], [1.5, 1.5], [1, 1.5]];
const LAYERS = ['A-WALL', 'A-DOOR', 'A-TEXT'];

// Each has drawn lines, millimetres of a unit, a place, and areas of its rooms.
const CONTENTS = {
  plain: { pillar: false, mm: 1000, at: [0, 0], areas: [6, 17.6] },
  'filled pillar, in millimetres': { pillar: true, mm: 1, at: [0, 0], areas: [6, 17.35] },
  far: { pillar: true, mm: 1000, at: [500_000, 5_400_000], areas: [6, 17.35] },
};

const place = ({ mm, at }) => ([x, y]) => [(x + at[0]) * 1000 / mm, (y + at[1]) * 1000 / mm];

function dxfWriter(content) {
  const drawing = new DxfDrawing(), to = place(content), long = (m) => m * 1000 / content.mm;
  drawing.setUnits(content.mm === 1 ? 'Millimeters' : 'Meters');
  for (const layer of LAYERS) drawing.addLayer(layer, DxfDrawing.ACI.WHITE, 'CONTINUOUS');
  drawing.setActiveLayer('A-WALL');
  for (const line of OUTSIDE) drawing.drawPolyline(line.map(to));
  drawing.drawPolyline3d(SIDES[0].map((p, k) => [...to(p), long(k)]));
  drawing.drawLine(...SIDES[1].flatMap(to));
  if (content.pillar) drawing.drawRect(...to(PILLAR[0]), ...to(PILLAR[2]));
  drawing.setActiveLayer('A-DOOR');
  drawing.drawArc(...to([2.8, 0]), long(0.9), 0, 90);
  drawing.setActiveLayer('A-TEXT');
  drawing.drawText(...to([2, 2]), long(0.2), 0, 'Office');
  return drawing.toDxfString();
}

function tarikjabiriDxf(content) {
  const drawing = new tarikjabiri.DxfWriter(), to = place(content), long = (m) => m * 1000 / content.mm;
  const { point2d, point3d, vertex } = tarikjabiri, at = (p) => point3d(...to(p), 0);
  drawing.setUnits(content.mm === 1 ? tarikjabiri.Units.Millimeters : tarikjabiri.Units.Meters);
  for (const layer of LAYERS) drawing.addLayer(layer, 7, 'Continuous');
  drawing.setCurrentLayerName('A-WALL');
  for (const line of OUTSIDE) drawing.addLWPolyline(line.map((p) => ({ point: point2d(...to(p)) })));
  const block = drawing.addBlock('Part');
  for (const y of [0, 0.1]) block.addLine(point3d(0, long(y), 0), point3d(long(4), long(y), 0));
  drawing.addInsert('Part', at([4.5, 0]), { rotationAngle: 90 });
  if (content.pillar) {
    const ring = new tarikjabiri.HatchPolylineBoundary(), paths = new tarikjabiri.HatchBoundaryPaths();
    for (const p of PILLAR) ring.add(vertex(...to(p)));
    paths.addPolylineBoundary(ring);
    drawing.addHatch(paths, tarikjabiri.pattern({ name: tarikjabiri.HatchPredefinedPatterns.SOLID }));
  }
  drawing.setCurrentLayerName('A-DOOR');
  drawing.addArc(at([2.8, 0]), long(0.9), 0, 90);
  drawing.setCurrentLayerName('A-TEXT');
  drawing.addText(at([2, 2]), long(0.2), 'Office');
  return drawing.stringify();
}

// GDAL's DXF states inches, whatever it was given, so that the unit is asked.
function gdal(content, heights) {
  const to = place(content), source = path.join(folder, 'plan.geojson'), file = path.join(folder, 'gdal.dxf');
  const feature = (Layer, type, coordinates) => ({ type: 'Feature', properties: { Layer }, geometry: { type, coordinates } });
  const line = (points) => points.map((p, k) => [...to(p), ...(heights ? [k] : [])]);
  const features = [...OUTSIDE, ...SIDES].map((points) => feature('A-WALL', 'LineString', line(points)));
  if (content.pillar) features.push(feature('A-WALL', 'Polygon', [line([...PILLAR, PILLAR[0]])]));
  fs.writeFileSync(source, JSON.stringify({ type: 'FeatureCollection', features }));
  const made = spawnSync('ogr2ogr', ['-f', 'DXF', file, source], { encoding: 'utf8' });
  assert.equal(made.status, 0, made.stderr);
  return fs.readFileSync(file, 'utf8');
}

// Areas of the rooms' floors in m², from the least on, and their least x.
function read(text, unit) {
  const file = path.join(folder, 'read.dxf'), out = path.join(folder, 'read.glb');
  fs.rmSync(out, { force: true });
  fs.writeFileSync(file, text);
  const made = spawnSync(program, ['import', file, '-o', out, ...(unit ? ['--unit', unit] : [])], { encoding: 'utf8' });
  if (made.status !== 0) return { asked: made.stderr };
  const glb = fs.readFileSync(out), length = glb.readUInt32LE(12), json = JSON.parse(glb.subarray(20, 20 + length));
  const binary = glb.subarray(28 + length), areas = [];
  let least = Infinity;
  const values = ({ bufferView, byteOffset = 0, count, componentType, type }) => {
    const Type = { 5121: Uint8Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array }[componentType];
    const from = binary.byteOffset + (json.bufferViews[bufferView].byteOffset ?? 0) + byteOffset, size = count * (type === 'VEC3' ? 3 : 1);
    return new Type(binary.buffer.slice(from, from + size * Type.BYTES_PER_ELEMENT));
  };
  const origin = json.nodes.find(({ name }) => name === 'floor plan').translation ?? [0, 0, 0];
  for (const { name, mesh } of json.nodes)
    if (/^floor (?!openings|plan)/.test(name)) {
      const { attributes, indices } = json.meshes[mesh].primitives[0], at = values(json.accessors[attributes.POSITION]);
      const corners = values(json.accessors[indices]);
      let area = 0;
      for (let t = 0; t < corners.length; t += 3) {
        const [[ax, az], [bx, bz], [cx, cz]] = [0, 1, 2].map((k) => [at[3 * corners[t + k]], at[3 * corners[t + k] + 2]]);
        area += Math.abs((bx - ax) * (cz - az) - (bz - az) * (cx - ax)) / 2;
        least = Math.min(least, ax + origin[0], bx + origin[0], cx + origin[0]);
      }
      areas.push(area);
    }
  return { areas: areas.sort((a, b) => a - b), least };
}

function expectPlan(content, { areas, least, asked }) {
  assert.equal(asked, undefined);
  assert.equal(areas.length, content.areas.length, `rooms of ${areas} m²`);
  areas.forEach((area, k) => assert.ok(Math.abs(area - content.areas[k]) < 0.01, `a room of ${area} m² instead of ${content.areas[k]} m²`));
  assert.ok(Math.abs(least - content.at[0]) < 0.001, `from ${least} m instead of ${content.at[0]} m`);
}

const WRITERS = {
  'dxf-writer 1.18.4': (content) => { expectPlan(content, read(dxfWriter(content))); return 'read'; },
  '@tarikjabiri/dxf 2.9.0': (content) => { expectPlan(content, read(tarikjabiriDxf(content))); return 'read'; },
};
for (const heights of [false, true])
  WRITERS[`GDAL${heights ? ', heights that differ' : ''}`] = (content) => {
    const text = gdal(content, heights);
    assert.match(read(text).asked ?? '', /unit is not clear/);
    expectPlan(content, read(text, content.mm === 1 ? 'mm' : 'm'));
    return 'asked for its unit, then read';
  };

console.log(`| writer | ${Object.keys(CONTENTS).join(' | ')} |\n| --- |${' --- |'.repeat(Object.keys(CONTENTS).length)}`);
for (const [writer, write] of Object.entries(WRITERS)) {
  const cells = Object.entries(CONTENTS).map(([name, content]) => {
    try {
      return write(content);
    } catch (error) {
      process.exitCode = 1;
      return `${name}: ${error.message.split('\n')[0]}`;
    }
  });
  console.log(`| ${writer} | ${cells.join(' | ')} |`);
}
