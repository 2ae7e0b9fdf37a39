// SPDX-License-Identifier: Apache-2.0
// Directions of the scan pattern, from tables that the host computed in double.
#ifndef VANTAGE_LIB_PATTERN
#define VANTAGE_LIB_PATTERN
#include "lib/list.glsl"
#include "lib/parameters.glsl"
#include "lib/turn.glsl"

// Returns a ray's direction. `turn`: the station's, read only if it is turned.
vec3 ray_direction(uint row, uint column, vec3 turn[3]) {
  const float s = parameters.sin_zenith.at[row];
  const uint azimuth = listed ? row : column;
  precise vec3 d = vec3(s * parameters.cos_azimuth.at[azimuth], s * parameters.sin_azimuth.at[azimuth],
                        parameters.cos_zenith.at[row]);
  if (turned) d = turn_direction(turn, d);
  return d;
}

// Returns a ray's number within its station's pattern.
uint64_t ray_number(uint row, uint column) { return uint64_t(row) * parameters.columns + column; }

vec3 point_on_ray(vec3 origin, vec3 direction, float t) {
  precise vec3 step = t * direction;
  precise vec3 p = origin + step;
  return p;
}

// Places a workgroup's rays in a block of 16 × 8: 8 in sequence form 4 × 2, and 32 form 8 × 4, so that a subgroup's
// rays stay together.
uvec2 place_in_block(uint i) {
  const uint column = (i & 3u) | ((i >> 3) & 1u) << 2 | ((i >> 5) & 1u) << 3;
  const uint row = ((i >> 2) & 1u) | ((i >> 4) & 1u) << 1 | ((i >> 6) & 1u) << 2;
  return uvec2(column, row);
}

// Returns row and column of a thread's ray in a dispatch over rows from `first_row` on; rays of a list follow each
// other.
uvec2 ray_of_thread(uint first_row) {
  if (listed) return uvec2(first_row + gl_WorkGroupID.y * group_size + gl_LocalInvocationIndex, 0u);
  const uvec2 in_block = place_in_block(gl_LocalInvocationIndex);
  return uvec2(first_row + gl_WorkGroupID.y * block_rows + in_block.y,
               gl_WorkGroupID.x * block_columns + in_block.x);
}

#endif
