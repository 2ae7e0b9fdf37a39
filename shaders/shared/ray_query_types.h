// SPDX-License-Identifier: Apache-2.0
// What the engine ray_query and its shader agree on.
#ifndef VANTAGE_SHARED_RAY_QUERY_TYPES_H
#define VANTAGE_SHARED_RAY_QUERY_TYPES_H
#include "host.h"

VANTAGE_SHARED_BEGIN

// Place in TraceParameters::traversal: from triangles of the acceleration structure to the scene's numbers with the
// surveyed bit.
VANTAGE_CONST uint primitive_ids_array = 0;
// Triangles of one bottom-level structure; the instance's custom index says which. Small enough for every device's
// limits.
VANTAGE_CONST uint blas_triangles = 1u << 23;

VANTAGE_SHARED_END
#endif
