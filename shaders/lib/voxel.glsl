// SPDX-License-Identifier: Apache-2.0
// From a point to the rank of its surveyed voxel: cell, brick by hash, bit in the brick's mask.
#ifndef VANTAGE_LIB_VOXEL
#define VANTAGE_LIB_VOXEL
#include "lib/parameters.glsl"

// Voxel coordinates. Mirrors VoxelGrid::cell_of to the bit.
bool cell_of(vec3 p, out uvec3 cell) {
  precise vec3 q = p - parameters.voxel_min;
  precise vec3 scaled = q * parameters.voxel_inverse_size;
  const vec3 floored = floor(scaled);
  const float cells = float(parameters.voxel_cells);
  if (any(lessThan(floored, vec3(0))) || any(greaterThanEqual(floored, vec3(cells)))) return false;
  cell = uvec3(floored);
  return true;
}

uint rank_of_cell(uvec3 cell) {
  const uvec3 b = cell >> brick_bits;
  uint slot = brick_hash(b.x, b.y, b.z) & parameters.slot_mask;
  for (;;) {
    const BrickSlot s = parameters.slots.at[slot];
    if (s.brick == empty_slot) return no_rank;
    if (s.x == b.x && s.y == b.y && s.z == b.z) {
      slot = s.brick;
      break;
    }
    slot = (slot + 1u) & parameters.slot_mask;
  }
  // Morton code within the brick: 3 bits a side.
  const uvec3 m = cell & 7u;
  const uvec3 spread = (m & 1u) | (m & 2u) << 2 | (m & 4u) << 4;
  const uint code = spread.x | spread.y << 1 | spread.z << 2;
  const uint word = code >> 5;
  const uint bits = parameters.bricks.at[slot].mask[word];
  if ((bits >> (code & 31u) & 1u) == 0u) return no_rank;
  uint rank = parameters.bricks.at[slot].first + bitCount(bits & ((1u << (code & 31u)) - 1u));
  for (uint w = 0; w < word; ++w) rank += bitCount(parameters.bricks.at[slot].mask[w]);
  return rank;
}

uint rank_of(vec3 p) {
  uvec3 cell;
  return cell_of(p, cell) ? rank_of_cell(cell) : no_rank;
}

#endif
