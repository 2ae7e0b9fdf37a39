// SPDX-License-Identifier: Apache-2.0
// A caller's own rays in the frame of a mesh that nodes share.
#ifndef VANTAGE_TRACE_COMPUTE_BVH_OWN_FRAME
#define VANTAGE_TRACE_COMPUTE_BVH_OWN_FRAME
#include "lib/crossing.glsl"
#include "lib/exact.glsl"
#include "trace/compute_bvh/nodes.glsl"

struct MovedRay {
  vec3 origin, direction;
  float doubt;  // error of the placed mesh's rounded corners for the ray
};

MovedRay moved_into(BvhPlacement place, vec3 origin, vec3 direction) {
  precise vec3 from = origin - place.origin;
  return MovedRay(
      vec3(exact_dot(place.row0, from), exact_dot(place.row1, from), exact_dot(place.row2, from)),
      vec3(exact_dot(place.row0, direction), exact_dot(place.row1, direction), exact_dot(place.row2, direction)),
      place.doubt * max(max(scene_size(), largest_of(origin)), largest_of(place.origin)));
}

#endif
