// SPDX-License-Identifier: Apache-2.0
// Turns a hit into the point that the scanner reports.
#ifndef VANTAGE_LIB_POINT
#define VANTAGE_LIB_POINT
#include "lib/glass.glsl"
#include "lib/limits.glsl"
#include "lib/pattern.glsl"
#include "lib/shade.glsl"
#include "trace/hit.glsl"

layout(constant_id = 0) const bool with_noise = false;
layout(constant_id = 1) const bool with_limits = false;
const bool with_look = with_noise || with_limits;

// Appearance of a hit as seen from the ray's origin.
struct Look {
  vec3 normal;
  float reflectivity;
};
const Look unseen = Look(vec3(0), 0.0);

Look look_of(Hit hit, vec3 direction) {
  const StoredTriangle stored = stored_of(hit.id & ~surveyed_bit);
  const vec3 normal = oriented_normal(stored, hit.barycentric, direction);
  return Look(normal, reflectivity_of(stored, normal, direction));
}

// Returns the measured range. `look` is read only with noise.
float range_of(Hit hit, Look look, uint64_t ray, uint place) {
  return with_noise ? noisy_range(hit.t, look.reflectivity, ray, place) : hit.t;
}

vec3 point_of(Hit hit, Look look, vec3 origin, vec3 direction, uint64_t ray, uint place) {
  return point_on_ray(origin, direction, range_of(hit, look, ray, place));
}

// Returns the limits that a ray's hit misses, one bit each. Its point counts if there are none and the mesh is
// surveyed. `look` is read only with limits. `passed`: share of the echo's strength that passes glass.
uint misses_of(Hit hit, Look look, vec3 direction, float passed, uint64_t ray, uint place) {
  if (!with_limits) return 0u;
  return limits_missed(hit.id & ~surveyed_bit, look.normal, look.reflectivity, direction, hit.t, passed) |
         (is_lost(ray, place) ? misses_echo : 0u);
}

#endif
