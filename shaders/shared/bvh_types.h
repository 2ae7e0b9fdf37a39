// SPDX-License-Identifier: Apache-2.0
// Data of the engine compute_bvh on the device.
#ifndef VANTAGE_SHARED_BVH_TYPES_H
#define VANTAGE_SHARED_BVH_TYPES_H
#include "host.h"

VANTAGE_SHARED_BEGIN

// Indices into TraceParameters::traversal.
VANTAGE_CONST uint bvh_nodes_array = 0;       // BvhNode
VANTAGE_CONST uint bvh_triangles_array = 1;   // BvhTriangle
VANTAGE_CONST uint bvh_placements_array = 2;  // BvhPlacement, if meshes are shared

// A binary BVH node: boxes of both children, as centre and half size, which needs fewer minima and maxima per ray than
// two corners. A child is a node's index, or a leaf: bit 31, triangle count − 1 in bits 28–30, first triangle in the
// rest. Boxes exceed their contents by `widening` on all sides.
VANTAGE_CONST uint bvh_leaf_bit = 0x80000000u;
VANTAGE_CONST uint bvh_leaf_count_shift = 28;
VANTAGE_CONST uint bvh_leaf_first_mask = 0x0FFFFFFFu;
VANTAGE_CONST uint bvh_end = 0xFFFFFFFFu;  // no leaf
// If nodes share meshes, the tree from node 0 on has leaves that place a mesh. These have a count that no other leaf
// has; the rest is an index of BvhPlacement.
VANTAGE_CONST uint bvh_placement_count = 7;
VANTAGE_CONST uint bvh_leave = 0xFFFFFFFEu;  // no leaf: end of a mesh
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

// A triangle in leaf order; id is the scene's number with the surveyed bit, or the number in its shared mesh.
struct BvhTriangle {
  vec3 a;
  uint id;
  vec3 b;
  uint unused0;
  vec3 c;
  uint unused1;
};

// One placement of a mesh that nodes share.
struct BvhPlacement {
  vec3 row0;  // of the linear part of mesh_from_local
  uint root;  // node of the mesh's own tree, in its own frame
  vec3 row1;
  uint base;  // added to ids of its triangles
  vec3 row2;
  float widening;  // of the mesh's boxes
  vec3 origin;     // of the mesh, in the local frame
  float doubt;     // error of its corners for a ray, in its frame, per metre of the distances involved
};

// A node at which rays of a tile may start, and the distance of its box; infinity in unused entries.
struct TileStart {
  uint node;
  float near;
};
VANTAGE_CONST uint tile_starts = 24;  // per tile, nearest first

VANTAGE_SHARED_END
#endif
