// SPDX-License-Identifier: Apache-2.0
// trace() over all triangles, one after the other. Packs of eight share a box, and crates of eight packs; what lies in
// a box that the ray misses, or enters behind its best hit, is passed over.
#include "lib/triangle_hit.glsl"

const uint fan = 8u;  // as in brute_force.cpp

Hit trace(vec3 origin, vec3 direction, float t_min, float t_max, float enough, Starts starts) {
  Vec3s corners = Vec3s(parameters.traversal[0]);
  Vec3s boxes = Vec3s(parameters.traversal[1]);  // of a crate, then of its packs; and so on
  Uints ids = Uints(parameters.traversal[2]);    // no_primitive after the last
  const Shear shear = shear_along(direction);
  const vec3 inverse = inverse_of(direction);
  const float widening = widening_of(origin);
  const SlabRay ray = slab_ray(origin, inverse, 2.0 * widening);
  Hit best = Hit(t_max, no_primitive, vec2(0));
  for (uint box = 0u, first = 0u; ids.at[first] != no_primitive && best.t >= enough;) {
    const bool crate = box % (fan + 1u) == 0u;
    const vec2 way = passage_of(ray, boxes.at[2u * box], boxes.at[2u * box + 1u]);
    const bool entered = max(way.x, t_min) <= min(way.y, best.t);
    ++box;
    if (crate) {
      if (entered) continue;  // with its first pack
      box += fan;
      first += fan * fan;
    } else {
      for (uint i = first; entered && i < first + fan; ++i)
        meet_triangle(best, t_min, shear, origin, inverse, widening, corners.at[3u * i], corners.at[3u * i + 1u],
                      corners.at[3u * i + 2u], ids.at[i]);
      first += fan;
    }
  }
  return best;
}
