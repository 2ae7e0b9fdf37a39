// SPDX-License-Identifier: Apache-2.0
// Whether a triangle stands before all of a cube.
#ifndef VANTAGE_LIB_HIDES
#define VANTAGE_LIB_HIDES
#include "lib/sample.glsl"

// Whether every ray from the origin through the cube [low, high] must hit the triangle, farther than `nearest` and more
// than `reach` before the cube. All relative to the origin. Sides of planes are asked of the cube's corners with
// 2^-14 of doubt, hundreds of times their rounding.
bool hides(Cube cube, vec3 a, vec3 b, vec3 c, float nearest, float reach) {
  const float doubt = 1.0 / 16384.0;
  const vec3 normal = cross(b - a, c - a), ab = cross(a, b), bc = cross(b, c), ca = cross(c, a);
  const float size_a = length(a), size_b = length(b), size_c = length(c), steepness = length(normal);
  const float height = dot(normal, a), largest = max(max(size_a, size_b), size_c);
  // Seen too flatly to be sure of anything, or perhaps too near.
  if (abs(height) < 1024.0 * doubt * steepness * largest || abs(height) <= (1.0 + doubt) * nearest * steepness)
    return false;
  const float distance = length(max(max(cube.low, -cube.high), vec3(0)));
  const float margin = reach * (1.0 + doubt);
  if (distance <= 2.0 * margin) return false;
  const float beyond = (1.0 + doubt) / (1.0 - margin / distance);
  for (int k = 0; k < 8; ++k) {
    const vec3 corner = vec3((k & 1) != 0 ? cube.high.x : cube.low.x, (k & 2) != 0 ? cube.high.y : cube.low.y,
                             (k & 4) != 0 ? cube.high.z : cube.low.z);
    const float size = length(corner);
    // Inside the three planes through the origin and an edge; they turn as the triangle faces.
    const vec3 inside = vec3(dot(ab, corner), dot(bc, corner), dot(ca, corner)) * sign(height);
    const vec3 slack = doubt * size * vec3(size_a * size_b, size_b * size_c, size_c * size_a);
    if (any(lessThanEqual(inside, slack))) return false;
    if (dot(normal, corner) * sign(height) - doubt * steepness * size <= beyond * abs(height)) return false;
  }
  return true;
}

#endif
