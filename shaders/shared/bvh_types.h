// SPDX-License-Identifier: Apache-2.0
// What the engine compute_bvh keeps on the device.
#ifndef VANTAGE_SHARED_BVH_TYPES_H
#define VANTAGE_SHARED_BVH_TYPES_H
#include "host.h"

VANTAGE_SHARED_BEGIN

// Places in TraceParameters::traversal.
VANTAGE_CONST uint bvh_nodes_array = 0;      // BvhNode
VANTAGE_CONST uint bvh_triangles_array = 1;  // BvhTriangle

// A binary BVH node: the boxes of both children, by centre and half size, which takes a ray fewer minima and maxima
// than two corners do. A child is a node's index, or a leaf: bit 31, triangle count − 1 in bits 28–30, first triangle
// in the rest. Boxes are larger by `widening` on all sides than what they hold.
VANTAGE_CONST uint bvh_leaf_bit = 0x80000000u;
VANTAGE_CONST uint bvh_leaf_count_shift = 28;
VANTAGE_CONST uint bvh_leaf_first_mask = 0x0FFFFFFFu;
VANTAGE_CONST uint bvh_end = 0xFFFFFFFFu;  // no leaf
VANTAGE_CONST uint bvh_stack_size = 64;
struct BvhNode {
  vec3 centre0;
  uint child0;
  vec3 half0;
  uint child1;
  vec3 centre1;
  float widening;
  vec3 half1;
  uint unused;
};

// A triangle in leaf order; id is the scene's number with the surveyed bit.
struct BvhTriangle {
  vec3 a;
  uint id;
  vec3 b;
  uint unused0;
  vec3 c;
  uint unused1;
};

// A node at which the rays of a tile may start, and how near its box is: infinity where there is none.
struct TileStart {
  uint node;
  float near;
};
VANTAGE_CONST uint tile_starts = 24;  // of every tile, nearest first

VANTAGE_SHARED_END
#endif
