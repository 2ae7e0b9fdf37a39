// SPDX-License-Identifier: Apache-2.0
// trace() over our own binary BVH.
#include "lib/triangle_hit.glsl"
#include "trace/compute_bvh/nodes.glsl"
#include "trace/hit.glsl"

// A ray as nodes' boxes are tested against, where a last bit more or less does no harm: contraction is welcome.
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
  const vec3 inverse = inverse_of(direction);
  const NodeRay node_ray = NodeRay(inverse, abs(inverse), origin * inverse, 2.0 * widening);

  uvec2 stack[bvh_stack_size];  // what is still to visit, and where the ray enters it
  uint depth = 0;
  uint current = 0;  // the root is always a node
  uint started = tile_starts;
  const uint first_start = starts.tile * tile_starts;
  if (starts.list != 0ul) {
    current = TileStarts(starts.list).at[first_start].node;
    started = 1u;
  }
  // First down to a leaf, then its triangles: threads of a subgroup wait for each other at the leaves rather than take
  // turns between nodes and triangles.
  bool up = false;  // what comes next is on the stack
  for (;;) {
    for (;;) {
      if (up) {
        bool found = false;
        while (depth > 0u && !found) {
          --depth;
          const uvec2 top = stack[depth];
          found = uintBitsToFloat(top.y) <= best.t;
          current = top.x;
        }
        if (!found) {
          if (started == tile_starts) return best;
          const TileStart start = TileStarts(starts.list).at[first_start + started];
          if (start.near > best.t) return best;
          current = start.node;
          ++started;
        }
      }
      if ((current & bvh_leaf_bit) != 0u) break;
      const uvec4 word0 = bvh_nodes.at[4u * current], word1 = bvh_nodes.at[4u * current + 1u],
                  word2 = bvh_nodes.at[4u * current + 2u], word3 = bvh_nodes.at[4u * current + 3u];
      const uint child0 = word0.w, child1 = word1.w;
      const vec2 way0 = passage_of(node_ray, uintBitsToFloat(word0.xyz), uintBitsToFloat(word1.xyz)),
                 way1 = passage_of(node_ray, uintBitsToFloat(word2.xyz), uintBitsToFloat(word3.xyz));
      const float enter0 = max(way0.x, t_min), enter1 = max(way1.x, t_min);
      const bool hit0 = enter0 <= min(way0.y, best.t), hit1 = enter1 <= min(way1.y, best.t);
      const bool first0 = hit0 && (!hit1 || enter0 <= enter1);
      up = !hit0 && !hit1;
      if (hit0 && hit1) {
        stack[depth] = uvec2(first0 ? child1 : child0, floatBitsToUint(first0 ? enter1 : enter0));
        ++depth;
      }
      current = first0 ? child0 : child1;
    }
    const uint first = current & bvh_leaf_first_mask;
    const uint end = first + ((current >> bvh_leaf_count_shift) & 7u);
    for (uint i = first; i <= end; ++i) {
      const uvec4 word_a = bvh_corners.at[3u * i], word_b = bvh_corners.at[3u * i + 1u],
                  word_c = bvh_corners.at[3u * i + 2u];
      const vec3 corner_a = uintBitsToFloat(word_a.xyz), corner_b = uintBitsToFloat(word_b.xyz),
                 corner_c = uintBitsToFloat(word_c.xyz);
      meet_triangle(best, t_min, shear, origin, inverse, widening, corner_a, corner_b, corner_c, word_a.w);
    }
    if (best.t < enough) return best;
    up = true;
  }
}
