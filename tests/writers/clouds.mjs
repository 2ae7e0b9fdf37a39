// SPDX-License-Identifier: Apache-2.0
// Point clouds that programs by others write are read as the points that these were given: node clouds.mjs PROGRAM,
// after `npm ci` in this folder, with CloudCompare, the Point Cloud Library's tools and Open3D (Debian: cloudcompare,
// pcl-tools, python3-open3d). Each writer gets each content. Prints the table of docs/formats.md.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import * as THREE from 'three';
import { PLYExporter } from 'three/examples/jsm/exporters/PLYExporter.js';
import { convertE57 } from 'web-e57';

const program = path.resolve(process.argv[2]);
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'vantage-clouds-'));
process.on('exit', () => fs.rmSync(folder, { recursive: true, force: true }));
process.env.XDG_CACHE_HOME = path.join(folder, 'cache');
process.env.QT_QPA_PLATFORM = 'offscreen';  // CloudCompare opens no window
const at = (name) => path.join(folder, name);

function run(command, args) {
  const done = spawnSync(command, args, { cwd: folder, encoding: 'utf8', maxBuffer: 1 << 28 });
  if (done.error) throw new Error(`${command} cannot be run: ${done.error.message}`);
  assert.equal(done.status, 0, `${command} ${args.join(' ')}\n${done.stdout}${done.stderr}`);
  return done;
}

// A room of 8 x 6 x 2.8 m, a point every 5 cm; each point has place, colour, intensity and the normal of its face.
const SIZE = [8, 6, 2.8], STEP = 0.05;
function content({ origin = [0, 0, 0] }) {
  const points = [];
  for (let axis = 0; axis < 3; ++axis) {
    const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    for (const side of [0, 1])
      for (let i = 0; i < Math.round(SIZE[u] / STEP); ++i)
        for (let j = 0; j < Math.round(SIZE[v] / STEP); ++j) {
          const place = [0, 0, 0], normal = [0, 0, 0];
          place[axis] = side * SIZE[axis], place[u] = (i + 0.5) * STEP, place[v] = (j + 0.5) * STEP;
          normal[axis] = 1 - 2 * side;
          points.push({ place: place.map((p, k) => p + origin[k]), normal, colour: [i % 256, j % 256, 128], intensity: (i % 10) / 10 });
        }
  }
  return points;
}
// Columns of a text, which the programs read.
const columns = (points, of) => points.map((p) => of(p).join(' ')).join('\n') + '\n';
const places = (p) => p.place.map((v) => v.toFixed(4));

function cloudCompare(extension, format, ...options) {
  return (points) => {
    fs.writeFileSync(at('given.xyz'), columns(points, (p) => [...places(p), ...p.colour, p.intensity, ...p.normal]));
    run('CloudCompare', ['-SILENT', '-NO_TIMESTAMP', '-AUTO_SAVE', 'OFF', '-C_EXPORT_FMT', format, ...options, '-O', '-GLOBAL_SHIFT', 'AUTO', 'given.xyz', '-SAVE_CLOUDS']);
    return fs.readFileSync(at(`given.${extension}`));
  };
}
// The tools of the Point Cloud Library keep floats.
function pcl(format, extension, viewpoint) {
  return (points) => {
    fs.writeFileSync(at('given.xyz'), columns(points, places));
    run('pcl_xyz2pcd', ['given.xyz', 'given.pcd']);
    if (viewpoint) run('pcl_pcd_change_viewpoint', ['given.pcd', 'turned.pcd', '-viewpoint', viewpoint]);
    if (extension === 'ply') run('pcl_pcd2ply', ['-format', format, 'given.pcd', 'out.ply']);
    else run('pcl_convert_pcd_ascii_binary', [viewpoint ? 'turned.pcd' : 'given.pcd', 'out.pcd', format]);
    return fs.readFileSync(at(`out.${extension}`));
  };
}
function open3d(extension, options = '') {
  return (points) => {
    fs.writeFileSync(at('given.txt'), columns(points, (p) => [...places(p), ...p.colour.map((c) => c / 255), ...p.normal]));
    run('/usr/bin/python3', ['-c', `import numpy, open3d
rows = numpy.loadtxt("given.txt")
cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(rows[:, :3]))
cloud.colors, cloud.normals = open3d.utility.Vector3dVector(rows[:, 3:6]), open3d.utility.Vector3dVector(rows[:, 6:])
assert open3d.io.write_point_cloud("out.${extension}", cloud${options})`]);
    return fs.readFileSync(at(`out.${extension}`));
  };
}
function three(binary) {
  return (points) => {
    const geometry = new THREE.BufferGeometry();
    for (const [name, of] of [['position', (p) => p.place], ['normal', (p) => p.normal], ['color', (p) => p.colour.map((c) => c / 255)]])
      geometry.setAttribute(name, new THREE.Float32BufferAttribute(points.flatMap(of), 3));
    const written = new PLYExporter().parse(new THREE.Points(geometry), undefined, { binary });
    return binary ? new Uint8Array(written) : written;
  };
}

