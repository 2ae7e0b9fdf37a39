// SPDX-License-Identifier: Apache-2.0
// Surveyed voxels on the device: bricks of 8³ voxels in Morton order, found through an open-addressing hash table.
#ifndef VANTAGE_SHARED_VOXEL_TYPES_H
#define VANTAGE_SHARED_VOXEL_TYPES_H
#include "host.h"

VANTAGE_SHARED_BEGIN

VANTAGE_CONST uint brick_bits = 3;            // a brick has 2^3 voxels per side
VANTAGE_CONST uint brick_mask_words = 16;     // 512 bits
VANTAGE_CONST uint empty_slot = 0xFFFFFFFFu;  // BrickSlot::brick of an empty slot

// Bit m of the mask (word m / 32, bit m % 32) is the voxel whose Morton code within the brick is m. A voxel's index is
// first + the number of set bits below it, which is its position in Morton order.
struct VoxelBrick {
  uint x, y, z;  // brick coordinates: voxel coordinates / 8
  uint first;
  uint mask[brick_mask_words];
};

// A brick's first slot is brick_hash(x, y, z) & (slot count − 1); on a collision the next one, cyclically.
struct BrickSlot {
  uint x, y, z;
  uint brick;  // index into the bricks, or empty_slot
};

VANTAGE_INLINE uint brick_hash(uint x, uint y, uint z) {
  uint h = (x * 0x9E3779B1u) ^ (y * 0x85EBCA77u) ^ (z * 0xC2B2AE3Du);
  h ^= h >> 15;
  h *= 0x2C1B3C6Du;
  return h ^ (h >> 12);
}

VANTAGE_SHARED_END
#endif
