// SPDX-License-Identifier: Apache-2.0
// Limits of a point: angle of incidence, footprint of the beam, range noise and strength of the echo (docs/method.md).
// Uses only additions, multiplications and comparisons, so that every device decides alike.
#ifndef VANTAGE_LIB_LIMITS
#define VANTAGE_LIB_LIMITS
#include "lib/exact.glsl"
#include "lib/parameters.glsl"
#include "lib/shade.glsl"

uint limits_missed(uint triangle, vec3 normal, float reflectivity, vec3 direction, float t, float passed) {
  const PointLimits limits = parameters.limits.at[parameters.limits_of.at[stored_of(triangle).surface]];
  const float cosine = exact_dot(normal, direction);
  precise float square = cosine * cosine;
  uint misses = square < limits.least_cosine_square ? misses_incidence : 0u;
  if (limits.largest_footprint_square > 0.0) {
    precise float widened = parameters.divergence * t;
    precise float at_exit = parameters.exit_diameter * parameters.exit_diameter;
    precise float added = widened * widened;
    precise float area = at_exit + added;
    precise float allowed = limits.largest_footprint_square * square;
    if (area > allowed) misses |= misses_footprint;
  }
  if (limits.largest_sigma > 0.0 && sigma_at(t, reflectivity) > limits.largest_sigma) misses |= misses_noise;
  if (limits.largest_reach_square > 0.0) {
    precise float distance_square = t * t;
    precise float open = limits.largest_reach_square * abs(cosine);
    precise float reached = open * passed;
    if (distance_square > reached) misses |= misses_echo;
  }
  return misses;
}

// Returns true if the echo of this ray is lost at random.
bool is_lost(uint64_t ray, uint place) {
  return parameters.lost_below > 0u && random_bits(ray, place, dropout_stream) < parameters.lost_below;
}

#endif
