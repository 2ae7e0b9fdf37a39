// SPDX-License-Identifier: Apache-2.0
// What is certain of a ray and a triangle, whatever engine decides between them.
#ifndef VANTAGE_LIB_MAY_HIT
#define VANTAGE_LIB_MAY_HIT
#include "lib/sheared_triangle.glsl"

// How far edge functions may be off, opposite each corner: for 2^-16 of the largest coordinate, tens of times the
// rounding of the engines' own tests.
vec3 edge_doubt(ShearedTriangle t) {
  const vec3 a = abs(t.a), b = abs(t.b), c = abs(t.c);
  // Shears are at most 1, so no coordinate was larger than this before.
  const float reach = max(max(max(a.x, a.y) + a.z, max(b.x, b.y) + b.z), max(c.x, c.y) + c.z) * (1.0 / 65536.0);
  const vec3 sums = vec3(a.x + a.y, b.x + b.y, c.x + c.y);
  return reach * (sums.yxx + sums.zzy + reach);
}

// Whether any engine might report a hit.
bool may_hit(Shear shear, vec3 origin, vec3 a, vec3 b, vec3 c) {
  const ShearedTriangle t = sheared(shear, origin, a, b, c);
  const vec3 edges = edge_functions(t), doubt = edge_doubt(t);
  return all(greaterThanEqual(edges, -doubt)) || all(lessThanEqual(edges, doubt));
}

// Whether every engine must report a hit farther than `nearest` and nearer than `farthest`.
bool must_hit(Shear shear, vec3 origin, vec3 a, vec3 b, vec3 c, float nearest, float farthest) {
  const ShearedTriangle t = sheared(shear, origin, a, b, c);
  const vec3 edges = edge_functions(t), doubt = edge_doubt(t);
  if (!(all(greaterThan(edges, doubt)) || all(lessThan(edges, -doubt)))) return false;
  const float area = edges.x + edges.y + edges.z;
  const vec3 depths = vec3(t.a.z, t.b.z, t.c.z) * shear.z;
  const float at = dot(edges, depths) / area;
  const float spread = max(max(depths.x, depths.y), depths.z) - min(min(depths.x, depths.y), depths.z);
  const float off = spread * (doubt.x + doubt.y + doubt.z) / abs(area) + abs(at) * (1.0 / 65536.0);
  return at - off > nearest && at + off < farthest;
}

#endif
