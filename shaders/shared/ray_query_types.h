// SPDX-License-Identifier: Apache-2.0
// Shared by the engine ray_query and its shader.
#ifndef VANTAGE_SHARED_RAY_QUERY_TYPES_H
#define VANTAGE_SHARED_RAY_QUERY_TYPES_H
#include "host.h"

VANTAGE_SHARED_BEGIN

// Index into TraceParameters::traversal: map from triangles of the acceleration structure to the scene's numbers with
// the surveyed bit.
VANTAGE_CONST uint primitive_ids_array = 0;
// Triangles of one bottom-level structure, numbered by the instance's custom index. Within every device's limits.
VANTAGE_CONST uint blas_triangles = 1u << 23;

VANTAGE_SHARED_END
#endif
