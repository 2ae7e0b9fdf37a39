// SPDX-License-Identifier: Apache-2.0
// Strength of an echo behind panes of glass (docs/method.md).
#ifndef VANTAGE_LIB_GLASS
#define VANTAGE_LIB_GLASS
#include "lib/shade.glsl"
#include "trace/compute_bvh/walk.glsl"

layout(constant_id = glass_constant) const bool with_glass = false;

// Share of the strength that passes a pane there and back, at the square of the cosine of incidence: T² by Fresnel's
// formulas for the refractive index 1.5, reflections within the pane included.
float passed_of_pane(float square) {
  precise float a = 1.25 + 2.0 * square;
  precise float b = 1.25 + 6.0625 * square;
  precise float ab = a * b;
  precise float sum = 4.0625 + 10.5625 * square;
  precise float q = sum * exact_reciprocal(ab);
  precise float qq = q * q;
  precise float inner = 1.25 + square;
  precise float s = square * inner;
  precise float passed = s * qq;
  return passed;
}

// A beam on its way to a hit: the share of its strength that passes there and back, or the pane that
// returns it.
struct Passed {
  float share;
  Hit pane;
};

Passed pass_glass(vec3 origin, vec3 direction, float t) {
  Passed passed = Passed(1.0, Hit(t, no_primitive, vec2(0)));
  if (!with_glass || !GIVEN(parameters.glass_nodes)) return passed;
  precise float kept = t * (1.0 - face_gap_share);
  precise float end = kept - face_gap_m;
  float start = 0.0;
  while (start < end) {
    const Hit face = walk(NodeQuarters(parameters.glass_nodes), TriangleCorners(parameters.glass_corners), origin,
                          direction, start, end, want_nearest, from_the_root);
    if (face.id == no_primitive) break;
    const uint triangle = face.id & ~surveyed_bit;
    const float cosine = exact_dot(flat_normal(stored_of(triangle)), direction);
    precise float square = cosine * cosine;
    if (square >= pane_return_square) return Passed(0.0, Hit(face.t, triangle, face.barycentric));
    float share = passed_of_pane(square);
    // The bit marks a face of a solid, of which a pane has two.
    if ((face.id & surveyed_bit) != 0u && share > least_passed) {
      precise float root = share * exact_inverse_sqrt(share);
      share = root;
    }
    precise float left = passed.share * share;
    passed.share = left;
    if (left < least_passed) {
      passed.share = 0.0;
      break;
    }
    precise float stretched = face.t * (1.0 + face_gap_share);
    precise float next = stretched + face_gap_m;
    start = next;
  }
  return passed;
}

#endif