const loss = /told only to 0\.5 m or worse/;

// The area in m², the least and greatest place of faces across each axis, and the number of points that were read.
function read(file) {
  const out = at('read.glb');
  fs.rmSync(out, { force: true });
  const { stderr } = run(program, ['import', file, '--unit', 'm', '--up', 'z', '-o', out]);
  const glb = fs.readFileSync(out), length = glb.readUInt32LE(12), json = JSON.parse(glb.subarray(20, 20 + length));
  const binary = glb.subarray(28 + length), box = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  let area = 0;
  const values = ({ bufferView, byteOffset = 0, count, componentType, type }) => {
    const Type = { 5121: Uint8Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array }[componentType];
    const from = binary.byteOffset + (json.bufferViews[bufferView].byteOffset ?? 0) + byteOffset, size = count * (type === 'VEC3' ? 3 : 1);
    return new Type(binary.buffer.slice(from, from + size * Type.BYTES_PER_ELEMENT));
  };
  const visit = (node, outer) => {
    const { mesh, children = [], matrix, translation = [0, 0, 0], scale, rotation } = json.nodes[node];
    assert.ok(!matrix && !scale && !rotation, 'the file of a cloud has translations alone');
    const here = outer.map((v, k) => v + translation[k]);
    for (const { attributes, indices } of mesh === undefined ? [] : json.meshes[mesh].primitives) {
      const p = values(json.accessors[attributes.POSITION]), corners = values(json.accessors[indices]);
      const corner = (k) => new THREE.Vector3(...[0, 1, 2].map((a) => p[3 * corners[k] + a]));
      for (let t = 0; t < corners.length; t += 3) {
        const [a, b, c] = [0, 1, 2].map((k) => corner(t + k));
        const across = b.clone().sub(a).cross(c.clone().sub(a));
        area += across.length() / 2;
        across.normalize();
        [[across.x, a.x + here[0]], [across.z, -(a.z + here[2])], [across.y, a.y + here[1]]].forEach(([along, v], k) => {  // Y up
          if (Math.abs(along) > 0.999) box[0][k] = Math.min(box[0][k], v), box[1][k] = Math.max(box[1][k], v);
        });
      }
    }
    for (const child of children) visit(child, here);
  };
  for (const root of json.scenes[0].nodes) visit(root, [0, 0, 0]);
  const told = stderr.match(/a point cloud, ([\d ]+) points/);
  return { area, box, count: Number(told[1].replaceAll(' ', '')), said: stderr };
}

// Faces lie in the planes of their points, and end at the edges of cells.
function expectRoom(is, count, origin) {
  const area = 2 * (SIZE[0] * SIZE[1] + SIZE[1] * SIZE[2] + SIZE[2] * SIZE[0]);
  assert.equal(is.count, count, 'points');
  assert.ok(Math.abs(is.area - area) <= 0.03 * area, `${is.area} m² instead of ${area}`);
  SIZE.forEach((size, k) => [origin[k], origin[k] + size].forEach((wanted, side) =>
    assert.ok(Math.abs(is.box[side][k] - wanted) <= 0.001, `${is.box[side][k]} instead of ${wanted}`)));
}

// web-e57 writes text from E57, which is a scan of our own: number and place of its points are compared.
function webE57() {
  run(program, ['generate', 'four-walls', '-o', 'walls.glb']);
  for (const name of ['scan.e57', 'scan.ply'])
    run(program, ['scan', 'walls.glb', '--station', '5.6,2,1.7', '--step', '0.5', '--engine', 'embree', '--outputs', 'colour', '-o', name]);
  fs.writeFileSync(at('web.xyz'), convertE57(new Uint8Array(fs.readFileSync(at('scan.e57'))), 'XYZ'));
  const [web, own] = [read('web.xyz'), read('scan.ply')];
  assert.equal(web.count, own.count);
  assert.ok(Math.abs(web.area - own.area) <= 0.02 * own.area, `${web.area} m² instead of ${own.area}`);
  // There is no floor, so that one axis has no places.
  web.box.flat().forEach((v, k) => assert.ok(v === own.box.flat()[k] || Math.abs(v - own.box.flat()[k]) <= 0.002, `${v} instead of ${own.box.flat()[k]}`));
  return 'read';
}

