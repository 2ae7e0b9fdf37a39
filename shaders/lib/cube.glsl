// SPDX-License-Identifier: Apache-2.0
// A voxel relative to a station.
#ifndef VANTAGE_LIB_CUBE
#define VANTAGE_LIB_CUBE
#include "lib/parameters.glsl"
#include "shared/noise_types.h"

// Box relative to the origin, widened by more than the rounding between a hit and its cell, so that no ray with a point
// in the cell is missed.
struct Cube {
  vec3 low;
  float side;
  float slack;
  float noise;  // noise moves no hit that may end up in the cube further along its ray
};

vec3 high_of(Cube cube) { return cube.low + cube.side; }
vec3 centre_of(Cube cube) { return cube.low + 0.5 * cube.side; }
// Returns an upper bound on the distance from the station to points of the cube.
float farthest_of(Cube cube) { return length(max(abs(cube.low), abs(high_of(cube)))); }

// Bounds how far noise moves a hit nearer than t; counterpart of noise_reach.hpp.
float reach_within(float t) {
  if (!GIVEN(parameters.reaches)) return 0.0;
  const float last = float(noise_table_side - 1u);
  const float column = (t - parameters.noise_min_range) * parameters.noise_inverse_span * last + 1.01;
  return parameters.reaches.at[uint(clamp(column, 0.0, last))];
}

Cube cube_of(SampleVoxel voxel, vec3 origin) {
  const float size = 1.0 / parameters.voxel_inverse_size;
  const vec3 corner = parameters.voxel_min + vec3(voxel.x, voxel.y, voxel.z) * size;
  const vec3 largest = max(abs(corner), abs(origin)) + size;
  const float slack = max(max(largest.x, largest.y), largest.z) * (1.0 / 262144.0);
  Cube cube = Cube(corner - origin - slack, size + 2.0 * slack, slack, 0.0);
  cube.noise = reach_within(farthest_of(cube) + parameters.noise_reach);
  return cube;
}

// Returns the interval of the ray inside the cube: from x to y, empty if x > y.
vec2 passage(Cube cube, vec3 direction) {
  const vec3 safe = vec3(abs(direction.x) < 1e-12 ? 1e-12 : direction.x, abs(direction.y) < 1e-12 ? 1e-12 : direction.y,
                         abs(direction.z) < 1e-12 ? 1e-12 : direction.z);
  const vec3 a = cube.low / safe, b = high_of(cube) / safe;
  const vec3 near = min(a, b), far = max(a, b);
  return vec2(max(max(near.x, near.y), near.z), min(min(far.x, far.y), far.z));
}

// Returns how far before a ray's passage through the cube a hit may lie and still put a point there.
float reach_of(Cube cube) { return cube.noise + cube.slack; }

#endif
