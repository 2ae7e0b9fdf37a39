// SPDX-License-Identifier: Apache-2.0
// trace() by VK_KHR_ray_query.
#extension GL_EXT_ray_query : require
#include "lib/scene_triangle.glsl"
#include "lib/sheared_triangle.glsl"
#include "shared/ray_query_types.h"
#include "trace/hit.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer QueryInstances { QueryInstance at[]; };

layout(set = 0, binding = 1) uniform accelerationStructureEXT acceleration_structure;

// Returns the weights of a triangle's second and third vertex at a hit. The driver's own are accurate to 1e-5 at best,
// which would show in normals and reflectivities.
vec2 barycentric_of(uint triangle, vec3 origin, vec3 direction, vec2 otherwise) {
  const Corners corners = corners_of(triangle, origin);
  const vec3 edges = edge_functions(sheared(shear_along(direction), vec3(0), corners.a, corners.b, corners.c));
  precise float area = edges.x + edges.y + edges.z;
  if (area == 0.0) return otherwise;  // seen edge on
  precise vec2 weights = edges.yz * exact_reciprocal(area);
  return weights;
}

Hit trace(vec3 origin, vec3 direction, float t_min, float t_max, float enough, Starts starts) {
  Hit hit = Hit(t_max, no_primitive, vec2(0));
  rayQueryEXT query;
  rayQueryInitializeEXT(query, acceleration_structure, gl_RayFlagsOpaqueEXT, 0xFF, origin, t_min, direction, t_max);
  while (rayQueryProceedEXT(query)) {
  }
  // Hit attributes must not be read after a miss.
  if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionTriangleEXT) {
    hit.t = rayQueryGetIntersectionTEXT(query, true);
    const uint structure = rayQueryGetIntersectionInstanceCustomIndexEXT(query, true);
    QueryInstance instance = QueryInstance(structure * blas_triangles, 0u);
    if (with_shared) instance = QueryInstances(parameters.traversal[query_instances_array]).at[structure];
    hit.id = Uints(parameters.traversal[primitive_ids_array])
                 .at[instance.first + rayQueryGetIntersectionPrimitiveIndexEXT(query, true)] + instance.base;
    // The scene's own arrays are present whenever an output depends on the weights.
    if (GIVEN(parameters.positions))
      hit.barycentric = barycentric_of(hit.id & ~surveyed_bit, origin, direction,
                                       rayQueryGetIntersectionBarycentricsEXT(query, true));
  }
  return hit;
}
