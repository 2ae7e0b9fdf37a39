// SPDX-License-Identifier: Apache-2.0
// Finds the index of a point's surveyed voxel: cell, brick by hash, bit in the brick's mask.
#ifndef VANTAGE_LIB_VOXEL
#define VANTAGE_LIB_VOXEL
#include "lib/parameters.glsl"

// Finds voxel coordinates, as VoxelGrid::cell_of does, to the bit; returns false outside the voxels' cube.
bool cell_of(vec3 p, out uvec3 cell) {
  precise vec3 q = p - parameters.voxel_min;
  precise vec3 scaled = q * parameters.voxel_inverse_size;
  const vec3 floored = floor(scaled);
  const float cells = float(parameters.voxel_cells);
  if (any(lessThan(floored, vec3(0))) || any(greaterThanEqual(floored, vec3(cells)))) return false;
  cell = uvec3(floored);
  return true;
}

uint index_of_cell(uvec3 cell) {
  const uvec3 b = cell >> brick_bits;
  uint slot = brick_hash(b.x, b.y, b.z) & parameters.slot_mask;
  for (;;) {
    const BrickSlot s = parameters.slots.at[slot];
    if (s.brick == empty_slot) return no_voxel_index;
    if (s.x == b.x && s.y == b.y && s.z == b.z) {
      slot = s.brick;
      break;
    }
    slot = (slot + 1u) & parameters.slot_mask;
  }
  // Morton code within the brick: 3 bits per side.
  const uvec3 m = cell & 7u;
  const uvec3 spread = (m & 1u) | (m & 2u) << 2 | (m & 4u) << 4;
  const uint code = spread.x | spread.y << 1 | spread.z << 2;
  // The brick's 16 bytes of position and first index, then four quarters of its mask.
  const uint brick = brick_quarters * slot, quarter = code >> 7, word = code >> 5 & 3u;
  const uvec4 bits = parameters.bricks.at[brick + 1u + quarter];
  const uint one = 1u << (code & 31u);
  const uint all = 0xFFFFFFFFu;
  const uvec4 below = uvec4(word > 0u ? all : one - 1u, word > 1u ? all : word == 1u ? one - 1u : 0u,
                            word > 2u ? all : word == 2u ? one - 1u : 0u, word == 3u ? one - 1u : 0u);
  const uvec4 at = uvec4(word == 0u ? one : 0u, word == 1u ? one : 0u, word == 2u ? one : 0u, word == 3u ? one : 0u);
  if ((bits & at) == uvec4(0)) return no_voxel_index;
  ivec4 set = bitCount(bits & below);
  for (uint q = 0; q < quarter; ++q) set += bitCount(parameters.bricks.at[brick + 1u + q]);
  return parameters.bricks.at[brick].w + uint(set.x + set.y + set.z + set.w);
}

uint index_of(vec3 p) {
  uvec3 cell;
  return cell_of(p, cell) ? index_of_cell(cell) : no_voxel_index;
}

#endif
