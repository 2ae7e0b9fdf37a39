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

// Whether all rays through the cube meet the triangle.
bool covers(Blocker blocker, Cube cube) {
  const vec3 centre = 0.5 * (cube.low + cube.high), half_size = 0.5 * (cube.high - cube.low);
  const vec3 at = products_of(blocker, centre);
  const vec3 wide = vec3(dot(abs(blocker.sides[0]), half_size), dot(abs(blocker.sides[1]), half_size),
                         dot(abs(blocker.sides[2]), half_size)) +
                    (length(centre) + length(half_size)) * blocker.doubts;
  return all(greaterThan(at, wide)) || all(lessThan(at, -wide));
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

#endif
