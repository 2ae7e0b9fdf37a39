// SPDX-License-Identifier: Apache-2.0
// Nearest hits over our own binary BVH: of the engine compute_bvh, and of glass on every engine.
#ifndef VANTAGE_TRACE_COMPUTE_BVH_WALK
#define VANTAGE_TRACE_COMPUTE_BVH_WALK
#include "lib/triangle_hit.glsl"
#include "trace/compute_bvh/nodes.glsl"
#include "trace/hit.glsl"

// A ray for tests against nodes' boxes. A wrong last bit does no harm, so contraction is allowed.
struct NodeRay {
  vec3 inverse;
  vec3 moved;  // origin · inverse
  vec3 size;  // size of the inverse, times the widening of boxes
};

// `built_widening`: of the boxes as built.
NodeRay node_ray(vec3 origin, vec3 inverse, float widening, float built_widening) {
  const float larger = max(2.0 * widening / built_widening, 1.0);
  return NodeRay(inverse, origin * inverse, abs(inverse) * larger);
}

// Returns the interval of the ray inside a box, from x to y, up to t_max. Non-negative floats are ordered as their
// bits, and a GPU takes the maximum of three integers at once. A negative value becomes any negative number; as a begin
// or an end, it lies before t_min either way.
ivec2 passage_of(NodeRay ray, vec3 centre, vec3 half_size, int t_min, int t_max) {
  const vec3 middle = centre * ray.inverse - ray.moved;
  const ivec3 near = floatBitsToInt(middle - half_size * ray.size), far = floatBitsToInt(middle + half_size * ray.size);
  return ivec2(max(max(max(near.x, near.y), near.z), t_min), min(min(min(far.x, far.y), far.z), t_max));
}

// A ray in the frame of the scene or of a shared mesh.
struct FrameRay {
  vec3 origin;
  Shear shear;
  vec3 inverse;
  float widening;
  NodeRay node;
  uint base;  // added to ids of triangles
};

FrameRay frame_ray(vec3 origin, vec3 direction, float widening, float built_widening, uint base) {
  const vec3 inverse = inverse_of(direction);
  return FrameRay(origin, shear_along(direction), inverse, widening,
                  node_ray(origin, inverse, widening, built_widening), base);
}

// Returns the ray in the frame of a tree whose root is node 0.
FrameRay ray_in_tree(NodeQuarters nodes, vec3 origin, vec3 direction) {
  return frame_ray(origin, direction, widening_of(origin), uintBitsToFloat(nodes.at[2].w), 0u);
}

// Children of a node, and the number that the ray enters before t_max: both, only the nearer, or none.
struct Children {
  uint nearer, farther;
  bool both, none;
};

Children children_of(NodeQuarters nodes, uint node, NodeRay ray, float t_min, float t_max) {
  const uvec4 word0 = nodes.at[4u * node], word1 = nodes.at[4u * node + 1u], word2 = nodes.at[4u * node + 2u],
              word3 = nodes.at[4u * node + 3u];
  const uint child0 = word0.w, child1 = word1.w;
  const int first_t = floatBitsToInt(t_min), last_t = floatBitsToInt(t_max);
  const ivec2 way0 = passage_of(ray, uintBitsToFloat(word0.xyz), uintBitsToFloat(word1.xyz), first_t, last_t),
              way1 = passage_of(ray, uintBitsToFloat(word2.xyz), uintBitsToFloat(word3.xyz), first_t, last_t);
  const bool hit0 = way0.x <= way0.y, hit1 = way1.x <= way1.y;
  const bool first0 = hit0 && (!hit1 || way0.x <= way1.x);
  return Children(first0 ? child0 : child1, first0 ? child1 : child0, hit0 && hit1, !hit0 && !hit1);
}

// Replaces the best hit by that of triangle i if that is better.
void meet_corners(inout Hit best, TriangleCorners corners, uint i, float t_min, FrameRay ray) {
  const uvec4 word_a = corners.at[3u * i], word_b = corners.at[3u * i + 1u], word_c = corners.at[3u * i + 2u];
  meet_triangle(best, t_min, ray.shear, ray.origin, ray.inverse, ray.widening, uintBitsToFloat(word_a.xyz),
                uintBitsToFloat(word_b.xyz), uintBitsToFloat(word_c.xyz), word_a.w + ray.base);
}

uint first_of_leaf(uint leaf) { return leaf & bvh_leaf_first_mask; }
uint last_of_leaf(uint leaf) { return first_of_leaf(leaf) + ((leaf >> bvh_leaf_count_shift) & 7u); }

// Returns the node at which the ray continues once its start node is finished.
uint next_start(Starts starts, inout uint started, inout uint depth, float nearest) {
  if (starts.list == 0ul || started == tile_starts) return bvh_end;
  const TileStart start = TileStarts(starts.list).at[starts.tile * tile_starts + started];
  if (start.near > nearest) return bvh_end;
  ++started;
  depth = 1u;
  return start.node;
}

// Works as trace(), over the tree in these arrays.
Hit walk(NodeQuarters nodes, TriangleCorners corners, vec3 origin, vec3 direction, float t_min, float t_max,
         float enough, Starts starts) {
  Hit best = Hit(t_max, no_primitive, vec2(0));
  const FrameRay ray = ray_in_tree(nodes, origin, direction);

  uint stack[bvh_stack_size];  // nodes still to visit, above an end mark
  stack[0] = bvh_end;
  uint depth = 1u;
  uint current = 0u;  // the root is always a node
  uint started = 1u;
  if (starts.list != 0ul) current = TileStarts(starts.list).at[starts.tile * tile_starts].node;
  // Goes down to a leaf first, then tests its triangles: threads of a subgroup thus wait for each other at leaves
  // instead of alternating between nodes and triangles. Most time goes into instructions of the loop over nodes.
  for (;;) {
    while ((current & bvh_leaf_bit) == 0u) {
      const Children met = children_of(nodes, current, ray.node, t_min, best.t);
      stack[depth] = met.farther;  // kept if both are entered
      current = met.nearer;
      if (met.both) ++depth;
      if (met.none) {
        current = stack[--depth];
        if (current == bvh_end) current = next_start(starts, started, depth, best.t);
      }
    }
    if (current == bvh_end) return best;
    for (uint i = first_of_leaf(current); i <= last_of_leaf(current); ++i)
      meet_corners(best, corners, i, t_min, ray);
    if (best.t < enough) return best;
    current = stack[--depth];
    if (current == bvh_end) current = next_start(starts, started, depth, best.t);
  }
}

#endif
