// SPDX-License-Identifier: Apache-2.0
// Models that programs by others write are read as the model that these were given: node meshes.mjs PROGRAM, after
// `npm ci` in this folder. Each writer gets each content, and scans of what it wrote have the points of scans of the
// content itself. Prints the table of docs/formats.md.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import { dedup, draco, flatten, instance, join, meshopt, quantize, weld } from '@gltf-transform/functions';
import draco3d from 'draco3dgltf';
import gltfPipeline from 'gltf-pipeline';
import { MeshoptDecoder, MeshoptEncoder } from 'meshoptimizer';
import obj2gltf from 'obj2gltf';
import * as THREE from 'three';
import { GLTFExporter } from 'three/examples/jsm/exporters/GLTFExporter.js';
import { OBJExporter } from 'three/examples/jsm/exporters/OBJExporter.js';
import { PLYExporter } from 'three/examples/jsm/exporters/PLYExporter.js';
import { STLExporter } from 'three/examples/jsm/exporters/STLExporter.js';

const program = path.resolve(process.argv[2]);
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'vantage-writers-'));
process.on('exit', () => fs.rmSync(folder, { recursive: true, force: true }));
process.env.XDG_CACHE_HOME = path.join(folder, 'cache');

// three's exporter of glTF reads its own Blob in the way of a browser.
globalThis.FileReader = class {
  async read(blob, as) {
    const bytes = await blob.arrayBuffer();
    this.result = as(bytes);
    this.onloadend();
  }
  readAsArrayBuffer(blob) {
    this.read(blob, (bytes) => bytes);
  }
  readAsDataURL(blob) {
    this.read(blob, (bytes) => `data:${blob.type};base64,${Buffer.from(bytes).toString('base64')}`);
  }
};

// A room with a pillar and a table of boxes, in metres with Y up, as three's scene. What is far has its place in the
// root's transform, and what is mirrored has nodes of negative and unequal scales.
function content({ mirrored = false, far = false }) {
  const scene = new THREE.Scene();
  const root = new THREE.Group();
  root.name = 'site';
  if (far) root.position.set(500000, 100, -5600000);
  scene.add(root);
  const unit = new THREE.BoxGeometry(1, 1, 1);
  const material = new THREE.MeshStandardMaterial({ name: 'plaster', color: 0x808080 });
  const add = (name, size, at, above = root) => {
    const mesh = new THREE.Mesh(unit, material);
    mesh.name = name;
    mesh.scale.set(...size);
    mesh.position.set(...at);
    above.add(mesh);
    return mesh;
  };
  add('floor', [8, 0.2, 6], [4, -0.1, -3]);
  add('north', [8, 3, 0.2], [4, 1.5, -6]);
  add('south', [8, 3, 0.2], [4, 1.5, 0]);
  add('west', [0.2, 3, 6], [0, 1.5, -3]);
  add('east', [0.2, 3, 6], [8, 1.5, -3]);
  const turned = new THREE.Group();
  turned.name = 'table';
  turned.position.set(5.5, 0, -4);
  turned.rotation.y = 0.4;
  if (mirrored) turned.scale.set(-1, 1, 1);
  root.add(turned);
  add('top', [1.6, 0.05, 0.8], [0, 0.75, 0], turned);
  for (const [k, x, z] of [[0, 0.7, 0.3], [1, -0.7, 0.3], [2, 0.7, -0.3], [3, -0.5, -0.3]])
    add(`leg ${k}`, [0.06, mirrored && k === 1 ? -0.75 : 0.75, 0.06], [x, 0.375, z], turned);
  add('pillar', [0.4, 3, 0.4], [2.5, 1.5, -4.2]);
  scene.updateMatrixWorld(true);
  return scene;
}

const three = (scene) => new Promise((done, fail) => new GLTFExporter().parse(scene, (glb) => done(new Uint8Array(glb)), fail, { binary: true }));
await MeshoptEncoder.ready;
const io = new NodeIO().registerExtensions(ALL_EXTENSIONS).registerDependencies({
  'draco3d.encoder': await draco3d.createEncoderModule(),
  'draco3d.decoder': await draco3d.createDecoderModule(),
  'meshopt.encoder': MeshoptEncoder,
  'meshopt.decoder': MeshoptDecoder,
});
const transformed = (...steps) => async ({ glb }) => {
  const document = await io.readBinary(glb);
  await document.transform(...steps);
  return io.writeBinary(document);
};
function pack(...options) {
  return ({ glb }) => {
    const [from, to] = ['packed-in.glb', 'packed-out.glb'].map((name) => path.join(folder, name));
    fs.writeFileSync(from, glb);
    const cli = path.join(import.meta.dirname, 'node_modules/gltfpack/cli.js');
    const done = spawnSync(process.execPath, [cli, '-i', from, '-o', to, ...options], { encoding: 'utf8' });
    assert.equal(done.status, 0, done.stderr);
    return fs.readFileSync(to);
  };
}
async function fromObj({ scene }) {
  const file = path.join(folder, 'from.obj');
  fs.writeFileSync(file, new OBJExporter().parse(scene));
  return obj2gltf(file, { binary: true });
}

