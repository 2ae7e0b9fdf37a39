// SPDX-License-Identifier: Apache-2.0
// The engine that this compilation is for.
#if defined(ENGINE_RAY_QUERY)
#include "trace/ray_query.glsl"
#elif defined(ENGINE_COMPUTE_BVH)
#include "trace/compute_bvh.glsl"
#else
#error "define an engine"
#endif