// Name of the writer, extension, what writes, and what is made of national coordinates, if it writes fewer digits.
const TURNED = 'turned', TOLD = 'told: 0.5 m or worse', REFUSED = 'refused: 0.5 m or worse';
const writers = [
  ['CloudCompare 2.11.3, ASC', 'asc', cloudCompare('asc', 'ASC', '-PREC', '4')],
  ['CloudCompare 2.11.3, PLY, binary', 'ply', cloudCompare('ply', 'PLY', '-PLY_EXPORT_FMT', 'BINARY_LE')],
  ['CloudCompare 2.11.3, PLY, text', 'ply', cloudCompare('ply', 'PLY', '-PLY_EXPORT_FMT', 'ASCII'), REFUSED],
  ['Point Cloud Library 1.13, PCD, text', 'pcd', pcl('0', 'pcd'), TOLD],
  ['Point Cloud Library 1.13, PCD, binary', 'pcd', pcl('1', 'pcd'), TOLD],
  ['Point Cloud Library 1.13, PCD, compressed', 'pcd', pcl('2', 'pcd'), TOLD],
  ['Point Cloud Library 1.13, PCD with a viewpoint', 'pcd', pcl('1', 'pcd', '10,20,1.5,0.70710678,0,0,0.70710678'), TURNED],
  ['Point Cloud Library 1.13, PLY', 'ply', pcl('1', 'ply'), TOLD],
  ['Open3D 0.16.1, XYZ', 'xyz', open3d('xyz')],
  ['Open3D 0.16.1, XYZN', 'xyz', open3d('xyzn')],
  ['Open3D 0.16.1, XYZRGB', 'xyz', open3d('xyzrgb')],
  ['Open3D 0.16.1, PTS', 'pts', open3d('pts')],
  ['Open3D 0.16.1, PLY, text', 'ply', open3d('ply', ', write_ascii=True'), REFUSED],
  ['Open3D 0.16.1, PLY, binary', 'ply', open3d('ply')],
  ['Open3D 0.16.1, PCD, text', 'pcd', open3d('pcd', ', write_ascii=True')],
  ['Open3D 0.16.1, PCD, compressed', 'pcd', open3d('pcd', ', compressed=True'), TOLD],
  ['three.js 0.180 PLYExporter, text', 'ply', three(false), TOLD],
  ['three.js 0.180 PLYExporter, binary', 'ply', three(true), TOLD],
];
const contents = { plain: {}, far: { origin: [500_000, 5_400_000, 300] } };

console.log(`| writer | ${Object.keys(contents).join(' | ')} |\n| --- | --- | --- |`);
for (const [name, extension, write, far = 'read'] of writers) {
  const cell = (kind, { origin = [0, 0, 0] }) => {
    const points = content({ origin }), file = at(`cloud.${extension}`);
    if (far === TURNED && kind === 'far') return '–';
    fs.writeFileSync(file, write(points));
    if (kind === 'far' && far !== 'read') {
      const done = spawnSync(program, ['import', file, '--unit', 'm', '--up', 'z', '-o', at('read.glb')], { cwd: folder, encoding: 'utf8' });
      assert.match(done.stderr, loss);
      assert.equal(done.status === 0, far === TOLD);
      return far;
    }
    const is = read(file);
    assert.doesNotMatch(is.said, loss);
    if (far !== TURNED) {
      expectRoom(is, points.length, origin);
      return 'read';
    }
    // The scan is turned by a right angle about its z axis, and moved.
    assert.match(is.said, /viewpoint moves its points, and is where the scanner stood/);
    assert.equal(is.count, points.length);
    [4, 20, 1.5, 10, 28, 4.3].forEach((wanted, k) => assert.ok(Math.abs(is.box.flat()[k] - wanted) <= 0.001, `${is.box} for ${wanted}`));
    return 'read, where the scanner stood';
  };
  const cells = Object.entries(contents).map(([kind, options]) => {
    try {
      return cell(kind, options);
    } catch (error) {
      process.exitCode = 1;
      return `WRONG: ${String(error.message).trim().split('\n').slice(0, 3).join(' ')}`;
    }
  });
  console.log(`| ${name} | ${cells.join(' | ')} |`);
}
console.log(`| web-e57 1.2.0, XYZ of E57 | ${webE57()} | – |`);
