// SPDX-License-Identifier: Apache-2.0
// What a triangle in front of a cube hides of it, with more to spare than any engine's rounding: what is said to be
// hidden is hidden on every engine, and what is not said to be may be hidden all the same.
#ifndef VANTAGE_LIB_BLOCKER
#define VANTAGE_LIB_BLOCKER
#include "lib/cube.glsl"

// A triangle as its station sees it: normals of the planes through the station and an edge.
struct Blocker {
  vec3 sides[3];
  vec3 doubts;  // of a unit vector's products with them
};

struct Corners {
  vec3 a, b, c;  // relative to the station
};

Corners corners_of(uint triangle, vec3 origin) {
  const uint first = 3u * triangle;
  return Corners(parameters.positions.at[parameters.triangles.at[first]] - origin,
                 parameters.positions.at[parameters.triangles.at[first + 1u]] - origin,
                 parameters.positions.at[parameters.triangles.at[first + 2u]] - origin);
}

float size_of(vec3 v) { return abs(v.x) + abs(v.y) + abs(v.z); }

Blocker blocker_of(Corners t) {
  const vec3 ab = t.b - t.a, bc = t.c - t.b, ca = t.a - t.c;
  const vec3 far = vec3(size_of(t.a), size_of(t.b), size_of(t.c));
  return Blocker(vec3[3](cross(t.a, ab), cross(t.b, bc), cross(t.c, ca)),
                 max(far, far.yzx) * vec3(size_of(ab), size_of(bc), size_of(ca)) * (1.0 / 65536.0));
}

vec3 products_of(Blocker blocker, vec3 v) {
  return vec3(dot(blocker.sides[0], v), dot(blocker.sides[1], v), dot(blocker.sides[2], v));
}

// Whether the ray meets the triangle. `direction`: a unit vector.
bool stops(Blocker blocker, vec3 direction) {
  const vec3 at = products_of(blocker, direction);
  return all(greaterThan(at, blocker.doubts)) || all(lessThan(at, -blocker.doubts));
}

// Where a cube is from the planes of a blocker: inside of one where `at` is beyond `wide`, outside where it is beyond
// −wide, and cut by it elsewhere.
struct Place {
  vec3 at, wide;
};

Place place_of(Cube cube, Blocker blocker, float facing) {
  const vec3 centre = 0.5 * (cube.low + cube.high), half_size = 0.5 * (cube.high - cube.low);
  return Place(facing * products_of(blocker, centre),
               vec3(dot(abs(blocker.sides[0]), half_size), dot(abs(blocker.sides[1]), half_size),
                    dot(abs(blocker.sides[2]), half_size)) +
                   (length(centre) + length(half_size)) * blocker.doubts);
}

// Whether all rays through the cube meet the triangle.
bool covers(Blocker blocker, Cube cube) {
  const Place place = place_of(cube, blocker, 1.0);
  return all(greaterThan(place.at, place.wide)) || all(lessThan(place.at, -place.wide));
}

// Whether the hits of rays that go on through the cube are too far before it for their points to be in it, and not
// nearer to the station than a scanner sees. Products with the normal n of the triangle's plane tell: a ray that
// comes to q in the cube meets the plane at (n·a / n·q) of the way.
bool is_before(Corners t, Cube cube) {
  const vec3 centre = 0.5 * (cube.low + cube.high), half_size = 0.5 * (cube.high - cube.low);
  const float farthest = length(centre) + length(half_size), nearest = length(max(max(cube.low, -cube.high), vec3(0)));
  const vec3 ab = t.b - t.a, ca = t.a - t.c, normal = cross(ab, ca);
  // Of the normal's products with unit vectors; it holds what slender triangles and grazing rays do to a hit's
  // distance.
  const float doubt = size_of(ab) * size_of(ca) * (1.0 / 262144.0);
  const float plane = dot(normal, t.a), plane_doubt = doubt * max(max(size_of(t.a), size_of(t.b)), size_of(t.c));
  const float middle = dot(normal, centre) * (plane < 0.0 ? -1.0 : 1.0);
  const float wide = dot(abs(normal), half_size) + farthest * doubt;
  const float least = middle - wide, most = middle + wide;
  return least > 0.0 && nearest * (abs(plane) + plane_doubt) <= (nearest - reach_of(cube)) * least &&
         nearest * (abs(plane) - plane_doubt) >= (parameters.min_range + cube.slack) * most;
}

// The corner of triangle `other` that is not on its edge to `triangle`.
vec3 corner_beyond(uint other, uint triangle, vec3 origin) {
  uint corner = 2u;
  for (uint k = 0u; k < 3u; ++k)
    if (parameters.neighbours.at[3u * other + k] == triangle) corner = (k + 2u) % 3u;
  return parameters.positions.at[parameters.triangles.at[3u * other + corner]] - origin;
}

// Whether all rays through the cube meet the triangle or others that hang together with it, for engines that let no ray
// pass between two triangles with an edge in common. The patch grows over every edge whose plane cuts the cube. It has
// no hole where all of these edges have a triangle on either side, as the station sees it, and no end before it has
// grown over all.
bool patch_covers(uint triangle, vec3 origin, Cube cube) {
  const uint most = 8u;
  uint members[most];
  uint count = 1u;
  members[0] = triangle;
  for (uint m = 0u; m < count; ++m) {
    const uint member = members[m];
    const Corners corners = corners_of(member, origin);
    const Blocker blocker = blocker_of(corners);
    const float facing = dot(blocker.sides[0], corners.c) < 0.0 ? -1.0 : 1.0;
    const Place place = place_of(cube, blocker, facing);
    if (any(lessThan(place.at, -place.wide))) {  // it is not in the way
      if (m == 0u) return false;
      continue;
    }
    if (!is_before(corners, cube)) return false;
    for (uint k = 0u; k < 3u; ++k) {
      if (place.at[k] > place.wide[k]) continue;
      const uint other = parameters.neighbours.at[3u * member + k];
      if (other == no_primitive) return false;
      const vec3 beyond = corner_beyond(other, member, origin);
      if (facing * dot(blocker.sides[k], beyond) >= -blocker.doubts[k] * length(beyond)) return false;  // folded back
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
