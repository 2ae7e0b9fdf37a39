// SPDX-License-Identifier: Apache-2.0
// Triangulates a region of a plane by ear clipping, after bridging its holes.

const twice = ([ax, ay], [bx, by], [cx, cy]) => (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
const area = (ring) => ring.reduce((sum, [x, y], i) => { const [u, v] = ring[(i + 1) % ring.length]; return sum + x * v - u * y; }, 0);

// Returns {points, triangles}: anticlockwise triples of indices of `points`, which are those of outer ring and holes.
export function triangulated({ outer, holes }) {
  const points = [...outer, ...holes.flat()];
  const oriented = (ring, first, sign) => {
    const indices = ring.map((_, i) => first + i);
    return area(ring) * sign < 0 ? indices.reverse() : indices;
  };
  let ring = oriented(outer, 0, 1), first = outer.length;
  const inner = holes.map((hole) => {
    const indices = oriented(hole, first, -1);
    first += hole.length;
    return indices;
  });
  // Joins holes from the largest x on, so that no other hole lies between a hole and the ring.
  const reach = (hole) => Math.max(...hole.map((i) => points[i][0]));
  for (const hole of inner.sort((a, b) => reach(b) - reach(a))) ring = bridged(points, ring, hole);
  return { points, triangles: ears(points, ring) };
}

function bridged(points, ring, hole) {
  let start = 0;
  hole.forEach((index, k) => { if (points[index][0] > points[hole[start]][0]) start = k; });
  const from = points[hole[start]];
  // Takes the nearest visible corner of the ring.
  const order = ring.map((_, i) => i).sort((a, b) => far(points[ring[a]], from) - far(points[ring[b]], from));
  const hidden = (i) => [ring, hole].some((loop) => loop.some((index, k) => crosses(from, points[ring[i]], points[index], points[loop[(k + 1) % loop.length]])));
  const inside = (i) => {  // the bridge leaves the corner into the region
    const here = points[ring[i]], before = points[ring.at(i - 1)], after = points[ring[(i + 1) % ring.length]];
    const left = twice(before, here, from) > 0, right = twice(here, after, from) > 0;
    return twice(before, here, after) > 0 ? left && right : left || right;
  };
  const at = order.find((i) => inside(i) && !hidden(i)) ?? order[0];
  return [...ring.slice(0, at + 1), ...hole.slice(start), ...hole.slice(0, start + 1), ...ring.slice(at)];
}

const far = (a, b) => (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2;
const crosses = (a, b, c, d) => twice(a, b, c) * twice(a, b, d) < 0 && twice(c, d, a) * twice(c, d, b) < 0;

function ears(points, ring) {
  const triangles = [], left = [...ring];
  const same = (a, b) => points[a][0] === points[b][0] && points[a][1] === points[b][1];
  for (let i = 0, misses = 0; left.length > 3;) {
    const n = left.length, [a, b, c] = [left[(i + n - 1) % n], left[i % n], left[(i + 1) % n]];
    const turn = twice(points[a], points[b], points[c]);
    const ear = turn > 0 && !left.some((p) => !same(p, a) && !same(p, b) && !same(p, c) &&
      twice(points[a], points[b], points[p]) >= 0 && twice(points[b], points[c], points[p]) >= 0 && twice(points[c], points[a], points[p]) >= 0);
    if (ear || misses > n) {  // after a full round, the rest touches itself, and any cut is as good
      if (turn !== 0) triangles.push([a, b, c]);
      left.splice(i % n, 1);
      misses = 0;
      i = i % left.length;
    } else {
      i = (i + 1) % n, ++misses;
    }
  }
  if (twice(...left.map((i) => points[i])) !== 0) triangles.push(left);
  return triangles;
}
