// SPDX-License-Identifier: Apache-2.0
// Finds outline and heights of a room from its body.

const MILLIMETRES = 1000;

// Returns the loops around the triangles at the body's lowest level: lists of [x, z], in metres. `triangles` are
// triples of points [x, y, z], Y up.
export function footprint(triangles) {
  let foot = Infinity;
  for (const triangle of triangles) for (const [, y] of triangle) foot = Math.min(foot, y);
  const key = ([x, , z]) => `${Math.round(x * MILLIMETRES)} ${Math.round(z * MILLIMETRES)}`;
  const places = new Map(), edges = new Map();  // edges by their start
  for (const triangle of triangles) {
    if (triangle.some(([, y]) => y > foot + 1 / MILLIMETRES)) continue;
    const keys = triangle.map(key);
    triangle.forEach(([x, , z], i) => places.set(keys[i], [x, z]));
    for (let i = 0; i < 3; ++i) {
      const from = keys[i], to = keys[(i + 1) % 3];
      if (from === to) continue;
      if (edges.get(to)?.delete(from)) continue;  // it lies between two triangles
      if (!edges.has(from)) edges.set(from, new Set());
      edges.get(from).add(to);
    }
  }
  const loops = [];
  for (const [start, ends] of edges)
    while (ends.size > 0) {
      const loop = [];
      let at = start;
      while (edges.get(at)?.size > 0) {
        const [next] = edges.get(at);
        edges.get(at).delete(next);
        loop.push(places.get(at));
        at = next;
      }
      if (loop.length > 2) loops.push(loop);
    }
  return loops;
}

export function box(triangles) {
  const min = [Infinity, Infinity, Infinity], max = [-Infinity, -Infinity, -Infinity];
  for (const triangle of triangles)
    for (const point of triangle)
      for (let c = 0; c < 3; ++c) {
        min[c] = Math.min(min[c], point[c]);
        max[c] = Math.max(max[c], point[c]);
      }
  return [min, max];
}
