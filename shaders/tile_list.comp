// SPDX-License-Identifier: Apache-2.0
// Lists the tiles of some rows that see a surveyed brick, and sizes the dispatch over them: one thread per tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/tiles.glsl"

layout(local_size_x = group_size) in;
layout(push_constant, scalar) uniform Push { TilePush push; };

void main() {
  const uint first = push.first_row / tile_side * tiles_in_row();
  const uint count = (push.row_count + tile_side - 1u) / tile_side * tiles_in_row();
  const uint i = gl_GlobalInvocationID.x;
  if (i >= count || push.tile_far.at[first + i] == 0u) return;
  const uint rows = min(tile_side, push.first_row + push.row_count - first_row_of(first + i));
  const uint columns = min(tile_side, parameters.columns - first_column_of(first + i));
  add64(push.rays, 0u, rows * columns);
  const uint k = atomicAdd(push.tile_list.at[0], 1u);
  push.tile_list.at[1u + k] = first + i;
  if (k == 0u) push.dispatch.at[0] = blocks_per_tile;
  atomicMax(push.dispatch.at[1], min(k + 1u, tile_groups_y));
  atomicMax(push.dispatch.at[2], k / tile_groups_y + 1u);
}
