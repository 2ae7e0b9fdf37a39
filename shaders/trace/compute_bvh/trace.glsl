// SPDX-License-Identifier: Apache-2.0
// trace() over our own binary BVH, of one level, or of two where nodes share meshes.
#include "lib/scene_triangle.glsl"
#include "trace/compute_bvh/walk.glsl"

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

FrameRay ray_in_scene(vec3 origin, vec3 direction) {
  return frame_ray(origin, direction, widening_of(origin), uintBitsToFloat(bvh_nodes.at[2].w), 0u);
}

// Uncontracted, so that all devices move a ray alike.
FrameRay ray_in_mesh(BvhPlacement place, vec3 origin, vec3 direction) {
  precise vec3 from = origin - place.origin;
  const vec3 moved = vec3(exact_dot(place.row0, from), exact_dot(place.row1, from), exact_dot(place.row2, from));
  const vec3 along = vec3(exact_dot(place.row0, direction), exact_dot(place.row1, direction),
                          exact_dot(place.row2, direction));
  // As widening_of(): boxes are widened by four times that of their largest coordinate.
  const vec3 far = abs(moved);
  const float widening = max(0.25 * place.widening, max(max(far.x, far.y), far.z) * (1.0 / 524288.0));
  return frame_ray(moved, along, widening, place.widening, place.base);
}

// As walk(), over the tree of the scene and those of its shared meshes.
Hit walk_placed(vec3 origin, vec3 direction, float t_min, float t_max, float enough, Starts starts) {
  Hit best = Hit(t_max, no_primitive, vec2(0));
  FrameRay ray = ray_in_scene(origin, direction);
  // Nodes still to visit: those of the scene's tree above an end mark, then those of a mesh above another.
  uint stack[2u * bvh_stack_size];
  stack[0] = bvh_end;
  uint depth = 1u;
  uint current = 0u;
  uint started = 1u;
  if (starts.list != 0ul) current = TileStarts(starts.list).at[starts.tile * tile_starts].node;
  for (;;) {
    while ((current & bvh_leaf_bit) == 0u) {
      const uvec4 word0 = bvh_nodes.at[4u * current], word1 = bvh_nodes.at[4u * current + 1u],
                  word2 = bvh_nodes.at[4u * current + 2u], word3 = bvh_nodes.at[4u * current + 3u];
      const uint child0 = word0.w, child1 = word1.w;
      const int first_t = floatBitsToInt(t_min), last_t = floatBitsToInt(best.t);
      const ivec2 way0 =
          passage_of(ray.node, uintBitsToFloat(word0.xyz), uintBitsToFloat(word1.xyz), first_t, last_t);
      const ivec2 way1 =
          passage_of(ray.node, uintBitsToFloat(word2.xyz), uintBitsToFloat(word3.xyz), first_t, last_t);
      const bool hit0 = way0.x <= way0.y, hit1 = way1.x <= way1.y;
      const bool first0 = hit0 && (!hit1 || way0.x <= way1.x);
      stack[depth] = first0 ? child1 : child0;  // kept if both are hit
      current = first0 ? child0 : child1;
      if (hit0 && hit1) ++depth;
      if (!hit0 && !hit1) {
        current = stack[--depth];
        if (current == bvh_end) current = next_start(starts, started, depth, best.t);
      }
    }
    if (current == bvh_end) return best;
    if (current == bvh_leave) {
      ray = ray_in_scene(origin, direction);
    } else if (((current >> bvh_leaf_count_shift) & 7u) == bvh_placement_count) {
      const BvhPlacement place =
          BvhPlacements(parameters.traversal[bvh_placements_array]).at[current & bvh_leaf_first_mask];
      ray = ray_in_mesh(place, origin, direction);
      stack[depth++] = bvh_leave;
      current = place.root;
      continue;
    } else {
      const uint first = current & bvh_leaf_first_mask;
      const uint end = first + ((current >> bvh_leaf_count_shift) & 7u);
      for (uint i = first; i <= end; ++i) {
        const uvec4 word_a = bvh_corners.at[3u * i], word_b = bvh_corners.at[3u * i + 1u],
                    word_c = bvh_corners.at[3u * i + 2u];
        meet_triangle(best, t_min, ray.shear, ray.origin, ray.inverse, ray.widening, uintBitsToFloat(word_a.xyz),
                      uintBitsToFloat(word_b.xyz), uintBitsToFloat(word_c.xyz), word_a.w + ray.base);
      }
      if (best.t < enough) return best;
    }
    current = stack[--depth];
    if (current == bvh_end) current = next_start(starts, started, depth, best.t);
  }
}

Hit trace(vec3 origin, vec3 direction, float t_min, float t_max, float enough, Starts starts) {
  if (with_shared) return walk_placed(origin, direction, t_min, t_max, enough, starts);
  return walk(bvh_nodes, bvh_corners, origin, direction, t_min, t_max, enough, starts);
}
