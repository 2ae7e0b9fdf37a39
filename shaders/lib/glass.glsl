// SPDX-License-Identifier: Apache-2.0
// Strength of an echo behind panes of glass (docs/method.md).
#ifndef VANTAGE_LIB_GLASS
#define VANTAGE_LIB_GLASS
#include "lib/shade.glsl"
#include "trace/compute_bvh/walk.glsl"

layout(constant_id = glass_constant) const bool with_glass = false;

// Returns the share of strength that passes a pane there and back, at the square of the cosine of incidence: T² by
// Fresnel's formulas for the refractive index 1.5, reflections within the pane included.
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

// The nearest faces of glass on a ray, in order of distance; no_primitive in unused places.
const uint faces_at_once = 4u;
struct Faces {
  float t[faces_at_once];
  uint id[faces_at_once];
};

// Finds them in one walk. Most beams pass two or three faces, and each further walk would take as long again.
Faces walk_faces(NodeQuarters nodes, TriangleCorners corners, vec3 origin, vec3 direction, float t_min, float t_max) {
  Faces found;
  for (uint k = 0u; k < faces_at_once; ++k) {
    found.t[k] = t_max;
    found.id[k] = no_primitive;
  }
  const FrameRay ray = ray_in_tree(nodes, origin, direction);
  uint stack[bvh_stack_size];
  stack[0] = bvh_end;
  uint depth = 1u;
  uint current = 0u;
  while (current != bvh_end) {
    if ((current & bvh_leaf_bit) == 0u) {
      const Children met = children_of(nodes, current, ray.node, t_min, found.t[faces_at_once - 1u]);
      stack[depth] = met.farther;  // kept if both are entered
      current = met.nearer;
      if (met.both) ++depth;
      if (met.none) current = stack[--depth];
      continue;
    }
    for (uint i = first_of_leaf(current); i <= last_of_leaf(current); ++i) {
      const uint last = faces_at_once - 1u;
      Hit face = Hit(found.t[last], found.id[last], vec2(0));
      meet_corners(face, corners, i, t_min, ray);
      if (face.id == found.id[last]) continue;
      found.t[last] = face.t;
      found.id[last] = face.id;
      for (uint k = last; k > 0u; --k) {
        const float t = found.t[k - 1u];
        const uint id = found.id[k - 1u];
        const bool sooner = found.t[k] < t ||
                            (found.t[k] == t && (found.id[k] & ~surveyed_bit) < (id & ~surveyed_bit));
        found.t[k - 1u] = sooner ? found.t[k] : t;
        found.id[k - 1u] = sooner ? found.id[k] : id;
        found.t[k] = sooner ? t : found.t[k];
        found.id[k] = sooner ? id : found.id[k];
      }
    }
    current = stack[--depth];
  }
  return found;
}

// A beam on its way to a hit: the share of its strength that passes there and back, or the pane that reflects
// it.
struct Passed {
  float share;
  Hit pane;
};

Passed pass_glass(vec3 origin, vec3 direction, float t) {
  Passed passed = Passed(1.0, Hit(t, no_primitive, vec2(0)));
  if (!with_glass || !GIVEN(parameters.glass_nodes)) return passed;
  NodeQuarters nodes = NodeQuarters(parameters.glass_nodes);
  TriangleCorners corners = TriangleCorners(parameters.glass_corners);
  precise float kept = t * (1.0 - face_gap_share);
  precise float end = kept - face_gap_m;
  float start = 0.0;  // distance from which faces count again
  while (start < end) {
    const Faces faces = walk_faces(nodes, corners, origin, direction, start, end);
    for (uint k = 0u; k < faces_at_once; ++k) {
      if (faces.id[k] == no_primitive) return passed;
      if (faces.t[k] < start) continue;
      const uint triangle = faces.id[k] & ~surveyed_bit;
      const float cosine = exact_dot(flat_normal(stored_of(triangle)), direction);
      precise float square = cosine * cosine;
      if (square >= pane_return_square) {
        const Hit pane = walk(nodes, corners, origin, direction, start, end, want_nearest, from_the_root);
        return Passed(0.0, Hit(pane.t, triangle, pane.barycentric));
      }
      float share = passed_of_pane(square);
      // The bit marks a face of a solid; a pane of a solid has two such faces.
      if ((faces.id[k] & surveyed_bit) != 0u && share > least_passed) {
        precise float root = share * exact_inverse_sqrt(share);
        share = root;
      }
      precise float left = passed.share * share;
      passed.share = left;
      if (left < least_passed) {
        passed.share = 0.0;
        return passed;
      }
      precise float stretched = faces.t[k] * (1.0 + face_gap_share);
      precise float next = stretched + face_gap_m;
      start = next;
    }
  }
  return passed;
}

#endif
