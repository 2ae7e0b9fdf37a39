// SPDX-License-Identifier: Apache-2.0
// Occlusion of a cube by a triangle in front of it, with margins above any engine's rounding. A part reported as hidden
// is hidden on every engine; other parts may be hidden as well.
#ifndef VANTAGE_LIB_OCCLUDER
#define VANTAGE_LIB_OCCLUDER
#include "lib/cube.glsl"
#include "lib/scene_triangle.glsl"

// A triangle as its station sees it: normals of the planes through the station and each edge. They are scaled so that
// no engine's rounding matters if a unit vector's product with them is beyond ±1. An edge without length has normal
// 0.
struct Occluder {
  vec3 sides[3];
};

const Occluder no_occluder = Occluder(vec3[3](vec3(0), vec3(0), vec3(0)));

float size_of(vec3 v) { return abs(v.x) + abs(v.y) + abs(v.z); }

Occluder occluder_of(Corners t) {
  const vec3 ab = t.b - t.a, bc = t.c - t.b, ca = t.a - t.c;
  vec3 far = vec3(size_of(t.a), size_of(t.b), size_of(t.c));
  if (with_shared) far += 65536.0 * t.doubt;
  const vec3 lengths = 65536.0 / max(max(far, far.yzx) * vec3(size_of(ab), size_of(bc), size_of(ca)), 1e-30);
  return Occluder(vec3[3](cross(t.a, ab) * lengths.x, cross(t.b, bc) * lengths.y, cross(t.c, ca) * lengths.z));
}

vec3 products_of(Occluder occluder, vec3 v) {
  return vec3(dot(occluder.sides[0], v), dot(occluder.sides[1], v), dot(occluder.sides[2], v));
}

// Returns true if the ray meets the triangle. `direction`: a unit vector.
bool stops(Occluder occluder, vec3 direction) {
  const vec3 at = products_of(occluder, direction);
  return all(greaterThan(at, vec3(1))) || all(lessThan(at, vec3(-1)));
}

// Position of a cube relative to the planes of an occluder: inside a plane if `at` is above `wide`, outside if it is
// below −wide, else cut by it.
struct Place {
  vec3 at, wide;
};

Place place_of(Cube cube, Occluder occluder, float facing) {
  const vec3 sizes = vec3(size_of(occluder.sides[0]), size_of(occluder.sides[1]), size_of(occluder.sides[2]));
  return Place(facing * products_of(occluder, centre_of(cube)), 0.5 * cube.side * sizes + farthest_of(cube));
}

// Returns true if all rays through the cube meet the triangle.
bool covers(Occluder occluder, Cube cube) {
  const Place place = place_of(cube, occluder, 1.0);
  return all(greaterThan(place.at, place.wide)) || all(lessThan(place.at, -place.wide));
}

// Returns true if rays through the cube hit the triangle beyond the scanner's least range, yet too far before the cube
// for points in it. Uses products with the normal n of the triangle's plane: a ray to q in the cube meets the plane at
// (n·a / n·q) of the way.
bool is_before(Corners t, Cube cube) {
  const float nearest = length(max(max(cube.low, -high_of(cube)), vec3(0)));
  const vec3 ab = t.b - t.a, ca = t.a - t.c, normal = cross(ab, ca);
  // Error of the normal's products with unit vectors, including the effect of slender triangles and grazing rays on a
  // hit's distance.
  const float doubt = size_of(ab) * size_of(ca) * (1.0 / 262144.0);
  const float plane = dot(normal, t.a);
  float plane_doubt = doubt * max(max(size_of(t.a), size_of(t.b)), size_of(t.c));
  if (with_shared) plane_doubt += size_of(normal) * t.doubt;
  const float middle = dot(normal, centre_of(cube)) * (plane < 0.0 ? -1.0 : 1.0);
  const float wide = 0.5 * cube.side * size_of(normal) + farthest_of(cube) * doubt;
  const float least = middle - wide, most = middle + wide;
  return least > 0.0 && nearest * (abs(plane) + plane_doubt) <= (nearest - reach_of(cube)) * least &&
         nearest * (abs(plane) - plane_doubt) >= (parameters.min_range + cube.slack) * most;
}

// Returns the corner of triangle `other` that is not on its common edge with `triangle`.
vec3 corner_beyond(uint other, uint triangle, vec3 origin) {
  uint corner = 2u;
  for (uint k = 0u; k < 3u; ++k)
    if (neighbour_of(other, k) == triangle) corner = (k + 2u) % 3u;
  if (!with_shared) return parameters.positions.at[parameters.triangles.at[3u * other + corner]] - origin;
  const Corners corners = corners_of(other, origin);
  return corner == 0u ? corners.a : corner == 1u ? corners.b : corners.c;
}

// Returns true if all rays through the cube meet the triangle or others connected to it, for engines that let no
// ray pass between two triangles with a common edge. The patch grows over every edge whose plane cuts the cube,
// until no such edge is left. It has no hole if each of these edges has a triangle on either side, as the station
// sees it.
bool patch_covers(uint triangle, vec3 origin, Cube cube) {
  const uint most = 16u;
  uint members[most];
  uint count = 1u;
  members[0] = triangle;
  for (uint m = 0u; m < count; ++m) {
    const uint member = members[m];
    const Corners corners = corners_of(member, origin);
    const Occluder occluder = occluder_of(corners);
    const float facing = dot(occluder.sides[0], corners.c) < 0.0 ? -1.0 : 1.0;
    const Place place = place_of(cube, occluder, facing);
    if (any(lessThan(place.at, -place.wide))) {  // it covers no part of the cube
      if (m == 0u) return false;
      continue;
    }
    if (!is_before(corners, cube)) return false;
    for (uint k = 0u; k < 3u; ++k) {
      if (place.at[k] > place.wide[k]) continue;
      const uint other = neighbour_of(member, k);
      if (other == no_primitive) return false;
      const vec3 beyond = corner_beyond(other, member, origin);
      if (facing * dot(occluder.sides[k], beyond) >= -length(beyond)) return false;  // folded back
      bool known = false;
      for (uint i = 0u; i < count; ++i) known = known || members[i] == other;
      if (known) continue;
      if (count == most) return false;
      members[count++] = other;
    }
  }
  return true;
}

#endif
