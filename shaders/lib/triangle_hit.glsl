// SPDX-License-Identifier: Apache-2.0
// Ray-triangle intersection, for engines that decide it themselves.
//
// Hits depend only on ray and triangles, to the bit, on every device and in every order of traversal:
// - A ray hits a triangle if it passes inside or on its projection, in sheared coordinates (lib/sheared_triangle.glsl).
//   Each vertex is sheared by itself, so neighbours agree about it. An edge test compares two rounded products, whose
//   order is exact unless they are equal; equal counts as inside for both. No ray therefore passes between two
//   triangles that share an edge or a vertex.
// - Only +, − and × are used, uncontracted, so all devices round alike.
// - Triangles of a mesh that nodes share are met in the frame of the mesh, into which the ray is moved.
// - The hit's t is clamped to the triangle's own box, widened by more than all rounding. Every box above contains that
//   box and is widened more, so no box is culled that may hold the nearest hit. Among equal hits the lower triangle
//   number wins.
#ifndef VANTAGE_LIB_TRIANGLE_HIT
#define VANTAGE_LIB_TRIANGLE_HIT
#include "lib/sheared_triangle.glsl"
#include "lib/widening.glsl"
#include "trace/hit.glsl"

// Returns 1 / direction, with a small number in place of a component of 0.
vec3 inverse_of(vec3 direction) {
  const vec3 size = abs(direction);
  precise vec3 safe = vec3(size.x < 1e-12 ? 1e-12 : direction.x, size.y < 1e-12 ? 1e-12 : direction.y,
                           size.z < 1e-12 ? 1e-12 : direction.z);
  return vec3(exact_reciprocal(safe.x), exact_reciprocal(safe.y), exact_reciprocal(safe.z));
}

struct SlabRay {
  vec3 inverse;
  vec3 low;   // (origin + widening) · inverse, subtracted from planes at a box's lower corner
  vec3 high;  // (origin − widening) · inverse
};

SlabRay slab_ray(vec3 origin, vec3 inverse, float widening) {
  precise vec3 a = origin + widening;
  precise vec3 b = origin - widening;
  precise vec3 low = a * inverse;
  precise vec3 high = b * inverse;
  return SlabRay(inverse, low, high);
}

// Returns the interval of the ray inside the box [low, high]: from x to y.
vec2 passage_of(SlabRay ray, vec3 low, vec3 high) {
  precise vec3 a = low * ray.inverse - ray.low;
  precise vec3 b = high * ray.inverse - ray.high;
  const vec3 near = min(a, b), far = max(a, b);
  return vec2(max(max(near.x, near.y), near.z), min(min(far.x, far.y), far.z));
}

// Replaces the best hit by the triangle's if that is better. `inverse`: of the shear's direction; `widening`: of the
// origin.
void meet_triangle(inout Hit best, float t_min, Shear shear, vec3 origin, vec3 inverse, float widening, vec3 a, vec3 b,
                   vec3 c, uint id) {
  const ShearedTriangle corners = sheared(shear, origin, a, b, c);
  const vec3 edges = edge_functions(corners);
  precise float area = edges.x + edges.y + edges.z;
  const float least = min(min(edges.x, edges.y), edges.z), most = max(max(edges.x, edges.y), edges.z);
  if ((least >= 0.0 || most <= 0.0) && area != 0.0) {
    precise vec3 weights = edges * exact_reciprocal(area);
    precise float z = weights.x * corners.a.z + weights.y * corners.b.z + weights.z * corners.c.z;
    precise float t = z * shear.z;
    const vec2 way = passage_of(slab_ray(origin, inverse, widening), min(min(a, b), c), max(max(a, b), c));
    t = min(max(t, way.x), way.y);
    // Among equal hits the lower triangle number wins; the surveyed bit is not part of the number.
    if (t >= t_min && (t < best.t || (t == best.t && (id & ~surveyed_bit) < (best.id & ~surveyed_bit))))
      best = Hit(t, id, weights.yz);
  }
}

#endif
