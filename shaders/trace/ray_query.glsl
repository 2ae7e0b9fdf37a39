// SPDX-License-Identifier: Apache-2.0
// trace() by VK_KHR_ray_query.
#extension GL_EXT_ray_query : require
#include "trace/hit.glsl"

layout(set = 0, binding = 0) uniform accelerationStructureEXT acceleration_structure;

// Triangles of one bottom-level structure; the instance's custom index says which. Small enough for every device's limits.
const uint blas_triangles = 1u << 23;

Hit trace(Parameters parameters, vec3 origin, vec3 direction, float t_min, float t_max, float enough) {
  Hit hit = Hit(t_max, no_primitive, vec2(0));
  rayQueryEXT query;
  rayQueryInitializeEXT(query, acceleration_structure, gl_RayFlagsOpaqueEXT, 0xFF, origin, t_min, direction, t_max);
  while (rayQueryProceedEXT(query)) {
  }
  // Hit attributes must not be read after a miss.
  if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionTriangleEXT) {
    hit.t = rayQueryGetIntersectionTEXT(query, true);
    hit.barycentric = rayQueryGetIntersectionBarycentricsEXT(query, true);
    hit.id = parameters.at.primitive_ids.at[rayQueryGetIntersectionInstanceCustomIndexEXT(query, true) * blas_triangles +
                                            rayQueryGetIntersectionPrimitiveIndexEXT(query, true)];
  }
  return hit;
}
