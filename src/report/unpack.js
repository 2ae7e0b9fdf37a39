'use strict';
// Inverse of packed.hpp and view_json.cpp.

async function unpack(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

function fromPlanes(bytes, count, width) {
  const values = new Uint32Array(count);
  for (let plane = 0; plane < width; ++plane)
    for (let k = 0; k < count; ++k) values[k] |= bytes[plane * count + k] << (8 * plane);
  return values;
}

async function unpackMesh(mesh) {
  const n = mesh.vertices, m = 3 * mesh.triangles;
  const steps = fromPlanes(await unpack(mesh.positions), 3 * n, 2);
  const positions = new Uint16Array(3 * n);
  for (let axis = 0; axis < 3; ++axis)
    for (let k = 0, last = 0; k < n; ++k) {
      last = (last + steps[axis * n + k]) & 0xffff;
      positions[3 * k + axis] = last;
    }
  const indices = fromPlanes(await unpack(mesh.indices), m, 4);
  for (let k = 0, fresh = 0; k < m; ++k) {
    indices[k] = fresh - indices[k];
    if (indices[k] === fresh) ++fresh;
  }
  return { positions, indices, kinds: await unpack(mesh.kinds) };
}

async function unpackKeys(cells) {
  const keys = fromPlanes(await unpack(cells.keys), cells.count, 4);
  for (let k = 1; k < keys.length; ++k) keys[k] += keys[k - 1];
  return keys;
}
