// SPDX-License-Identifier: Apache-2.0
// Counts one station's points in the surveyed voxels (equations 8 and 9): one thread per ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/parameters.glsl"
#include "lib/pattern.glsl"
#include "lib/tiles.glsl"
#include "lib/voxel.glsl"
#include "trace.glsl"
#include "lib/point.glsl"

layout(local_size_x = group_size) in;  // block_columns × block_rows
layout(constant_id = 2) const bool with_masks = true;
layout(constant_id = 3) const bool with_tiles = false;
layout(push_constant, scalar) uniform Push { CountPush push; };

void main() {
  uint row, column;
  float far = parameters.max_range;
  bool alive = true;
  Starts starts = from_the_root;
  if (with_tiles) {
    const uint k = gl_WorkGroupID.z * tile_groups_y + gl_WorkGroupID.y;
    alive = k < push.tile_list.at[0];
    const uint tile = alive ? push.tile_list.at[1u + k] : 0u;
    const uvec2 in_block = place_in_block(gl_LocalInvocationIndex);
    const uint blocks_in_row = tile_side / block_columns;
    row = first_row_of(tile) + (gl_WorkGroupID.x / blocks_in_row) * block_rows + in_block.y;
    column = first_column_of(tile) + (gl_WorkGroupID.x % blocks_in_row) * block_columns + in_block.x;
    far = min(far, push.tile_far.at[tile]);
    starts = Starts(push.starts, k);
  } else {
    const uvec2 ray = ray_of_thread(push.first_row);
    row = ray.x, column = ray.y;
  }
  alive = alive && row < push.first_row + push.row_count && column < parameters.columns;

  bool is_point = false, counted = false;
  uint misses = 0u;
  if (alive) {
    const vec3 direction = ray_direction(row, column, push.turn);
    const Hit hit = trace(push.origin, direction, parameters.min_range, far, want_nearest, starts);
    is_point = hit.id != no_primitive;
    if (is_point && (hit.id & surveyed_bit) != 0u) {
      Look look = unseen;
      if (with_look) look = look_of(hit, direction);
      const vec3 point = point_of(hit, look, push.origin, direction, ray_number(row, column), push.place);
      const uint voxel_index = index_of(point);
      if (voxel_index != no_voxel_index)
        misses = misses_of(hit, look, direction, pass_glass(push.origin, direction, hit.t).share,
                           ray_number(row, column), push.place);
      if (voxel_index != no_voxel_index && misses == 0u) {
        counted = true;
        atomicAdd(push.counts.at[voxel_index], 1u);
        if (with_masks) {
          const uint bit = 1u << (push.place & 31u);
          // Reading first avoids most atomics; a stale read only costs one.
          if ((push.masks.at[voxel_index] & bit) == 0u) atomicOr(push.masks.at[voxel_index], bit);
        }
      }
    }
  }
  const uint points = subgroupAdd(is_point ? 1u : 0u), counted_points = subgroupAdd(counted ? 1u : 0u);
  const uint first_word = 2u * station_counters * (push.place & 63u);  // of its bit
  if (subgroupElect()) {
    if (points > 0u) add64(push.counters, first_word + 2u * counter_points, points);
    if (counted_points > 0u) add64(push.counters, first_word + 2u * counter_counted, counted_points);
  }
  if (with_limits && subgroupMax(misses) > 0u) {
    const uint dropped = subgroupAdd(misses != 0u ? 1u : 0u);
    const uvec4 each = subgroupAdd(uvec4(misses & 1u, misses >> 1 & 1u, misses >> 2 & 1u, misses >> 3 & 1u));
    if (subgroupElect()) {
      add64(push.counters, first_word + 2u * counter_dropped, dropped);
      for (uint k = 0u; k < 4u; ++k)
        if (each[k] > 0u) add64(push.counters, first_word + 2u * (counter_misses + k), each[k]);
    }
  }
}
