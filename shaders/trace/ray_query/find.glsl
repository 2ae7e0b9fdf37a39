// SPDX-License-Identifier: Apache-2.0
// find() of own_rays.comp by VK_KHR_ray_query, over boxes around triangles. A driver may decide about its own triangles
// as it likes near edges, but it reports every box that a ray meets. Boxes are widened by more than the error of rays,
// the driver's own roundings included.
#extension GL_EXT_ray_query : require
#include "lib/scene_triangle.glsl"
#include "shared/ray_query_types.h"
#include "trace/compute_bvh/own_frame.glsl"

layout(set = 0, binding = 1) uniform accelerationStructureEXT acceleration_structure;

void find(inout Found found, OwnRay ray, float start) {
  const Line line = line_along(ray.origin, ray.direction, scene_doubt(ray.origin));
  Line mesh_line = line;
  uint mesh_instance = no_primitive;  // owner of mesh_line
  TriangleCorners corners = TriangleCorners(parameters.traversal[primitive_ids_array]);
  rayQueryEXT query;
  rayQueryInitializeEXT(query, acceleration_structure, gl_RayFlagsNoneEXT, 0xFF, ray.origin, start, ray.direction,
                        min(found.far, 1e30));
  while (rayQueryProceedEXT(query)) {
    const uint instance = rayQueryGetIntersectionInstanceCustomIndexEXT(query, false);
    uint i = rayQueryGetIntersectionPrimitiveIndexEXT(query, false), base = 0u;
    bool placed = false;
    if (with_shared) {
      const BvhPlacement place = BvhPlacements(parameters.traversal[query_instances_array]).at[instance];
      i += place.root;
      base = place.base;
      placed = place.doubt > 0.0;
      if (placed && instance != mesh_instance) {
        const MovedRay moved = moved_into(place, ray.origin, ray.direction);
        mesh_line = line_along(moved.origin, moved.direction, moved.doubt);
        mesh_instance = instance;
      }
    } else {
      i += instance * blas_triangles;
    }
    const uvec4 a = corners.at[3u * i], b = corners.at[3u * i + 1u], c = corners.at[3u * i + 2u];
    const uint triangle = a.w + base;
    if (triangle >= push.end) continue;
    const Line own = placed ? mesh_line : line;
    const Crossing met = crossing_of(own, uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz), uintBitsToFloat(c.xyz));
    const float far = found.far;
    if (take(found, ray, met, triangle)) {
      rayQueryTerminateEXT(query);
      return;
    }
    // Ends the walk at the nearest sure hit.
    if (found.far < far) rayQueryGenerateIntersectionEXT(query, max(found.far, start));
  }
}
