// SPDX-License-Identifier: Apache-2.0
// Intersection of a ray with a triangle's plane, in coordinates sheared so that the ray is the z axis (Woop, Benthin,
// Wald: Watertight Ray/Triangle Intersection, 2013). Uses only +, − and ×, uncontracted, so that all devices round
// alike.
#ifndef VANTAGE_LIB_SHEARED_TRIANGLE
#define VANTAGE_LIB_SHEARED_TRIANGLE
#include "lib/exact.glsl"

struct Shear {
  bool major_x, major_y;  // the largest component of the direction becomes z
  float x, y, z;
};

Shear shear_along(vec3 direction) {
  const vec3 size = abs(direction);
  Shear shear;
  shear.major_x = size.x >= size.y && size.x >= size.z;
  shear.major_y = !shear.major_x && size.y >= size.z;
  precise vec3 d = shear.major_x ? direction.yzx : shear.major_y ? direction.zxy : direction;
  shear.z = exact_reciprocal(d.z);
  precise float x = d.x * shear.z;
  precise float y = d.y * shear.z;
  shear.x = x;
  shear.y = y;
  return shear;
}

// Corners relative to the ray's origin, sheared; z stays unscaled.
struct ShearedTriangle {
  vec3 a, b, c;
};

vec3 sheared(Shear shear, vec3 corner) {
  precise vec3 p = shear.major_x ? corner.yzx : shear.major_y ? corner.zxy : corner;
  precise float x = p.x - shear.x * p.z;
  precise float y = p.y - shear.y * p.z;
  return vec3(x, y, p.z);
}

ShearedTriangle sheared(Shear shear, vec3 origin, vec3 a, vec3 b, vec3 c) {
  precise vec3 p = a - origin;
  precise vec3 q = b - origin;
  precise vec3 r = c - origin;
  return ShearedTriangle(sheared(shear, p), sheared(shear, q), sheared(shear, r));
}

// Returns twice the signed areas opposite each corner. The ray meets the triangle if all have one sign or are 0.
vec3 edge_functions(ShearedTriangle t) {
  precise float u = t.c.x * t.b.y - t.c.y * t.b.x;
  precise float v = t.a.x * t.c.y - t.a.y * t.c.x;
  precise float w = t.b.x * t.a.y - t.b.y * t.a.x;
  return vec3(u, v, w);
}

#endif
