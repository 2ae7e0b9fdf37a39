// SPDX-License-Identifier: Apache-2.0
// trace() over our own binary BVH.
//
// Hits depend on nothing but ray and triangles, to the bit, on every device:
// - A triangle is hit when the ray lies inside or on it in sheared coordinates. Each vertex is sheared by itself, so neighbours agree
//   about it; an edge test compares two rounded products, whose order is the exact one unless they are equal, and equal counts as inside for both
//   neighbours. So no ray passes between two triangles that share an edge or a vertex.
// - Only +, − and × are used, uncontracted, so all devices round alike (lib/sheared_triangle.glsl, lib/exact.glsl).
// - The hit's t is clamped to what the triangle's own box, widened by more than all rounding, allows. Every box above holds that box and is
//   widened more, so no box is culled that may hold the nearest hit; of equal hits the lower triangle number wins.
#include "lib/sheared_triangle.glsl"
#include "trace/hit.glsl"

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

Hit trace(Parameters parameters, vec3 origin, vec3 direction, float t_min, float t_max, float enough) {
  Hit best = Hit(t_max, no_primitive, vec2(0));

  const Shear shear = shear_along(direction);

  // Boxes are widened by more than the rounding of shear and slabs: 2^-20 of the largest coordinate that takes part.
  const vec3 extent = max(max(abs(parameters.at.bounds_min), abs(parameters.at.bounds_max)), abs(origin));
  const float widening = 2.0 * max(max(extent.x, extent.y), extent.z) * (1.0 / 1048576.0);
  const vec3 size = abs(direction);
  precise vec3 safe = vec3(size.x < 1e-12 ? 1e-12 : direction.x, size.y < 1e-12 ? 1e-12 : direction.y,
                           size.z < 1e-12 ? 1e-12 : direction.z);
  const vec3 inverse = vec3(exact_reciprocal(safe.x), exact_reciprocal(safe.y), exact_reciprocal(safe.z));
  const SlabRay triangle_ray = slab_ray(origin, inverse, widening);
  const SlabRay node_ray = slab_ray(origin, inverse, 2.0 * widening);

  uint stack[bvh_stack_size];
  uint depth = 0;
  uint current = 0;  // the root is always a node
  for (;;) {
    if ((current & bvh_leaf_bit) == 0u) {
      const BvhNode node = parameters.at.nodes.at[current];
      const vec3 a0 = node.min0 * node_ray.inverse - node_ray.low, b0 = node.max0 * node_ray.inverse - node_ray.high;
      const vec3 a1 = node.min1 * node_ray.inverse - node_ray.low, b1 = node.max1 * node_ray.inverse - node_ray.high;
      const vec3 near0 = min(a0, b0), far0 = max(a0, b0), near1 = min(a1, b1), far1 = max(a1, b1);
      const float enter0 = max(max(near0.x, near0.y), max(near0.z, t_min)), leave0 = min(min(far0.x, far0.y), min(far0.z, best.t));
      const float enter1 = max(max(near1.x, near1.y), max(near1.z, t_min)), leave1 = min(min(far1.x, far1.y), min(far1.z, best.t));
      const bool hit0 = enter0 <= leave0, hit1 = enter1 <= leave1;
      if (hit0 || hit1) {
        const bool first0 = hit0 && (!hit1 || enter0 <= enter1);
        current = first0 ? node.child0 : node.child1;
        if (hit0 && hit1) stack[depth++] = first0 ? node.child1 : node.child0;
        continue;
      }
    } else {
      const uint first = current & bvh_leaf_first_mask;
      const uint count = ((current >> bvh_leaf_count_shift) & 7u) + 1u;
      for (uint i = 0; i < count; ++i) {
        const BvhTriangle triangle = parameters.at.bvh_triangles.at[first + i];
        const ShearedTriangle corners = sheared(shear, origin, triangle.a, triangle.b, triangle.c);
        const vec3 edges = edge_functions(corners);
        if (any(lessThan(edges, vec3(0))) && any(greaterThan(edges, vec3(0)))) continue;
        precise float area = edges.x + edges.y + edges.z;
        if (area == 0.0) continue;
        precise vec3 weights = edges * exact_reciprocal(area);
        precise float z = weights.x * corners.a.z + weights.y * corners.b.z + weights.z * corners.c.z;
        precise float t = z * shear.z;
        precise vec3 lower = min(min(triangle.a, triangle.b), triangle.c);
        precise vec3 upper = max(max(triangle.a, triangle.b), triangle.c);
        precise vec3 s = lower * triangle_ray.inverse - triangle_ray.low;
        precise vec3 e = upper * triangle_ray.inverse - triangle_ray.high;
        const vec3 near = min(s, e), far = max(s, e);
        t = min(max(t, max(max(near.x, near.y), near.z)), min(min(far.x, far.y), far.z));
        // Of equal hits the lower triangle number wins; the surveyed bit is no part of the number.
        if (t >= t_min && (t < best.t || (t == best.t && (triangle.id & ~surveyed_bit) < (best.id & ~surveyed_bit)))) {
          best = Hit(t, triangle.id, weights.yz);
        }
      }
    }
    if (depth == 0u || best.t < enough) break;
    current = stack[--depth];
  }
  return best;
}
