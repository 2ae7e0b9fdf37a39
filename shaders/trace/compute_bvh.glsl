// SPDX-License-Identifier: Apache-2.0
// trace() over our own binary BVH.
//
// Hits depend on nothing but ray and triangles, to the bit, on every device and in every order of traversal:
// - A triangle is hit when the ray passes inside or on its projection, in sheared coordinates (lib/sheared_triangle.glsl). Each vertex is sheared by itself, so neighbours agree about it; an
//   edge test compares two rounded products, whose order is the exact one unless they are equal, and equal counts as inside for both. So no ray passes between two triangles
//   that share an edge or a vertex.
// - Only +, − and × are used, uncontracted, so all devices round alike.
// - The hit's t is clamped to what the triangle's own box, widened by more than all rounding, allows. Every box above holds that box and is
//   widened more, so no box is culled that may hold the nearest hit; of equal hits the lower triangle number wins.
#include "lib/sheared_triangle.glsl"
#include "lib/widening.glsl"
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

// The ray's way through the box [low, high]: from x to y.
vec2 passage_of(SlabRay ray, vec3 low, vec3 high) {
  precise vec3 a = low * ray.inverse - ray.low;
  precise vec3 b = high * ray.inverse - ray.high;
  const vec3 near = min(a, b), far = max(a, b);
  return vec2(max(max(near.x, near.y), near.z), min(min(far.x, far.y), far.z));
}

// The same through a node's box, where a last bit more or less does no harm: contraction is welcome.
struct NodeRay {
  vec3 inverse;
  vec3 size;   // of the inverse
  vec3 moved;  // origin · inverse
  float widening;
};

vec2 passage_of(NodeRay ray, vec3 centre, vec3 half_size) {
  const vec3 middle = centre * ray.inverse - ray.moved, wide = half_size + ray.widening;
  const vec3 near = middle - wide * ray.size, far = middle + wide * ray.size;
  return vec2(max(max(near.x, near.y), near.z), min(min(far.x, far.y), far.z));
}

Hit trace(vec3 origin, vec3 direction, float t_min, float t_max, float enough, Starts starts) {
  Hit best = Hit(t_max, no_primitive, vec2(0));
  const Shear shear = shear_along(direction);

  const float widening = widening_of(origin);
  const vec3 size = abs(direction);
  precise vec3 safe = vec3(size.x < 1e-12 ? 1e-12 : direction.x, size.y < 1e-12 ? 1e-12 : direction.y,
                           size.z < 1e-12 ? 1e-12 : direction.z);
  const vec3 inverse = vec3(exact_reciprocal(safe.x), exact_reciprocal(safe.y), exact_reciprocal(safe.z));
  const NodeRay node_ray = NodeRay(inverse, abs(inverse), origin * inverse, 2.0 * widening);

  uint stack[bvh_stack_size];
  float enters[bvh_stack_size];  // where the ray enters what is on the stack
  uint depth = 0;
  uint current = 0;  // the root is always a node
  uint started = tile_starts;
  if (starts.list != 0ul) {
    current = TileStarts(starts.list).at[starts.first].node;
    started = 1u;
  }
  for (;;) {
    if ((current & bvh_leaf_bit) == 0u) {
      NodeQuarters node = parameters.nodes;
      const uvec4 word0 = node.at[4u * current], word1 = node.at[4u * current + 1u], word2 = node.at[4u * current + 2u],
                  word3 = node.at[4u * current + 3u];
      const uint child0 = word0.w, child1 = word1.w;
      const vec2 way0 = passage_of(node_ray, uintBitsToFloat(word0.xyz), uintBitsToFloat(word1.xyz)),
                 way1 = passage_of(node_ray, uintBitsToFloat(word2.xyz), uintBitsToFloat(word3.xyz));
      const float enter0 = max(way0.x, t_min), enter1 = max(way1.x, t_min);
      const bool hit0 = enter0 <= min(way0.y, best.t), hit1 = enter1 <= min(way1.y, best.t);
      const bool first0 = hit0 && (!hit1 || enter0 <= enter1);
      if (hit0 || hit1) {
        if (hit0 && hit1) {
          stack[depth] = first0 ? child1 : child0;
          enters[depth] = first0 ? enter1 : enter0;
          ++depth;
          current = first0 ? child0 : child1;
        } else {
          current = hit0 ? child0 : child1;
        }
        continue;
      }
    } else {
      const uint first = current & bvh_leaf_first_mask;
      const uint end = first + ((current >> bvh_leaf_count_shift) & 7u);
      for (uint i = first; i <= end; ++i) {
        const uvec4 word_a = parameters.bvh_triangles.at[3u * i], word_b = parameters.bvh_triangles.at[3u * i + 1u],
                    word_c = parameters.bvh_triangles.at[3u * i + 2u];
        const vec3 corner_a = uintBitsToFloat(word_a.xyz), corner_b = uintBitsToFloat(word_b.xyz), corner_c = uintBitsToFloat(word_c.xyz);
        const uint id = word_a.w;
        const ShearedTriangle corners = sheared(shear, origin, corner_a, corner_b, corner_c);
        const vec3 edges = edge_functions(corners);
        precise float area = edges.x + edges.y + edges.z;
        const float least = min(min(edges.x, edges.y), edges.z), most = max(max(edges.x, edges.y), edges.z);
        if ((least >= 0.0 || most <= 0.0) && area != 0.0) {
          precise vec3 weights = edges * exact_reciprocal(area);
          precise float z = weights.x * corners.a.z + weights.y * corners.b.z + weights.z * corners.c.z;
          precise float t = z * shear.z;
          const vec2 way = passage_of(slab_ray(origin, inverse, widening), min(min(corner_a, corner_b), corner_c),
                                      max(max(corner_a, corner_b), corner_c));
          t = min(max(t, way.x), way.y);
          // Of equal hits the lower triangle number wins; the surveyed bit is no part of the number.
          if (t >= t_min && (t < best.t || (t == best.t && (id & ~surveyed_bit) < (best.id & ~surveyed_bit))))
            best = Hit(t, id, weights.yz);
        }
      }
    }
    if (best.t < enough) break;
    bool found = false;
    while (depth > 0u && !found) {
      --depth;
      found = enters[depth] <= best.t;
    }
    if (found) {
      current = stack[depth];
    } else {
      if (started == tile_starts) break;
      const TileStart start = TileStarts(starts.list).at[starts.first + started];
      if (start.near > best.t) break;
      current = start.node;
      ++started;
    }
  }
  return best;
}
