// SPDX-License-Identifier: Apache-2.0
// Projects the surveyed bricks onto the sphere of directions around a station: one thread per brick. Every tile of rays
// that may see a brick gets the distance of the farthest one; the other tiles see nothing that counts. Bricks are
// widened by the noise's reach and by more than all rounding, so that nothing that counts is lost.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/rays_of_box.glsl"
#include "lib/tiles.glsl"
#include "lib/turn.glsl"

layout(local_size_x = group_size) in;
layout(push_constant, scalar) uniform Push { TilePush push; };

void mark(int row0, int row1, int column0, int column1, uint far) {
  if (row0 > row1 || column0 > column1) return;
  for (uint r = uint(row0) / tile_side; r <= uint(row1) / tile_side; ++r)
    for (uint c = uint(column0) / tile_side; c <= uint(column1) / tile_side; ++c) {
      const uint tile = r * tiles_in_row() + c;
      // Reading first avoids most atomics; values only grow.
      if (push.tile_far.at[tile] < far) atomicMax(push.tile_far.at[tile], far);
    }
}

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= parameters.brick_count) return;
  const uvec3 brick = parameters.bricks.at[brick_quarters * i].xyz;
  const float size = parameters.brick_size;
  const vec3 corner = parameters.voxel_min + vec3(brick) * size;
  const vec3 largest = max(abs(corner), abs(push.origin)) + size;
  const float slack = max(max(largest.x, largest.y), largest.z) * (1.0 / 262144.0) + parameters.noise_reach;
  vec3 low = corner - push.origin - slack, high = corner - push.origin + (size + slack);
  if (length(clamp(vec3(0), low, high)) > parameters.max_range) return;
  const uint far = floatBitsToUint(length(max(abs(low), abs(high))) * 1.0001);
  if (turned) turn_back(push.turn, low, high);
  const RayWindow window = rays_of_box(low, high);
  mark(window.row0, window.row1, window.column0, window.column1, far);
  mark(window.row0, window.row1, window.wrapped0, window.wrapped1, far);
}
