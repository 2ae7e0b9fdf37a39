// SPDX-License-Identifier: Apache-2.0
// Shared by the engine ray_query and its shader.
#ifndef VANTAGE_SHARED_RAY_QUERY_TYPES_H
#define VANTAGE_SHARED_RAY_QUERY_TYPES_H
#include "host.h"

VANTAGE_SHARED_BEGIN

// Indices into TraceParameters::traversal.
VANTAGE_CONST uint primitive_ids_array = 0;    // map from triangles of the acceleration structure to Hit::id
VANTAGE_CONST uint query_instances_array = 1;  // QueryInstance, if meshes are shared
// Triangles of one bottom-level structure, numbered by the instance's custom index. Within every device's limits.
VANTAGE_CONST uint blas_triangles = 1u << 23;

// Instance of a bottom-level structure in a scene that shares meshes: Hit::id of its triangle k is entry first + k of
// the map, plus `base`.
struct QueryInstance {
  uint first;
  uint base;
};

VANTAGE_SHARED_END
#endif
