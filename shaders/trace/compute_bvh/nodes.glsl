// SPDX-License-Identifier: Apache-2.0
// The tree in device memory: BvhNode and BvhTriangle, 16 bytes at a time, and starts of tiles.
#ifndef VANTAGE_TRACE_COMPUTE_BVH_NODES
#define VANTAGE_TRACE_COMPUTE_BVH_NODES
#include "lib/parameters.glsl"
#include "shared/bvh_types.h"

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer NodeQuarters { uvec4 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer TriangleCorners { uvec4 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer BvhPlacements { BvhPlacement at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer TileStarts { TileStart at[]; };

#define bvh_nodes NodeQuarters(parameters.traversal[bvh_nodes_array])
#define bvh_corners TriangleCorners(parameters.traversal[bvh_triangles_array])

#endif
