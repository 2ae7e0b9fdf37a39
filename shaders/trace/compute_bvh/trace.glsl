// SPDX-License-Identifier: Apache-2.0
// trace() over our own binary BVH, of one level, or of two if nodes share meshes.
#include "lib/scene_triangle.glsl"
#include "trace/compute_bvh/walk.glsl"

// Moves a ray into a mesh's frame, uncontracted, so that all devices do it alike.
FrameRay ray_in_mesh(BvhPlacement place, vec3 origin, vec3 direction) {
  precise vec3 from = origin - place.origin;
  const vec3 moved = vec3(exact_dot(place.row0, from), exact_dot(place.row1, from), exact_dot(place.row2, from));
  const vec3 along = vec3(exact_dot(place.row0, direction), exact_dot(place.row1, direction),
                          exact_dot(place.row2, direction));
  // As in widening_of(): boxes are widened by four times that of their largest coordinate.
  const vec3 far = abs(moved);
  const float widening = max(0.25 * place.widening, max(max(far.x, far.y), far.z) * (1.0 / 524288.0));
  return frame_ray(moved, along, widening, place.widening, place.base);
}

// Works as walk(), over the tree of the scene and those of its shared meshes.
Hit walk_placed(vec3 origin, vec3 direction, float t_min, float t_max, float enough, Starts starts) {
  Hit best = Hit(t_max, no_primitive, vec2(0));
  FrameRay ray = ray_in_tree(bvh_nodes, origin, direction);
  // Nodes still to visit: those of the scene's tree above an end mark, then those of a mesh above another.
  uint stack[2u * bvh_stack_size];
  stack[0] = bvh_end;
  uint depth = 1u;
  uint current = 0u;
  uint started = 1u;
  if (starts.list != 0ul) current = TileStarts(starts.list).at[starts.tile * tile_starts].node;
  for (;;) {
    while ((current & bvh_leaf_bit) == 0u) {
      const Children met = children_of(bvh_nodes, current, ray.node, t_min, best.t);
      stack[depth] = met.farther;  // kept if both are entered
      current = met.nearer;
      if (met.both) ++depth;
      if (met.none) {
        current = stack[--depth];
        if (current == bvh_end) current = next_start(starts, started, depth, best.t);
      }
    }
    if (current == bvh_end) return best;
    if (current == bvh_leave) {
      ray = ray_in_tree(bvh_nodes, origin, direction);
    } else if (((current >> bvh_leaf_count_shift) & 7u) == bvh_placement_count) {
      const BvhPlacement place =
          BvhPlacements(parameters.traversal[bvh_placements_array]).at[current & bvh_leaf_first_mask];
      ray = ray_in_mesh(place, origin, direction);
      stack[depth++] = bvh_leave;
      current = place.root;
      continue;
    } else {
      for (uint i = first_of_leaf(current); i <= last_of_leaf(current); ++i)
        meet_corners(best, bvh_corners, i, t_min, ray);
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
