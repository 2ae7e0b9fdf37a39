// SPDX-License-Identifier: Apache-2.0
// find() of own_rays.comp over our own binary BVH. Its boxes are widened by more than the error of rays.
#include "lib/scene_triangle.glsl"
#include "trace/compute_bvh/own_frame.glsl"
#include "trace/compute_bvh/walk.glsl"

struct OwnFrame {
  Line line;
  NodeRay node;
  uint base;  // added to ids of triangles
};

OwnFrame own_frame(OwnRay ray) {
  return OwnFrame(line_along(ray.origin, ray.direction, scene_doubt(ray.origin)),
                  node_ray(ray.origin, inverse_of(ray.direction), widening_of(ray.origin),
                           uintBitsToFloat(bvh_nodes.at[2].w)),
                  0u);
}

OwnFrame own_frame_of(BvhPlacement place, OwnRay ray) {
  const MovedRay moved = moved_into(place, ray.origin, ray.direction);
  const float widening = max(0.25 * place.widening, largest_of(moved.origin) * (1.0 / 524288.0)) + moved.doubt;
  return OwnFrame(line_along(moved.origin, moved.direction, moved.doubt),
                  node_ray(moved.origin, inverse_of(moved.direction), widening, place.widening), place.base);
}

void find(inout Found found, OwnRay ray, float start) {
  OwnFrame frame = own_frame(ray);
  // Nodes still to visit: those of the scene's tree above an end mark, then those of a mesh above another.
  uint stack[2u * bvh_stack_size];
  stack[0] = bvh_end;
  uint depth = 1u;
  uint current = 0u;
  for (;;) {
    while ((current & bvh_leaf_bit) == 0u) {
      const Children met = children_of(bvh_nodes, current, frame.node, start, found.far);
      stack[depth] = met.farther;  // kept if both are entered
      current = met.nearer;
      if (met.both) ++depth;
      if (met.none) current = stack[--depth];
    }
    if (current == bvh_end) return;
    if (with_shared && current == bvh_leave) {
      frame = own_frame(ray);
    } else if (with_shared && ((current >> bvh_leaf_count_shift) & 7u) == bvh_placement_count) {
      const BvhPlacement place =
          BvhPlacements(parameters.traversal[bvh_placements_array]).at[current & bvh_leaf_first_mask];
      frame = own_frame_of(place, ray);
      stack[depth++] = bvh_leave;
      current = place.root;
      continue;
    } else {
      for (uint i = first_of_leaf(current); i <= last_of_leaf(current); ++i) {
        const uvec4 a = bvh_corners.at[3u * i], b = bvh_corners.at[3u * i + 1u], c = bvh_corners.at[3u * i + 2u];
        const uint triangle = a.w + frame.base;
        if (triangle >= push.end) continue;
        const Crossing met = crossing_of(frame.line, uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz),
                                         uintBitsToFloat(c.xyz));
        if (take(found, ray, met, triangle)) return;
      }
    }
    current = stack[--depth];
  }
}