// Name of the writer, extension, and what writes; `loses`: contents of which its format or its floats lose more than a
// scan forgives.
const writers = [
  ['three.js GLTFExporter', 'glb', ({ glb }) => glb],
  ['three.js OBJExporter', 'obj', ({ scene }) => new OBJExporter().parse(scene)],
  ['three.js PLYExporter, text', 'ply', ({ scene }) => new PLYExporter().parse(scene), ['far']],
  ['three.js PLYExporter, binary', 'ply', ({ scene }) => new Uint8Array(new PLYExporter().parse(scene, undefined, { binary: true })), ['far']],
  ['three.js STLExporter, text', 'stl', ({ scene }) => new STLExporter().parse(scene)],
  ['three.js STLExporter, binary', 'stl', ({ scene }) => new Uint8Array(new STLExporter().parse(scene, { binary: true }).buffer), ['far']],
  ['gltf-transform, as it is', 'glb', transformed(dedup())],
  ['gltf-transform, instances', 'glb', transformed(dedup(), flatten(), instance({ min: 2 }))],
  ['gltf-transform, quantized', 'glb', transformed(weld(), quantize())],
  ['gltf-transform, joined', 'glb', transformed(dedup(), flatten(), join()), ['far']],
  ['gltf-transform, Draco', 'glb', transformed(weld(), draco())],
  ['gltf-transform, meshopt', 'glb', transformed(meshopt({ encoder: MeshoptEncoder }))],
  ['gltfpack', 'glb', pack()],
  ['gltfpack, floats', 'glb', pack('-noq')],
  ['gltfpack, instances', 'glb', pack('-mi')],
  ['gltfpack, meshopt', 'glb', pack('-cc')],
  ['gltf-pipeline, as text', 'gltf', async ({ glb }) => JSON.stringify((await gltfPipeline.glbToGltf(Buffer.from(glb))).gltf)],
  ['gltf-pipeline, Draco', 'glb', async ({ glb }) => (await gltfPipeline.processGlb(Buffer.from(glb), { dracoOptions: { compressionLevel: 7 } })).glb],
  ['obj2gltf', 'glb', fromObj, ['far']],
];

// Points of two stations on what the file holds, where the content is.
function points(file, far) {
  const [x, y, z] = far ? [500000, 5600000, 100] : [0, 0, 0];
  const stations = [[1, 1, 1.5], [6.5, 2, 1.7]].flatMap(([a, b, c]) => ['--station', `${x + a},${y + b},${z + c}`]);
  const done = spawnSync(program, ['evaluate', file, '--unit', 'm', '--up', 'y', ...stations, '--step', '0.5', '--engine', 'embree', '--spacing', '0.05', '--user-size', '0.1', '--json'], { encoding: 'utf8', maxBuffer: 1 << 26 });
  if (done.status !== 0) throw new Error(done.stderr);
  const json = JSON.parse(done.stdout);
  return { points: json.stations.map((station) => station.points), coverage: json.coverage, said: done.stderr };
}

const contents = { plain: {}, mirrored: { mirrored: true }, far: { far: true } };
const table = new Map(writers.map(([name]) => [name, []]));
let wrong = 0;
for (const [kind, options] of Object.entries(contents)) {
  const scene = content(options);
  const glb = await three(scene);
  const reference = path.join(folder, 'reference.glb');
  fs.writeFileSync(reference, glb);
  const wanted = points(reference, options.far);
  assert.ok(wanted.points.every((count) => count > 10000));
  for (const [name, extension, write, loses = []] of writers) {
    const file = path.join(folder, `${kind}-${name.replaceAll(/\W+/g, '-')}.${extension}`);
    let cell;
    try {
      fs.writeFileSync(file, await write({ scene, glb }));
      const is = points(file, options.far);
      const near = is.points.every((count, k) => Math.abs(count - wanted.points[k]) <= 0.01 * wanted.points[k]) && Math.abs(is.coverage - wanted.coverage) <= 0.02;
      const told = /only to|float32/.test(is.said);
      cell = near ? 'read' : loses.includes(kind) && told ? 'read, loss told' : `WRONG: ${is.points} of ${wanted.points}, ${is.coverage} of ${wanted.coverage} `;
    } catch (error) {
      cell = `FAILED: ${String(error.message ?? error).trim()}`;
    }
    wrong += /WRONG|FAILED/.test(cell);
    table.get(name).push(cell);
  }
}
console.log(`| writer | ${Object.keys(contents).join(' | ')} |\n| --- |${' --- |'.repeat(Object.keys(contents).length)}`);
for (const [name, cells] of table) console.log(`| ${name} | ${cells.join(' | ')} |`);
assert.equal(wrong, 0, `${wrong} of ${writers.length * Object.keys(contents).length} are not read as written`);
