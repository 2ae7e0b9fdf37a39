// SPDX-License-Identifier: Apache-2.0
// Finds the hits of a caller's own rays, if float arithmetic is certain of them: one thread per ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/crossing.glsl"
#include "lib/parameters.glsl"
#include "shared/own_ray_types.h"

layout(local_size_x = group_size) in;
layout(constant_id = 0) const uint question = own_rays_nearest;
layout(push_constant, scalar) uniform Push { OwnRaysPush push; };

float infinite() { return uintBitsToFloat(0x7F800000u); }

// State of a walk.
struct Found {
  float near, far;  // interval of the nearest sure hit; nothing beyond its end matters
  float other;      // least distance at which any other triangle may be hit
  uint what;        // triangle of the nearest sure hit, or the number of sure hits
};

// Adds one more triangle. Returns true if nothing else can change the answer.
bool take(inout Found found, OwnRay ray, Crossing met, uint triangle) {
  if (!met.possible || met.far <= ray.from || met.near > ray.range) return false;
  const bool sure = met.sure && met.near > ray.from && met.far <= ray.range;
  if (question == own_rays_nearest) {
    if (sure && met.far < found.far) {
      found.other = min(found.other, found.near);
      found.near = met.near;
      found.far = met.far;
      found.what = triangle;
    } else {
      found.other = min(found.other, met.near);
    }
    return false;
  }
  if (sure)
    ++found.what;
  else
    found.other = met.near;
  return question == own_rays_blocked && sure;
}

// Each engine defines void find(inout Found found, OwnRay ray, float start): it calls take() for every triangle
// numbered below push.end that the ray may meet from `start` to found.far.
#include "find.glsl"

void main() {
  const uint k = thread_of_rows();
  if (k >= push.count) return;
  const vec4 first = push.rays.at[2u * k], second = push.rays.at[2u * k + 1u];
  const OwnRay ray = OwnRay(first.xyz, first.w, second.xyz, second.w);
  const uint nothing = question == own_rays_nearest ? no_primitive : 0u;
  if (ray.range < 0.0) {
    push.answers.at[k] = ray.range == own_ray_open ? open_answer : nothing;
    return;
  }
  // Limits are widened by more than their own rounding. If no hit is sure, a finite `other` means a doubtful one.
  Found found = Found(infinite(), ray.range * (1.0 + doubt_of_depth), infinite(), nothing);
  find(found, ray, max(ray.from * (1.0 - doubt_of_depth), 0.0));
  bool open = found.other < infinite();
  if (question == own_rays_nearest && found.what != no_primitive) open = found.other <= found.far;
  if (question == own_rays_blocked && found.what != 0u) open = false;
  push.answers.at[k] = open ? open_answer : found.what;
}
