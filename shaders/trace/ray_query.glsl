// SPDX-License-Identifier: Apache-2.0
// trace() by VK_KHR_ray_query.
#extension GL_EXT_ray_query : require
#include "lib/sheared_triangle.glsl"
#include "trace/hit.glsl"

layout(set = 0, binding = 0) uniform accelerationStructureEXT acceleration_structure;

// Triangles of one bottom-level structure; the instance's custom index says which. Small enough for every device's limits.
const uint blas_triangles = 1u << 23;

// Weights of a triangle's second and third vertex where a ray that hits it does. The driver's own are good to 1e-5 at best, which normals
// and reflectivities would show.
vec2 barycentric_of(Parameters parameters, uint triangle, vec3 origin, vec3 direction, vec2 otherwise) {
  const uint first = 3u * triangle;
  const vec3 edges = edge_functions(sheared(shear_along(direction), origin, parameters.at.positions.at[parameters.at.triangles.at[first]],
                                            parameters.at.positions.at[parameters.at.triangles.at[first + 1u]],
                                            parameters.at.positions.at[parameters.at.triangles.at[first + 2u]]));
  precise float area = edges.x + edges.y + edges.z;
  if (area == 0.0) return otherwise;  // seen edge on
  precise vec2 weights = edges.yz * exact_reciprocal(area);
  return weights;
}

Hit trace(Parameters parameters, vec3 origin, vec3 direction, float t_min, float t_max, float enough) {
  Hit hit = Hit(t_max, no_primitive, vec2(0));
  rayQueryEXT query;
  rayQueryInitializeEXT(query, acceleration_structure, gl_RayFlagsOpaqueEXT, 0xFF, origin, t_min, direction, t_max);
  while (rayQueryProceedEXT(query)) {
  }
  // Hit attributes must not be read after a miss.
  if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionTriangleEXT) {
    hit.t = rayQueryGetIntersectionTEXT(query, true);
    hit.id = parameters.at.primitive_ids.at[rayQueryGetIntersectionInstanceCustomIndexEXT(query, true) * blas_triangles +
                                            rayQueryGetIntersectionPrimitiveIndexEXT(query, true)];
    hit.barycentric = barycentric_of(parameters, hit.id & ~surveyed_bit, origin, direction, rayQueryGetIntersectionBarycentricsEXT(query, true));
  }
  return hit;
}
