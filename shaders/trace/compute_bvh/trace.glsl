// SPDX-License-Identifier: Apache-2.0
// trace() over our own binary BVH.
#include "trace/compute_bvh/walk.glsl"

Hit trace(vec3 origin, vec3 direction, float t_min, float t_max, float enough, Starts starts) {
  return walk(bvh_nodes, bvh_corners, origin, direction, t_min, t_max, enough, starts);
}
